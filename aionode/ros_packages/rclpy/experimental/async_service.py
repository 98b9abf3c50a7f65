"""`AsyncService`, which rclpy of ROS 2 Lyrical has in its own module."""

from rclpy.experimental.async_node import AsyncService

__all__ = ["AsyncService"]
