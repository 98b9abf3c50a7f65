"""`moveit_configs_utils.launch_utils`: what the launch files of MoveIt have in common."""

from __future__ import annotations

from typing import Any

from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.launch_description import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

__all__ = ["DeclareBooleanLaunchArg", "add_debuggable_node"]


class DeclareBooleanLaunchArg(DeclareLaunchArgument):
    """An argument that is true or false."""

    def __init__(
        self,
        name: str,
        *,
        default_value: bool | str = False,
        description: str | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(
            name,
            default_value=str(default_value),
            description=description,
            choices=["true", "false", "True", "False"],
            **kwargs,
        )


def add_debuggable_node(
    ld: LaunchDescription,
    package: str,
    executable: str,
    condition_name: str = "debug",
    commands_file: str | None = None,
    extra_debug_args: list[str] | None = None,
    **kwargs: Any,
) -> None:
    """Add a node to a description, and the same under gdb; a configuration chooses one of them."""
    wanted = LaunchConfiguration(condition_name)
    node = {"package": package, "executable": executable, **kwargs}
    ld.add_action(Node(condition=UnlessCondition(wanted), **node))
    commands = f"-x {commands_file} " if commands_file else ""
    debugged = {**node, "prefix": [f"gdb {commands}--ex run --args"]}
    if "arguments" in kwargs:
        debugged["arguments"] = [*kwargs["arguments"], *(extra_debug_args or [])]
    ld.add_action(Node(condition=IfCondition(wanted), **debugged))
