"""The package visualization_msgs of ROS 2, from aionode."""

from aionode.rclpy import provide

provide(__name__)
