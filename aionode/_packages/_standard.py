"""aionode's versions of programs from ROS's own packages, and the table that finds them."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from aionode._packages._executables import Executable

__all__ = [
    "is_terminal",
    "is_window",
    "program_module",
    "remark_on",
    "standard_executables",
    "standard_packages",
    "standard_plugin",
    "standard_share",
]

SHARE: Final = Path(__file__).parents[1] / "programs" / "_share"
"""The folder with the data, such as launch files, of the packages whose programs aionode has."""

MODULES: Final[dict[str, dict[str, str]]] = {
    "camera_ros": {"camera_node": "_camera.camera_node"},
    "cartographer_ros": {
        "cartographer_occupancy_grid_node": "_cartographer.occupancy_grid_node",
        "occupancy_grid_node": "_cartographer.occupancy_grid_node",
    },
    "ackermann_mux": {"ackermann_mux": "_command_mux.ackermann_mux"},
    "controller_manager": {
        "hardware_spawner": "_ros2_control.hardware_spawner",
        "ros2_control_node": "_ros2_control.manager",
        "spawner": "_ros2_control.spawner",
        "spawner.py": "_ros2_control.spawner",
        "unspawner": "_ros2_control.unspawner",
        "unspawner.py": "_ros2_control.unspawner",
    },
    "demo_nodes_cpp": {"listener": "_demo_nodes.listener", "talker": "_demo_nodes.talker"},
    "demo_nodes_py": {
        "listener": "_demo_nodes.listener",
        "talker": "_demo_nodes.talker_of_rclpy",
    },
    "diagnostic_aggregator": {
        "add_analyzer": "_diagnostics.add_analyzer",
        "aggregator_node": "_diagnostics.aggregator_node",
    },
    "domain_bridge": {"domain_bridge": "_domain_bridge.domain_bridge"},
    "dummy_map_server": {"dummy_map_server": "_demo_nodes.dummy_map_server"},
    "dummy_sensors": {
        "dummy_joint_states": "_demo_nodes.dummy_joint_states",
        "dummy_laser": "_demo_nodes.dummy_laser",
    },
    "foxglove_bridge": {"foxglove_bridge": "_bridges.foxglove_bridge"},
    "image_transport": {"republish": "_camera.republish"},
    "imu_complementary_filter": {
        "complementary_filter_node": "_imu_tools.complementary_filter_node"
    },
    "joy": {"joy_node": "_joy.joy_node"},
    "joy_linux": {"joy_linux_node": "_joy.joy_linux_node"},
    "joy_teleop": {"joy_teleop": "_joy.joy_teleop"},
    "joint_state_publisher": {"joint_state_publisher": "_joint_state_publisher"},
    "joint_state_publisher_gui": {"joint_state_publisher_gui": "_joint_state_publisher"},
    "nav2_amcl": {"amcl": "_amcl.amcl"},
    "nav2_lifecycle_manager": {"lifecycle_manager": "_lifecycle_manager"},
    "nav2_map_server": {"map_server": "_map_server.map_server"},
    "robot_localization": {
        "ekf_node": "_robot_localization.ekf_node",
        "ukf_node": "_robot_localization.ukf_node",
    },
    "robot_state_publisher": {"robot_state_publisher": "_robot_state_publisher"},
    "rosbridge_server": {"rosbridge_websocket": "_bridges.rosbridge_websocket"},
    "teleop_twist_keyboard": {"teleop_twist_keyboard": "_teleop_twist_keyboard"},
    "teleop_twist_joy": {"teleop_node": "_joy.teleop_node"},
    "tf2_ros": {
        "buffer_server": "_tf2.buffer_server",
        "tf2_echo": "_tf2.echo",
        "tf2_monitor": "_tf2.monitor",
        "static_transform_publisher": "_static_transform_publisher",
    },
    "topic_tools": {
        name: f"_topic_tools.{name}"
        for name in (
            *("delay", "demux", "drop", "mux", "relay", "relay_field", "throttle", "transform"),
        )
    },
    "turtlesim": {
        "draw_square": "_turtlesim.draw_square",
        "mimic": "_turtlesim.mimic",
        "turtle_teleop_key": "_turtlesim.teleop_key",
        "turtlesim_node": "_turtlesim.node",
    },
    "twist_mux": {"twist_mux": "_command_mux.twist_mux"},
    "urdf_launch": {},
    "urg_node": {"urg_node_driver": "_urg.urg_node_driver"},
    "usb_cam": {"usb_cam_node_exe": "_camera.usb_cam_node"},
    "v4l2_camera": {"v4l2_camera_node": "_camera.v4l2_camera_node"},
    "vesc_ackermann": {
        "ackermann_to_vesc_node": "_vesc.ackermann_to_vesc_node",
        "vesc_to_odom_node": "_vesc.vesc_to_odom_node",
    },
    "vesc_driver": {"vesc_driver_node": "_vesc.vesc_driver_node"},
    "ydlidar_ros2_driver": {"ydlidar_ros2_driver_node": "_ydlidar.ydlidar_ros2_driver_node"},
}
"""The module of `aionode.programs` for an executable, by package and name.

A package without executables has data only.
"""

PLUGINS: Final[dict[str, dict[str, tuple[str, str]]]] = {
    "camera_ros": {"camera::CameraNode": ("_camera.camera_node:CameraNode", "camera")},
    "composition": {
        "composition::Listener": ("_demo_nodes.listener:Listener", "listener"),
        "composition::Talker": ("_demo_nodes.talker:Talker", "talker"),
    },
    "demo_nodes_cpp": {
        "demo_nodes_cpp::Listener": ("_demo_nodes.listener:Listener", "listener"),
        "demo_nodes_cpp::Talker": ("_demo_nodes.talker:Talker", "talker"),
    },
    "image_transport": {
        "image_transport::Republisher": ("_camera.republish:Republisher", "image_republisher")
    },
    "joy": {"joy::Joy": ("_joy.joy_node:JoyNode", "joy_node")},
    "nav2_amcl": {"nav2_amcl::AmclNode": ("_amcl.amcl:Amcl", "amcl")},
    "nav2_lifecycle_manager": {
        "nav2_lifecycle_manager::LifecycleManager": (
            "_lifecycle_manager:Manager",
            "lifecycle_manager",
        )
    },
    "nav2_map_server": {
        "nav2_map_server::MapServer": ("_map_server.map_server:MapServer", "map_server")
    },
    "robot_state_publisher": {
        "robot_state_publisher::RobotStatePublisher": (
            "_robot_state_publisher:RobotStatePublisher",
            "robot_state_publisher",
        )
    },
    "teleop_twist_joy": {
        "teleop_twist_joy::TeleopTwistJoy": (
            "_joy.teleop_node:TeleopTwistJoy",
            "teleop_twist_joy_node",
        )
    },
    "tf2_ros": {
        "tf2_ros::StaticTransformBroadcasterNode": (
            "_static_transform_publisher:StaticTransformPublisher",
            "static_transform_publisher",
        )
    },
    "topic_tools": {
        f"topic_tools::{name}Node": (f"_topic_tools.{name.lower()}:{name}", name.lower())
        for name in ("Delay", "Demux", "Drop", "Mux", "Relay", "Throttle")
    },
    "urg_node": {"urg_node::UrgNode": ("_urg.urg_node_driver:UrgNode", "urg_node")},
    "usb_cam": {"usb_cam::UsbCamNode": ("_camera.usb_cam_node:UsbCam", "usb_cam")},
    "v4l2_camera": {
        "v4l2_camera::V4L2Camera": ("_camera.v4l2_camera_node:V4L2Camera", "v4l2_camera")
    },
    "vesc_ackermann": {
        "vesc_ackermann::AckermannToVesc": (
            "_vesc.ackermann_to_vesc_node:AckermannToVesc",
            "ackermann_to_vesc_node",
        ),
        "vesc_ackermann::VescToOdom": ("_vesc.vesc_to_odom_node:VescToOdom", "vesc_to_odom_node"),
    },
    "vesc_driver": {
        "vesc_driver::VescDriver": ("_vesc.vesc_driver_node:VescDriver", "vesc_driver")
    },
}
"""The node class of `aionode.programs` that is a plugin for containers, by package and name.

With each is the name of its node, if it is given no other one.
"""

WINDOWS: Final[dict[str, frozenset[str]]] = {
    **dict.fromkeys(("mapviz", "moveit_setup_assistant", "plotjuggler", "rviz2"), frozenset()),
    "image_view": frozenset({"disparity_view", "image_view", "stereo_view"}),
    "rviz_common": frozenset(),
}
"""Packages of windows, with the executables that are windows; none named means all of them.

Those whose name begins with ``rqt`` are windows as well.
"""

TERMINALS: Final = frozenset(
    {
        *("gnome-terminal", "konsole", "lxterminal", "mate-terminal", "terminator", "urxvt"),
        *("x-terminal-emulator", "xfce4-terminal", "xterm"),
    }
)
"""Programs that open a window in which another program runs."""

WINDOW: Final = (
    "a graphical tool of ROS 2 in C++; use the page of `aionode gateway`, or Foxglove connected to "
    "it"
)

REMARKS: Final[dict[str, str]] = {
    **dict.fromkeys(
        ("gazebo_ros", "ros_gz_sim", "ros_ign_gazebo", "gz_sim", "ignition_gazebo"),
        "the simulator Gazebo, in C++; a node that integrates commands, such as the one in the "
        "examples, can stand in for a base",
    ),
    **dict.fromkeys(
        ("ros_gz_bridge", "ros_ign_bridge"),
        "the bridge to the simulator Gazebo, in C++; without Gazebo nothing needs it",
    ),
    **dict.fromkeys(
        ("slam_toolbox", "cartographer_ros"),
        "a mapping program in C++; a ROS 2 with rmw_zenoh can run it beside aionode",
    ),
    **dict.fromkeys(
        (
            *(
                "nav2_controller",
                "nav2_planner",
                "nav2_behaviors",
                "nav2_bt_navigator",
            ),
            *("nav2_map_server", "nav2_smoother", "nav2_waypoint_follower", "nav2_bringup"),
            *("nav2_velocity_smoother", "nav2_collision_monitor", "nav2_route", "nav2_costmap_2d"),
        ),
        "a server of Nav2 in C++; a ROS 2 with rmw_zenoh can run it beside aionode",
    ),
    **dict.fromkeys(
        ("ros2_control", "moveit_ros_move_group", "moveit_servo"),
        "a program in C++ that loads plugins; a ROS 2 with rmw_zenoh can run it beside aionode",
    ),
    **dict.fromkeys(
        ("image_proc", "depth_image_proc", "stereo_image_proc"),
        "a set of image processing plugins in C++; write a node with aionode.image and OpenCV, or "
        "run it beside aionode in a ROS 2 with rmw_zenoh",
    ),
    "rclcpp_components": (
        "the container for C++ nodes; node classes of aionode need none: "
        "ComposableNode(plugin='my_robot.nodes:Driver')"
    ),
}
"""Packages that aionode cannot provide: what they are, and what to use instead."""


def remark_on(package: str, executable: str = "") -> str:
    """Return what a package, or an executable, is and what to use instead, if it needs ROS 2."""
    return REMARKS.get(package, "") or (WINDOW if is_window(package, executable) else "")


def is_window(package: str, executable: str = "") -> bool:
    """Return whether a package, or one of its executables, only shows something on a screen.

    A robot runs without it, on a computer that has no screen.

    Args:
        package: The name of the package.
        executable: The name of the executable; empty for what the whole package is.
    """
    if package.startswith("rqt"):
        return True
    named = WINDOWS.get(package)
    return named is not None and (not named or executable in named)


def is_terminal(program: str) -> bool:
    """Return whether a program opens a window in which another program runs."""
    return Path(program).name in TERMINALS


def program_module(package: str, name: str) -> str | None:
    """Return the module name of a package's executable, if aionode has it."""
    module = MODULES.get(package, {}).get(name)
    return None if module is None else f"aionode.programs.{module}"


def standard_packages() -> list[str]:
    """Return the names of the packages of which aionode has programs or data."""
    return sorted(MODULES)


def standard_share(package: str) -> Path | None:
    """Return the folder with the data that aionode has of a package."""
    folder = SHARE / package
    return folder if package in MODULES and folder.is_dir() else None


def standard_plugin(package: str, plugin: str) -> tuple[str, str] | None:
    """Return the node class that is a plugin of a package, as ``module:Class``, and its name."""
    known = PLUGINS.get(package, {}).get(plugin)
    return None if known is None else (f"aionode.programs.{known[0]}", known[1])


def standard_executables(package: str) -> dict[str, Executable]:
    """Return aionode's versions of a package's executables."""
    return {
        name: Executable(package, name, module, is_standard=True)
        for name, module in MODULES.get(package, {}).items()
    }
