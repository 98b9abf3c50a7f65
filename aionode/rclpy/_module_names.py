"""Gives classes of `aionode.rclpy` the module that they have in rclpy, as tracebacks show it.

A module is one object under two names, so pickles and `inspect` find the classes there.
"""

from __future__ import annotations

import sys
from types import FunctionType, ModuleType
from typing import Final

__all__ = ["ALIASES", "shared_errors_take_names", "take_names"]

ALIASES: Final = {
    "rclpy": "aionode.rclpy",
    "rosidl_parser": "aionode.rclpy._rosidl_parser",
    "rosidl_runtime_py": "aionode.rclpy._rosidl_runtime_py",
    "sensor_msgs_py": "aionode.rclpy._sensor_msgs_py",
    "ament_index_python": "aionode.rclpy._ament_index_python",
    "tf2_py": "aionode.rclpy._tf2_py",
    "tf2_ros": "aionode.rclpy._tf2_ros",
    "tf2_geometry_msgs": "aionode.rclpy._tf2_geometry_msgs",
    "tf2_sensor_msgs": "aionode.rclpy._tf2_sensor_msgs",
    "launch": "aionode.launch._launch",
    "launch_ros": "aionode.launch._launch_ros",
    "launch_xml": "aionode.launch._launch_xml",
    "launch_yaml": "aionode.launch._launch_yaml",
    "launch_param_builder": "aionode.launch._launch_param_builder",
    "nav2_common": "aionode.launch._nav2_common",
    "cv_bridge": "aionode.rclpy._cv_bridge",
    "message_filters": "aionode.rclpy._message_filters",
    "ros2_numpy": "aionode.rclpy._ros2_numpy",
    "rosbag2_py": "aionode.rclpy._rosbag2_py",
    "tf_transformations": "aionode.rclpy._tf_transformations",
}
"""The packages of ROS that are packages of aionode; their modules are the same objects."""

YIELDING: Final = ("launch_param_builder", "nav2_common")
"""Those of them that give way to a package of the workspace, or an installed one, of their name."""

EXTENSION: Final = {"aionode.rclpy._impl.errors": "rclpy._rclpy_pybind11"}
"""The exceptions of rclpy's extension module stand in a module of their own here."""
SHARED_ELSEWHERE: Final = {
    "InvalidQoSProfileException": "rclpy.qos",
    "InvalidQosOverridesError": "rclpy.qos_overriding_options",
}
"""The exceptions of `aionode.errors` that rclpy has outside of ``rclpy.exceptions``."""


def name_in_ros(own: str) -> str | None:
    """Return the name that a module of aionode has in ROS; None if it has none."""
    for alias, package in reversed(ALIASES.items()):  # that of rclpy, which has the others, is last
        if f"{own}.".startswith(f"{package}."):
            inside = own.removeprefix(package)
            return EXTENSION.get(own) or (None if "._" in inside else alias + inside)
    return None


def take_names(module: ModuleType) -> None:
    """Let what a module of aionode defines say the module's name in ROS, and be found there."""
    shown = name_in_ros(module.__name__)
    if shown is None:
        return
    if shown not in EXTENSION.values():
        sys.modules.setdefault(shown, module)
    for value in list(vars(module).values()):
        if isinstance(value, type | FunctionType) and value.__module__ == module.__name__:
            value.__module__ = shown


def shared_errors_take_names() -> None:
    """Let the exceptions that rclpy has as well say that they are of rclpy.

    For processes that run a program of rclpy; elsewhere they are those of `aionode.errors`.
    """
    from aionode import errors
    from aionode.rclpy import exceptions

    shared = {**dict.fromkeys(exceptions.__all__, "rclpy.exceptions"), **SHARED_ELSEWHERE}
    for name, shown in shared.items():
        error = getattr(errors, name, None)
        if error is not None:
            error.__module__ = shown
