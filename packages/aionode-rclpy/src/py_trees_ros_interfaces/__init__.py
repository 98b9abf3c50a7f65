"""The package py_trees_ros_interfaces of ROS 2, from aionode."""

from aionode.rclpy._finder import provide

provide(__name__)
