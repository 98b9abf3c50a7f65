"""`AsyncPublisher`, which rclpy of ROS 2 Lyrical has in its own module."""

from rclpy.experimental.async_node import AsyncPublisher

__all__ = ["AsyncPublisher"]
