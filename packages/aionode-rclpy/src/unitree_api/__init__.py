"""The package unitree_api of ROS 2, from aionode."""

from aionode.rclpy._finder import provide

provide(__name__)
