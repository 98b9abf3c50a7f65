"""Waits for one message without an executor."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from rclpy._impl.wait_set import WaitSet
from rclpy.signals import SignalHandlerGuardCondition
from rclpy.utilities import timeout_sec_to_nsec

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile

__all__ = ["wait_for_message"]


def wait_for_message(
    msg_type: Any,
    node: Node,
    topic: str,
    *,
    qos_profile: QoSProfile | int = 1,
    time_to_wait: float = -1,
) -> tuple[Literal[True], Any] | tuple[Literal[False], None]:
    """Block the thread until a message arrives; nobody needs to spin.

    Args:
        msg_type: The class of the message.
        node: The node that subscribes.
        topic: The topic.
        qos_profile: QoS of the subscription, or a depth.
        time_to_wait: Maximum time to wait, in seconds; negative for no limit.

    Returns:
        True and the message, or False and None.
    """
    context = node.context
    if context.handle is None:
        raise RuntimeError("Cannot create Waitset without a context.handle")
    wait_set = WaitSet(1, 1, 0, 0, 0, 0, context.handle)
    subscription = node.create_subscription(msg_type, topic, ignore, qos_profile=qos_profile)
    interrupted = SignalHandlerGuardCondition(context=context)
    try:
        wait_set.add_subscription(subscription.handle)
        wait_set.add_guard_condition(interrupted.handle)
        wait_set.wait(timeout_sec_to_nsec(time_to_wait))
        if not wait_set.get_ready_entities("guard_condition"):
            taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is not None:
                return True, taken[0]
    finally:
        interrupted.destroy()
        node.destroy_subscription(subscription)
    return False, None


def ignore(msg: Any) -> None:
    """Do nothing: the message is taken explicitly."""
