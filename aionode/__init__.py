"""aionode: ROS 2's nodes, topics, services and timers, native to asyncio.

A node is a set of tasks, a subscription a bounded queue, and a service call is awaited::

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

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from aionode._process.imports import uncollected
from aionode._version import __version__ as __version__

if TYPE_CHECKING:
    from aionode.action import (
        ActionClient,
        ActionResult,
        ActionServer,
        CancelResponse,
        ClientGoalHandle,
        GoalRejected,
        GoalResponse,
        GoalStatus,
        ServerGoalHandle,
    )
    from aionode.clock import Clock, ClockType, Duration, Time
    from aionode.content_filter import ContentFilterOptions
    from aionode.endpoints.client import Client
    from aionode.endpoints.core.callback_runner import CallbackContext
    from aionode.endpoints.core.end_record import NodeEnd
    from aionode.endpoints.events import (
        IncompatibleTypeInfo,
        MatchedInfo,
        PublisherEventCallbacks,
        QoSLivelinessChangedInfo,
        QoSLivelinessLostInfo,
        QoSMessageLostInfo,
        QoSOfferedDeadlineMissedInfo,
        QoSOfferedIncompatibleQoSInfo,
        QoSRequestedDeadlineMissedInfo,
        QoSRequestedIncompatibleQoSInfo,
        SubscriptionEventCallbacks,
    )
    from aionode.endpoints.lease import CommandLease
    from aionode.endpoints.publisher import Publisher
    from aionode.endpoints.service import Service
    from aionode.endpoints.service_introspection import ServiceIntrospectionState
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.endpoints.timer import Rate, Timer, TimerInfo
    from aionode.engine.context import Context
    from aionode.node import Node
    from aionode.parameter import Parameter
    from aionode.qos import (
        DurabilityPolicy,
        HistoryPolicy,
        LivelinessPolicy,
        QoSProfile,
        ReliabilityPolicy,
    )
    from aionode.runner import freeze_objects, run
    from aionode.supervisor import Health, Supervisor

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
    "CommandLease",
    "ContentFilterOptions",
    "Context",
    "DurabilityPolicy",
    "Duration",
    "GoalRejected",
    "GoalResponse",
    "GoalStatus",
    "Health",
    "HistoryPolicy",
    "IncompatibleTypeInfo",
    "LivelinessPolicy",
    "MatchedInfo",
    "MessageInfo",
    "Node",
    "NodeEnd",
    "Parameter",
    "Publisher",
    "PublisherEventCallbacks",
    "QoSLivelinessChangedInfo",
    "QoSLivelinessLostInfo",
    "QoSMessageLostInfo",
    "QoSOfferedDeadlineMissedInfo",
    "QoSOfferedIncompatibleQoSInfo",
    "QoSProfile",
    "QoSRequestedDeadlineMissedInfo",
    "QoSRequestedIncompatibleQoSInfo",
    "Rate",
    "ReliabilityPolicy",
    "ServerGoalHandle",
    "Service",
    "ServiceIntrospectionState",
    "Subscription",
    "SubscriptionEventCallbacks",
    "Supervisor",
    "Time",
    "Timer",
    "TimerInfo",
    "freeze_objects",
    "run",
]

_EXPORTS = {
    "ActionClient": "aionode.action",
    "ActionResult": "aionode.action",
    "ActionServer": "aionode.action",
    "CallbackContext": "aionode.endpoints.core.callback_runner",
    "CancelResponse": "aionode.action",
    "Client": "aionode.endpoints.client",
    "ClientGoalHandle": "aionode.action",
    "Clock": "aionode.clock",
    "ClockType": "aionode.clock",
    "CommandLease": "aionode.endpoints.lease",
    "ContentFilterOptions": "aionode.content_filter",
    "Context": "aionode.engine.context",
    "DurabilityPolicy": "aionode.qos",
    "Duration": "aionode.clock",
    "GoalRejected": "aionode.action",
    "GoalResponse": "aionode.action",
    "GoalStatus": "aionode.action",
    "Health": "aionode.supervisor",
    "HistoryPolicy": "aionode.qos",
    "IncompatibleTypeInfo": "aionode.endpoints.events",
    "LivelinessPolicy": "aionode.qos",
    "MatchedInfo": "aionode.endpoints.events",
    "MessageInfo": "aionode.endpoints.subscription",
    "Node": "aionode.node",
    "NodeEnd": "aionode.endpoints.core.end_record",
    "Parameter": "aionode.parameter",
    "Publisher": "aionode.endpoints.publisher",
    "PublisherEventCallbacks": "aionode.endpoints.events",
    "QoSLivelinessChangedInfo": "aionode.endpoints.events",
    "QoSLivelinessLostInfo": "aionode.endpoints.events",
    "QoSMessageLostInfo": "aionode.endpoints.events",
    "QoSOfferedDeadlineMissedInfo": "aionode.endpoints.events",
    "QoSOfferedIncompatibleQoSInfo": "aionode.endpoints.events",
    "QoSProfile": "aionode.qos",
    "QoSRequestedDeadlineMissedInfo": "aionode.endpoints.events",
    "QoSRequestedIncompatibleQoSInfo": "aionode.endpoints.events",
    "Rate": "aionode.endpoints.timer",
    "ReliabilityPolicy": "aionode.qos",
    "ServerGoalHandle": "aionode.action",
    "Service": "aionode.endpoints.service",
    "ServiceIntrospectionState": "aionode.endpoints.service_introspection",
    "Subscription": "aionode.endpoints.subscription",
    "SubscriptionEventCallbacks": "aionode.endpoints.events",
    "Supervisor": "aionode.supervisor",
    "Time": "aionode.clock",
    "Timer": "aionode.endpoints.timer",
    "TimerInfo": "aionode.endpoints.timer",
    "freeze_objects": "aionode.runner",
    "run": "aionode.runner",
}
"""The module that defines each name. A name is imported when it is first used, so that
``aionode --help`` and programs that need few names start at once."""


def __getattr__(name: str) -> Any:
    """Return a public name or a module of the package, and cache it."""
    try:
        with uncollected():
            value = (
                getattr(import_module(_EXPORTS[name]), name)
                if name in _EXPORTS
                else submodule(name)
            )
    except ModuleNotFoundError as error:
        if error.name != f"{__name__}.{name}":
            raise
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}") from None
    globals()[name] = value
    return value


def submodule(name: str) -> Any:
    """Import a module of the package, so that ``aionode.qos`` works without its own import."""
    return import_module(f"{__name__}.{name}")


def __dir__() -> list[str]:
    """Return the public names, used or not."""
    return sorted({*globals(), *__all__})
