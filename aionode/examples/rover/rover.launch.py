"""The rover as a launch file of ROS 2, with a process for each part.

Start it with ``aionode launch`` and the path of this file; ``use_sim_time:=true rate:=5.0`` makes
it run five times as fast.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import Node, SetParameter


def part(name: str, **parameters: LaunchConfiguration) -> Node:
    """Return one part of the rover: the program beside this file."""
    program = PathJoinSubstitution([ThisLaunchFileDir(), f"{name}.py"])
    return Node(executable=program, name=name, parameters=[parameters])


def generate_launch_description() -> LaunchDescription:
    """Return the four nodes and the page."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="false"),
            DeclareLaunchArgument("rate", default_value="1.0"),
            DeclareLaunchArgument("port", default_value="8090"),
            SetParameter("use_sim_time", LaunchConfiguration("use_sim_time")),
            part("simulator", rate=LaunchConfiguration("rate")),
            part("description"),
            part("battery"),
            part("driver"),
            part("page", port=LaunchConfiguration("port")),
        ]
    )
