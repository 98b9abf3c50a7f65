"""Subscriptions to /tf and /tf_static that fill a buffer."""

from __future__ import annotations

from threading import Thread
from typing import Any

from aionode.qos import DurabilityPolicy, HistoryPolicy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from rosidl_generator_py import message_class

__all__ = ["DEFAULT_STATIC_TF_TOPIC", "DEFAULT_TF_TOPIC", "TransformListener"]

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"

AUTHORITY = "default_authority"
"""tf2_ros's name for every sender."""


class TransformListener:
    """Adds the transforms of /tf and /tf_static to a buffer.

    Args:
        buffer: The buffer that receives the transforms.
        node: The node that subscribes.
        spin_thread: Whether a thread of the listener spins the node.
        qos: A profile or depth for /tf.
        static_qos: The same for /tf_static.
        tf_topic: The topic of transforms that change.
        tf_static_topic: The topic of transforms that do not.
    """

    def __init__(
        self,
        buffer: Any,
        node: Any,
        *,
        spin_thread: bool = False,
        qos: Any = None,
        static_qos: Any = None,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        if qos is None:
            qos = QoSProfile(depth=100, history=HistoryPolicy.KEEP_LAST)
        if static_qos is None:
            static_qos = QoSProfile(
                depth=100,
                durability=DurabilityPolicy.TRANSIENT_LOCAL,
                history=HistoryPolicy.KEEP_LAST,
            )
        self.buffer = buffer
        self.node = node
        # Otherwise a callback that waits for a transform would prevent its arrival.
        self.group = ReentrantCallbackGroup()
        msg_type = message_class("tf2_msgs/msg/TFMessage")
        self.tf_sub = node.create_subscription(
            msg_type, tf_topic, self.callback, qos, callback_group=self.group
        )
        self.tf_static_sub = node.create_subscription(
            msg_type, tf_static_topic, self.static_callback, static_qos, callback_group=self.group
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor()
            self.dedicated_listener_thread = Thread(target=self._TransformListener__spin)
            self.dedicated_listener_thread.start()

    def _TransformListener__spin(self) -> None:
        self.executor.add_node(self.node)
        self.executor.spin()
        self.executor.remove_node(self.node)

    def __del__(self) -> None:
        """End the thread and the subscriptions, as in tf2_ros."""
        if hasattr(self, "dedicated_listener_thread") and hasattr(self, "executor"):
            self.executor.shutdown()
            self.dedicated_listener_thread.join()
        if hasattr(self, "tf_static_sub"):
            self.unregister()

    def unregister(self) -> None:
        """Destroy both subscriptions."""
        self.node.destroy_subscription(self.tf_sub)
        self.node.destroy_subscription(self.tf_static_sub)

    def callback(self, data: Any) -> None:
        """Add transforms that may change."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, AUTHORITY)

    def static_callback(self, data: Any) -> None:
        """Add transforms that are valid at any time."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, AUTHORITY)
