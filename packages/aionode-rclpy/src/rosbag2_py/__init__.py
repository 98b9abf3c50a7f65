"""The package rosbag2_py of ROS 2, from aionode."""

from aionode.rclpy._finder import provide

provide(__name__)
