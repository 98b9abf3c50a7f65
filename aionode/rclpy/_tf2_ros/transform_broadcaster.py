"""Publishing transforms that change."""

from __future__ import annotations

from typing import Any

from aionode.rclpy._rosidl import message_class
from aionode.rclpy.qos import QoSProfile

__all__ = ["TransformBroadcaster", "listed"]


class TransformBroadcaster:
    """Publishes transforms on /tf.

    Args:
        node: The node that publishes.
        qos: A profile or depth.
    """

    def __init__(self, node: Any, qos: Any = None) -> None:
        self._message = message_class("tf2_msgs/msg/TFMessage")
        qos = QoSProfile(depth=100) if qos is None else qos
        self.pub_tf = node.create_publisher(self._message, "/tf", qos)

    def sendTransform(self, transform: Any) -> None:  # noqa: N802  # tf2's name
        """Publish one transform, or several."""
        self.pub_tf.publish(self._message(transforms=listed(transform)))


def listed(transform: Any) -> list[Any]:
    """Return one or several transforms as a list."""
    return list(transform) if hasattr(transform, "__iter__") else [transform]
