"""A robot of four programs, as a launch file of ROS 2.

Start it with ``aionode launch examples/robot.launch.py``, or ask first what it starts:
``aionode launch examples/robot.launch.py speed:=0.8 --print``. Ctrl-C stops all of it.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import Node, PushRosNamespace


def program(name: str) -> PathJoinSubstitution:
    """Return the path of a program beside this file."""
    return PathJoinSubstitution([ThisLaunchFileDir(), name])


def generate_launch_description() -> LaunchDescription:
    """Return the programs to start, with their parameters."""
    driver = Node(
        executable=program("driver.py"),
        name="driver",
        parameters=[{"speed": LaunchConfiguration("speed")}],
    )
    counter = Node(
        executable=program("word_counter.py"),
        name="counter",
        remappings=[("/robot/message", "/chatter")],
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("speed", default_value="0.5", description="in m/s"),
            GroupAction([PushRosNamespace("robot"), driver]),
            Node(executable=program("talker.py"), name="talker"),
            Node(executable=program("listener.py"), name="listener"),
            counter,
        ]
    )
