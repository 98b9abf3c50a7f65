"""The package sensor_msgs_py of ROS 2, from aionode."""

from aionode.rclpy import provide

provide(__name__)
