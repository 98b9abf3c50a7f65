"""Simulated time, which a node's clock follows while `use_sim_time` is true."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.clock import Time
from aionode.endpoints.core.endpoint import info_of
from aionode.endpoints.core.entity import EndStage, Entity
from aionode.endpoints.core.node_core import core_of
from aionode.engine.reports.simulated_time import ClockWatch, why_no_time
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from aionode.parameter import Parameter
from aionode.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.endpoints.core.node_methods import NodeMethods
    from aionode.endpoints.subscription import Subscription

__all__ = ["TimeSource"]

CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class WatchedClock(Entity):
    """Logs a warning if no time arrives while the node is running."""

    def __init__(self, watch: ClockWatch) -> None:
        super().__init__("watch of /clock", EndStage.LAST)
        self._watch = watch

    def _run(self) -> None:
        self._watch.start()

    def _close(self) -> None:
        self._watch.stop()


class TimeSource:
    """Follows ``/clock`` while the parameter `use_sim_time` is true."""

    def __init__(self, node: NodeMethods, clock: Clock) -> None:
        self._node = node
        self._clock = clock
        self._subscription: Subscription[ClockMsg] | None = None
        self._watch: WatchedClock | None = None
        self._heard = False
        self._warned = False
        node.add_on_set_parameters_callback(self._check)
        if not node.has_parameter("use_sim_time"):
            node.declare_parameter("use_sim_time", False)
        node.add_post_set_parameters_callback(self._follow)
        self._switch(active=node.get_parameter("use_sim_time").value)

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == "use_sim_time" and not isinstance(parameter.value, bool):
                return SetParametersResult(
                    successful=False,
                    reason=f"use_sim_time is {parameter.value!r}; it must be true or false",
                )
        return SetParametersResult(successful=True)

    def _follow(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "use_sim_time":
                self._switch(active=parameter.value)

    def _switch(self, *, active: bool) -> None:
        self._clock.set_ros_time_active(active)
        if active and self._subscription is None:
            self._subscription = self._node.create_subscription(
                ClockMsg, "/clock", self._on_tick, CLOCK_QOS
            )
            # The subscription outlives the callbacks, whose cleanup may sleep.
            core_of(self._node).shutdown.postpone(self._subscription, EndStage.GOALS)
            context = self._node.context
            watch = ClockWatch(
                *(info_of(self._subscription), context.graph, context.time_base),
                heard=lambda: self._heard,
            )
            self._watch = core_of(self._node).add(WatchedClock(watch))
        elif not active and self._subscription is not None:
            self._subscription.destroy()
            self._subscription = None
            if self._watch is not None:
                self._watch.destroy()

    def _on_tick(self, msg: ClockMsg) -> None:
        problem = why_no_time(msg.clock)
        if not problem:
            self._heard = True
            self._clock.set_ros_time_override(Time.from_msg(msg.clock))
            return
        if self._subscription is not None:
            self._subscription.stats.errors += 1
        if not self._warned:
            self._warned = True
            self._node.get_logger().warning(f"{problem}. Further ones are only counted")
