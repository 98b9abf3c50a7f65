"""A robot's description, the states of its joints, and a window that shows both."""

from __future__ import annotations

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return what is started."""
    names = ("urdf_package", "urdf_package_path")
    has_sliders = LaunchConfiguration("jsp_gui")
    return LaunchDescription(
        [
            DeclareLaunchArgument("jsp_gui", default_value="true", choices=["true", "false"]),
            DeclareLaunchArgument("rviz_config", default_value=""),
            IncludeLaunchDescription(
                [ThisLaunchFileDir(), "/description.launch.py"],
                launch_arguments={name: LaunchConfiguration(name) for name in names}.items(),
            ),
            Node(
                package="joint_state_publisher",
                executable="joint_state_publisher",
                condition=UnlessCondition(has_sliders),
            ),
            Node(
                package="joint_state_publisher_gui",
                executable="joint_state_publisher_gui",
                condition=IfCondition(has_sliders),
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", LaunchConfiguration("rviz_config")],
            ),
        ]
    )
