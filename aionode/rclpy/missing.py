"""Advice about ROS modules that aionode does not have."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

__all__ = ["advice", "missing_modules"]

INTERFACES: Final = re.compile(r"\w+_(msgs|interfaces|srvs|actions?)")
"""The pattern of names of packages that define interfaces, by any author."""

PURE_PYTHON: Final = """
    action_tutorials_py camera_info_manager_py diagnostic_common_diagnostics
    joint_state_publisher laser_geometry
    rclpy_message_converter
    resource_retriever ros2component ros2doctor ros2interface rosapi rosbridge_library
    rosbridge_server rosidl_adapter rosidl_cli rosidl_pycommon rpyutils smach smach_ros
    teleop_twist_joy teleop_twist_keyboard tf2_tools twist_stamper urdf_parser_py
"""
"""ROS packages without compiled modules, which work from source."""

INSTEAD: Final = {
    "launch_testing": "aionode's fixtures for pytest start nodes in tests",
    "tf2_kdl": "tf_transformations computes with rotations in numpy",
    "PyKDL": "tf_transformations computes with rotations in numpy",
    "image_geometry": "OpenCV (`pip install 'aionode[opencv]'`) has its functions",
    "xacro": "`pip install 'aionode[xacro]'` brings it",
    "rospkg": "`pip install rospkg` has it",
    "catkin_pkg": "`pip install catkin_pkg` has it",
    "osrf_pycommon": "`pip install osrf-pycommon` has it",
    "cv2": "`pip install 'aionode[opencv]'` brings it",
    "matplotlib": "`pip install 'aionode[desktop]'` brings it",
    "py_trees": "`pip install 'aionode[py-trees]'` brings it",
    "requests": "`pip install 'aionode[desktop]'` brings it",
    "scipy": "`pip install 'aionode[desktop]'` brings it",
    "serial": "`pip install 'aionode[serial]'` brings it",
    "transforms3d": "`pip install 'aionode[desktop]'` brings it",
}
"""The replacement of a package, or where to get it."""

COMPILED: Final = """
    controller_manager image_transport_py moveit point_cloud_transport_py python_qt_binding
    qt_dotgraph qt_gui rmw_implementation rosidl_runtime_c rqt rqt_gui
    rqt_gui_py rqt_py_common sros2
"""
"""Packages with compiled modules, or that need an installed ROS 2."""

ROS_1: Final = """
    actionlib dynamic_reconfigure message_generation roslaunch roslib rosnode rosparam rospy rostest
    rostopic tf tf_conversions
"""
"""Packages that exist only in ROS 1."""

NOT_OF_ROS: Final = {"cv2", "matplotlib", "py_trees", "requests", "scipy", "serial", "transforms3d"}
"""Modules that ROS brings along, or that its programs use beside it."""


def advice(module: str, supplied: frozenset[str] = frozenset()) -> str | None:
    """Explain a missing ROS module and what to do; None if its name is unknown.

    Args:
        module: The full name of the module.
        supplied: The packages that aionode provides in place of ROS's.
    """
    package = module.partition(".")[0]
    if package in supplied:
        return (
            f"{package} is from aionode here, which does not have {module}; docs/compatibility.md "
            "says what differs"
        )
    if package in INSTEAD:
        what = "a package" if package in NOT_OF_ROS else "a package of ROS 2"
        return f"{package} is {what} that aionode does not have; {INSTEAD[package]}"
    if package in ROS_1.split():
        return f"{package} is a package of ROS 1; aionode runs programs of ROS 2"
    if package in COMPILED.split():
        return (
            f"{package} is a package of ROS 2 that aionode does not have, and needs compiled "
            "modules; run the program where ROS 2 is installed, and aionode's nodes beside it"
        )
    if package in PURE_PYTHON.split():
        return (
            f"{package} is a package of ROS 2 that aionode does not have; it is pure Python: get "
            "its source, and put the folder that holds its Python package on PYTHONPATH"
        )
    if INTERFACES.fullmatch(package):
        return (
            f"{package} is a package of messages that aionode does not have; get its definitions "
            f"({package}/msg/*.msg and the like), and name the folder that holds {package}: "
            "aionode run --interfaces FOLDER PROGRAM; packages of a sourced workspace "
            "(AMENT_PREFIX_PATH) are found without it"
        )
    return None


def missing_modules(error: BaseException | None) -> list[str]:
    """Return, without duplicates, the modules not found in an exception, its causes and parts."""
    return list(dict.fromkeys(found_missing(error, set())))


def found_missing(error: BaseException | None, seen: set[int]) -> Iterator[str]:
    """Yield the module of each failed import shown by a traceback of the exception."""
    if error is None or id(error) in seen:
        return
    seen.add(id(error))
    hidden = error.__suppress_context__ and error.__cause__ is None
    yield from found_missing(error.__cause__, seen)
    if not hidden and error.__cause__ is None:
        yield from found_missing(error.__context__, seen)
    if isinstance(error, BaseExceptionGroup):
        for part in error.exceptions:
            yield from found_missing(part, seen)
    # A folder beside the program, such as a message package, was imported as a package.
    is_folder = isinstance(error, ImportError) and "(unknown location)" in str(error)
    if isinstance(error, ModuleNotFoundError) or is_folder:
        yield getattr(error, "name", None) or ""
