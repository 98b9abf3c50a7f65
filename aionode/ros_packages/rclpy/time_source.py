"""Simulated time: clocks that follow ``/clock`` while the parameter `use_sim_time` is true."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from aionode.clock import ClockType
from aionode.engine.reports.simulated_time import ClockWatch, why_no_time
from aionode.graph import EndpointKind
from rclpy._impl import messages as msg
from rclpy.clock import ROSClock
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time

if TYPE_CHECKING:
    from aionode.engine.context import Context as CoreContext
    from aionode.graph import EndpointInfo
    from rclpy._protocols import NodeLike
    from rclpy.subscription import Subscription

__all__ = ["CLOCK_TOPIC", "USE_SIM_TIME_NAME", "TimeSource"]

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"


class TimeSource:
    """Sets clocks from ``/clock`` for a node."""

    def __init__(self, *, node: NodeLike | None = None) -> None:
        self._clock_sub: Subscription[Any] | None = None
        self._node_weak_ref: weakref.ref[NodeLike] | None = None
        self._associated_clocks: set[ROSClock] = set()
        self._last_time_set = Time(clock_type=ClockType.ROS_TIME)
        self._ros_time_is_active = False
        self._warned = False
        if node is not None:
            self.attach_node(node)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the clocks follow ``/clock``."""
        return self._ros_time_is_active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        if self._ros_time_is_active == enabled:
            return
        self._ros_time_is_active = enabled
        for clock in self._associated_clocks:
            clock._set_ros_time_is_active(enabled)
        if enabled:
            self._subscribe_to_clock_topic()
        else:
            self._unsubscribe()

    def _subscribe_to_clock_topic(self) -> None:
        node = self._get_node()
        if self._clock_sub is None and node is not None:
            self._clock_sub = node.create_subscription(
                msg.Clock,
                CLOCK_TOPIC,
                self.clock_callback,
                QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT),
            )
            handle = self._clock_sub.handle
            handle.io.call(watch_clock, handle.bare.endpoint, handle.io.context)

    def _unsubscribe(self) -> None:
        node = self._get_node()
        if self._clock_sub is not None and node is not None:
            node.destroy_subscription(self._clock_sub)
            self._clock_sub = None

    def attach_node(self, node: NodeLike) -> None:
        """Follow the parameter `use_sim_time` of a node, replacing the previous node.

        Raises:
            TypeError: it is not a node.
        """
        # Nodes have a time source themselves, so their module imports this one.
        if not hasattr(node, "declare_parameter"):
            raise TypeError("Node must be of type rclpy.node.Node")
        if self._node_weak_ref is not None:
            self.detach_node()
        self._node_weak_ref = weakref.ref(node)
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        parameter = node.get_parameter(USE_SIM_TIME_NAME)
        if parameter.type_ == Parameter.Type.BOOL:
            self.ros_time_is_active = parameter.value
        elif parameter.type_ != Parameter.Type.NOT_SET:
            node.get_logger().error(
                f"Invalid type for parameter '{USE_SIM_TIME_NAME}' {parameter.type_!r} should be "
                "bool"
            )
        node.add_on_set_parameters_callback(self._on_parameter_event)

    def detach_node(self) -> None:
        """Stop following a node.

        Raises:
            RuntimeError: the node is gone, and its subscription cannot be destroyed.
        """
        if self._clock_sub is not None:
            node = self._get_node()
            if node is None:
                raise RuntimeError("Unable to destroy previously created clock subscription")
            node.destroy_subscription(self._clock_sub)
        self._clock_sub = None
        self._node_weak_ref = None

    def attach_clock(self, clock: ROSClock) -> None:
        """Also set this clock.

        Raises:
            ValueError: it is not a ROS time clock.
        """
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")
        clock.set_ros_time_override(self._last_time_set)
        clock._set_ros_time_is_active(self.ros_time_is_active)
        self._associated_clocks.add(clock)

    def clock_callback(self, message: Any) -> None:
        """Set the time from a message, if it holds a valid one."""
        problem = why_no_time(message.clock)
        if problem:
            self._refuse(problem)
            return
        self._last_time_set = Time.from_msg(message.clock)
        for clock in self._associated_clocks:
            clock.set_ros_time_override(self._last_time_set)

    def _refuse(self, problem: str) -> None:
        """Log once that a message of ``/clock`` was ignored."""
        node = self._get_node()
        if node is not None and not self._warned:
            self._warned = True
            node.get_logger().warning(f"{problem}. Further ones are not reported")

    def _on_parameter_event(self, parameters: list[Parameter[Any]]) -> Any:
        for parameter in parameters:
            if parameter.name != USE_SIM_TIME_NAME:
                continue
            if parameter.type_ != Parameter.Type.BOOL:
                reason = f"{USE_SIM_TIME_NAME} parameter set to something besides a bool"
                node = self._get_node()
                if node is not None:
                    node.get_logger().error(reason)
                return msg.SetParametersResult(successful=False, reason=reason)
            self.ros_time_is_active = parameter.value
            break
        return msg.SetParametersResult(successful=True)

    def _get_node(self) -> NodeLike | None:
        return None if self._node_weak_ref is None else self._node_weak_ref()


def watch_clock(subscription: EndpointInfo, context: CoreContext) -> None:
    """Warn in the log if nobody publishes simulated time; runs in the context's thread.

    Whether a time has arrived is not known there: that depends on which thread spins.
    """
    graph = context.graph
    ClockWatch(
        *(subscription, graph, context.time_base),
        heard=lambda: bool(graph.endpoints(EndpointKind.PUBLISHER, name=subscription.name)),
    ).start()
