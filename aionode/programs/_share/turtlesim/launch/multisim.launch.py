"""Two windows of turtlesim, each with a turtle of its own."""

from __future__ import annotations

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return what is started."""
    return LaunchDescription(
        [
            Node(
                namespace=namespace,
                package="turtlesim",
                executable="turtlesim_node",
                output="screen",
            )
            for namespace in ("turtlesim1", "turtlesim2")
        ]
    )
