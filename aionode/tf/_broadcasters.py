"""Publish transforms."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.tf._listener import DEPTH, STATIC_TOPIC, TOPIC

if TYPE_CHECKING:
    from aionode.interfaces.geometry_msgs.msg import TransformStamped
    from aionode.node import Node

__all__ = ["StaticTransformBroadcaster", "TransformBroadcaster"]


class TransformBroadcaster:
    """Publishes changing transforms on /tf, as in tf2_ros.

    Args:
        node: The node that publishes. In a managed node, transforms are sent in every state.
        qos: A profile or depth; by default 100 messages.

    Attributes:
        pub_tf: The publisher.
    """

    _TransformBroadcaster__message: Any = TFMessage

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        qos = DEPTH if qos is None else qos
        self.pub_tf = node.create_publisher(self._TransformBroadcaster__message, TOPIC, qos)

    def sendTransform(
        self, transform: TransformStamped | Iterable[TransformStamped]
    ) -> None:  # tf2's name
        """Publish one transform, or several in one message; never blocks.

        Raises:
            MessageError: it is not a transform (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self.pub_tf.publish(self._TransformBroadcaster__message(transforms=listed(transform)))


class StaticTransformBroadcaster:
    """Publishes static transforms on /tf_static, as in tf2_ros.

    Each message contains all transforms that were sent with this broadcaster, so that late nodes
    get all of them. A transform with the same child frame replaces the earlier one.

    Args:
        node: The node that publishes. In a managed node, transforms are sent in every state.
        qos: A profile or depth; by default the last message is kept for late subscriptions.

    Attributes:
        pub_tf: The publisher.
        net_message: The last published message.
    """

    _StaticTransformBroadcaster__message: Any = TFMessage

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        if qos is None:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pub_tf = node.create_publisher(
            self._StaticTransformBroadcaster__message, STATIC_TOPIC, qos
        )
        self.net_message = self._StaticTransformBroadcaster__message()

    def sendTransform(
        self, transform: TransformStamped | Iterable[TransformStamped]
    ) -> None:  # tf2's name
        """Publish one or several transforms, with all earlier ones; never blocks.

        Raises:
            MessageError: it is not a transform (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        by_child = {
            getattr(stamped, "child_frame_id", None): stamped  # `publish` refuses others
            for stamped in [*self.net_message.transforms, *listed(transform)]
        }
        message = self._StaticTransformBroadcaster__message(transforms=list(by_child.values()))
        self.pub_tf.publish(message)
        self.net_message = message


def listed(transform: TransformStamped | Iterable[TransformStamped]) -> list[TransformStamped]:
    """Return one or several transforms as a list."""
    return list(transform) if isinstance(transform, Iterable) else [transform]
