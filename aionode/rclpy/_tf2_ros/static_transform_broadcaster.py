"""Publishing transforms that never change."""

from __future__ import annotations

from typing import Any

from aionode.qos import DurabilityPolicy, HistoryPolicy
from aionode.rclpy._rosidl import message_class
from aionode.rclpy._tf2_ros.transform_broadcaster import listed
from aionode.rclpy.qos import QoSProfile

__all__ = ["StaticTransformBroadcaster"]


class StaticTransformBroadcaster:
    """Publishes transforms on /tf_static: all that were sent, each time.

    A transform of the same child frame replaces the one before; tf2_ros's Python keeps the first,
    its C++ the last.

    Args:
        node: The node that publishes.
        qos: A profile or depth.
    """

    def __init__(self, node: Any, qos: Any = None) -> None:
        message = message_class("tf2_msgs/msg/TFMessage")
        if qos is None:
            qos = QoSProfile(
                depth=1,
                durability=DurabilityPolicy.TRANSIENT_LOCAL,
                history=HistoryPolicy.KEEP_LAST,
            )
        self.pub_tf = node.create_publisher(message, "/tf_static", qos)
        self.net_message = message()

    def sendTransform(self, transform: Any) -> None:  # noqa: N802  # tf2's name
        """Publish one or several transforms, with all that were sent before."""
        every = {
            one.child_frame_id: one for one in [*self.net_message.transforms, *listed(transform)]
        }
        self.net_message.transforms = list(every.values())
        self.pub_tf.publish(self.net_message)
