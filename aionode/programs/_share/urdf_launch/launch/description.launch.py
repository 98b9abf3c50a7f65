"""A robot's description in URDF or xacro, published by robot_state_publisher."""

from __future__ import annotations

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Return what is started."""
    file = PathJoinSubstitution(
        [
            FindPackageShare(LaunchConfiguration("urdf_package")),
            LaunchConfiguration("urdf_package_path"),
        ]
    )
    description = ParameterValue(Command(["xacro ", file]), value_type=str)
    return LaunchDescription(
        [
            DeclareLaunchArgument("urdf_package", description="Package with the description"),
            DeclareLaunchArgument("urdf_package_path", description="Its file in that package"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
            ),
        ]
    )
