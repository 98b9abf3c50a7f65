"""Publishes transforms that change."""

from __future__ import annotations

from aionode import tf
from rosidl_generator_py import message_class

__all__ = ["TransformBroadcaster"]


class TransformBroadcaster(tf.TransformBroadcaster):
    """Publishes transforms on /tf, with an rclpy node."""

    _TransformBroadcaster__message = message_class("tf2_msgs/msg/TFMessage")
