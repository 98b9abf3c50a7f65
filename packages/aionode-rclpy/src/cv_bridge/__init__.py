"""The package cv_bridge of ROS 2, from aionode."""

from aionode.rclpy._finder import provide

provide(__name__)
