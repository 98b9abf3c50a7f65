"""Publishes transforms that never change."""

from __future__ import annotations

from aionode import tf
from rosidl_generator_py import message_class

__all__ = ["StaticTransformBroadcaster"]


class StaticTransformBroadcaster(tf.StaticTransformBroadcaster):
    """Publishes transforms on /tf_static, with an rclpy node: all transforms so far, each time.

    A transform of the same child frame replaces the earlier one; tf2_ros's Python keeps the first,
    its C++ the last.
    """

    _StaticTransformBroadcaster__message = message_class("tf2_msgs/msg/TFMessage")
