"""The package unitree_go of ROS 2, from aionode."""

from aionode.rclpy._finder import provide

provide(__name__)
