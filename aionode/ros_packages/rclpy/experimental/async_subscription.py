"""`AsyncSubscription`, as rclpy of ROS 2 Lyrical has it in a module of its own."""

from rclpy.experimental.async_node import AsyncSubscription

__all__ = ["AsyncSubscription"]
