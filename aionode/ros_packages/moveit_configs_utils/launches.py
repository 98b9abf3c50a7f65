"""`moveit_configs_utils.launches`: the launch files that MoveIt's Setup Assistant writes."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description import LaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from moveit_configs_utils.launch_utils import DeclareBooleanLaunchArg, add_debuggable_node
from moveit_configs_utils.moveit_configs_builder import MoveItConfigs

__all__ = [
    "generate_demo_launch",
    "generate_move_group_launch",
    "generate_moveit_rviz_launch",
    "generate_rsp_launch",
    "generate_setup_assistant_launch",
    "generate_spawn_controllers_launch",
    "generate_static_virtual_joint_tfs_launch",
    "generate_warehouse_db_launch",
]


def generate_rsp_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return the description that starts robot_state_publisher."""
    frequency = {"publish_frequency": LaunchConfiguration("publish_frequency")}
    node = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        respawn=True,
        output="screen",
        parameters=[moveit_config.robot_description, frequency],
    )
    argument = DeclareLaunchArgument("publish_frequency", default_value="15.0")
    return LaunchDescription([argument, node])


def generate_moveit_rviz_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return the description that starts RViz."""
    config = package_of(moveit_config) / "config" / "moveit.rviz"
    description = LaunchDescription(
        [
            DeclareBooleanLaunchArg("debug", default_value=False),
            DeclareLaunchArgument("rviz_config", default_value=str(config)),
        ]
    )
    add_debuggable_node(
        description,
        package="rviz2",
        executable="rviz2",
        output="log",
        respawn=False,
        arguments=["-d", LaunchConfiguration("rviz_config")],
        parameters=[
            moveit_config.planning_pipelines,
            moveit_config.robot_description_kinematics,
            moveit_config.joint_limits,
        ],
    )
    return description


def generate_setup_assistant_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return the description that starts the Setup Assistant."""
    description = LaunchDescription([DeclareBooleanLaunchArg("debug", default_value=False)])
    add_debuggable_node(
        description,
        package="moveit_setup_assistant",
        executable="moveit_setup_assistant",
        arguments=[["--config_pkg=", str(moveit_config.package_path)]],
    )
    return description


def generate_static_virtual_joint_tfs_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return the description that publishes a transform for each virtual joint of the SRDF."""
    frames = [
        pair
        for text in moveit_config.robot_description_semantic.values()
        for pair in virtual_joints(text)
    ]
    return LaunchDescription(
        Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            name=f"static_transform_publisher{number}",
            output="log",
            arguments=["--frame-id", parent, "--child-frame-id", child],
        )
        for number, (parent, child) in enumerate(frames)
    )


def generate_spawn_controllers_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return the description that starts the controllers."""
    manager = moveit_config.trajectory_execution.get("moveit_simple_controller_manager", {})
    return LaunchDescription(
        Node(
            package="controller_manager",
            executable="spawner",
            arguments=[controller],
            output="screen",
        )
        for controller in [*manager.get("controller_names", []), "joint_state_broadcaster"]
    )


def generate_warehouse_db_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return the description that starts the database of scenes."""
    path = package_of(moveit_config) / "default_warehouse_mongo_db"
    parameters: dict[str, Any] = {
        "overwrite": False,
        "database_path": LaunchConfiguration("moveit_warehouse_database_path"),
        "warehouse_port": LaunchConfiguration("moveit_warehouse_port"),
        "warehouse_host": LaunchConfiguration("moveit_warehouse_host"),
        "warehouse_exec": "mongod",
        "warehouse_plugin": "warehouse_ros_mongo::MongoDatabaseConnection",
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument("moveit_warehouse_database_path", default_value=str(path)),
            DeclareBooleanLaunchArg("reset", default_value=False),
            DeclareLaunchArgument("moveit_warehouse_port", default_value="33829"),
            DeclareLaunchArgument("moveit_warehouse_host", default_value="localhost"),
            Node(
                package="warehouse_ros_mongo",
                executable="mongo_wrapper_ros.py",
                parameters=[parameters],
            ),
            Node(
                package="moveit_ros_warehouse",
                executable="moveit_init_demo_warehouse",
                output="screen",
                condition=IfCondition(LaunchConfiguration("reset")),
            ),
        ]
    )


def generate_move_group_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return the description that starts move_group."""
    capabilities = moveit_config.move_group_capabilities
    description = LaunchDescription(
        [
            DeclareBooleanLaunchArg("debug", default_value=False),
            DeclareBooleanLaunchArg("allow_trajectory_execution", default_value=True),
            DeclareBooleanLaunchArg("publish_monitored_planning_scene", default_value=True),
            *(
                DeclareLaunchArgument(name, default_value=capabilities[name])
                for name in ("capabilities", "disable_capabilities")
            ),
            DeclareBooleanLaunchArg("monitor_dynamics", default_value=False),
        ]
    )
    should_publish = LaunchConfiguration("publish_monitored_planning_scene")
    parameters = {
        "publish_robot_description_semantic": True,
        "allow_trajectory_execution": LaunchConfiguration("allow_trajectory_execution"),
        **{  # as texts, since they may be empty
            name: ParameterValue(LaunchConfiguration(name), value_type=str)
            for name in ("capabilities", "disable_capabilities")
        },
        "publish_planning_scene": should_publish,
        "publish_geometry_updates": should_publish,
        "publish_state_updates": should_publish,
        "publish_transforms_updates": should_publish,
        "monitor_dynamics": False,
    }
    add_debuggable_node(
        description,
        package="moveit_ros_move_group",
        executable="move_group",
        commands_file=str(package_of(moveit_config) / "launch" / "gdb_settings.gdb"),
        output="screen",
        parameters=[moveit_config.to_dict(), parameters],
        extra_debug_args=["--debug"],
        additional_env={"DISPLAY": os.environ.get("DISPLAY", "")},
    )
    return description


def generate_demo_launch(
    moveit_config: MoveItConfigs, launch_package_path: Path | None = None
) -> LaunchDescription:
    """Return the description of a demo that needs no hardware.

    Args:
        moveit_config: Its parameters.
        launch_package_path: The package with the other launch files, if they are elsewhere.
    """
    folder = (launch_package_path or package_of(moveit_config)) / "launch"

    def included(name: str, wanted: str | None = None) -> IncludeLaunchDescription:
        condition = None if wanted is None else IfCondition(LaunchConfiguration(wanted))
        source = PythonLaunchDescriptionSource(str(folder / f"{name}.launch.py"))
        return IncludeLaunchDescription(source, condition=condition)

    virtual_joints_file = folder / "static_virtual_joint_tfs.launch.py"
    controllers = package_of(moveit_config) / "config" / "ros2_controllers.yaml"
    return LaunchDescription(
        [
            DeclareBooleanLaunchArg(
                "db", default_value=False, description="Whether to start a database"
            ),
            DeclareBooleanLaunchArg("debug", default_value=False, description="Whether to debug"),
            DeclareBooleanLaunchArg("use_rviz", default_value=True),
            *([included("static_virtual_joint_tfs")] if virtual_joints_file.exists() else []),
            included("rsp"),
            included("move_group"),
            included("moveit_rviz", "use_rviz"),
            included("warehouse_db", "db"),
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[str(controllers)],
                remappings=[("/controller_manager/robot_description", "/robot_description")],
            ),
            included("spawn_controllers"),
        ]
    )


def package_of(moveit_config: MoveItConfigs) -> Path:
    """Return the folder of the robot's package.

    Raises:
        ValueError: The configuration has none.
    """
    if moveit_config.package_path is None:
        raise ValueError("moveit_config: has no package_path; take it from MoveItConfigsBuilder")
    return Path(moveit_config.package_path)


def virtual_joints(semantic: str) -> Iterator[tuple[str, str]]:
    """Yield the frames of each virtual joint of an SRDF: its parent and its child."""
    root = ET.fromstring(semantic)  # noqa: S314  # of the robot's package, like the launch file
    for joint in root.iter("virtual_joint"):
        yield joint.get("parent_frame", ""), joint.get("child_link", "")
