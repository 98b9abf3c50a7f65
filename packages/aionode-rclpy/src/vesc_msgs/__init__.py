"""The package vesc_msgs of ROS 2, from aionode."""

from aionode.rclpy._finder import provide

provide(__name__)
