"""Publishing transforms."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.tf._listener import DEPTH, STATIC_TOPIC, TOPIC

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = ["StaticTransformBroadcaster", "TransformBroadcaster"]


class TransformBroadcaster:
    """Publishes transforms that change on /tf, as in tf2_ros.

    Args:
        node: The node that publishes. In a managed node, transforms are sent in every state.
        qos: A profile or depth; by default 100 messages.

    Attributes:
        pub_tf: The publisher.
    """

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, TOPIC, qos or DEPTH)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802  # tf2's name
        """Publish one transform, or several in one message; never waits.

        Raises:
            TypeError: it is not a transform.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self.pub_tf.publish(TFMessage(transforms=listed(transform)))


class StaticTransformBroadcaster:
    """Publishes transforms that never change on /tf_static, as in tf2_ros.

    Each message has all transforms that were sent with this broadcaster, so that nodes that come
    later get all of them. A transform of the same child frame replaces the one before.

    Args:
        node: The node that publishes. In a managed node, transforms are sent in every state.
        qos: A profile or depth; by default the last message is kept for late subscriptions.

    Attributes:
        pub_tf: The publisher.
    """

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        qos = qos or QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pub_tf = node.create_publisher(TFMessage, STATIC_TOPIC, qos)
        self._by_child: dict[str, TransformStamped] = {}

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802  # tf2's name
        """Publish one or several transforms, with all that were sent before; never waits.

        Raises:
            TypeError: it is not a transform.
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        every = self._by_child | {stamped.child_frame_id: stamped for stamped in listed(transform)}
        self.pub_tf.publish(TFMessage(transforms=list(every.values())))
        self._by_child = every


def listed(transform: TransformStamped | Iterable[TransformStamped]) -> list[TransformStamped]:
    """Return one or several transforms as a list."""
    return [transform] if isinstance(transform, TransformStamped) else list(transform)
