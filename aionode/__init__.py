"""aionode: nodes, topics, services and timers as ROS 2 has them, native to asyncio.

A node is a task, a topic a bounded queue, a service call something one awaits::

    import aionode
    from aionode.interfaces.std_msgs.msg import String

    class Talker(aionode.Node):
        def __init__(self) -> None:
            super().__init__("talker")
            self.publisher = self.create_publisher(String, "chatter", 10)
            self.create_timer(1.0, lambda: self.publisher.publish(String(data="hello")))

    aionode.run(Talker)

Exceptions are in `aionode.errors`, quality-of-service presets in `aionode.qos`, message classes in
`aionode.interfaces`, helpers for tests in `aionode.testing`.
"""

from aionode.action import (
    ActionClient,
    ActionResult,
    ActionServer,
    CancelResponse,
    ClientGoalHandle,
    GoalResponse,
    GoalStatus,
    ServerGoalHandle,
)
from aionode.clock import Clock, ClockType, Duration, Time
from aionode.context import Context
from aionode.endpoints.dispatch import CallbackContext
from aionode.endpoints.rate import Rate
from aionode.endpoints.service import Client, Service
from aionode.endpoints.timer import Timer, TimerInfo
from aionode.endpoints.topic import MessageInfo, Publisher, Subscription
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from aionode.runner import run

__all__ = [
    "ActionClient",
    "ActionResult",
    "ActionServer",
    "CallbackContext",
    "CancelResponse",
    "Client",
    "ClientGoalHandle",
    "Clock",
    "ClockType",
    "Context",
    "DurabilityPolicy",
    "Duration",
    "GoalResponse",
    "GoalStatus",
    "HistoryPolicy",
    "LivelinessPolicy",
    "MessageInfo",
    "Node",
    "Parameter",
    "Publisher",
    "QoSProfile",
    "Rate",
    "ReliabilityPolicy",
    "ServerGoalHandle",
    "Service",
    "Subscription",
    "Time",
    "Timer",
    "TimerInfo",
    "run",
]
