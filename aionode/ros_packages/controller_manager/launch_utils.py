"""`controller_manager.launch_utils`: descriptions that spawn controllers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node

__all__ = [
    "generate_controllers_spawner_launch_description",
    "generate_controllers_spawner_launch_description_from_dict",
    "generate_load_controller_launch_description",
    "generate_spawner_launch_description",
]


def generate_controllers_spawner_launch_description(
    controller_names: Sequence[Any],
    controller_params_files: Sequence[Any] | None = None,
    extra_spawner_args: Sequence[Any] = (),
    *,
    controller_type: str | None = None,
) -> LaunchDescription:
    """Return a description that spawns controllers.

    Its arguments are `controller_manager_name` and `unload_on_kill`.

    Args:
        controller_names: Their names.
        controller_params_files: Files with their parameters.
        extra_spawner_args: More arguments of the spawner.
        controller_type: Their type, as in Humble; by default the parameters have it.
    """
    manager, unloads = "controller_manager_name", "unload_on_kill"
    words = [*controller_names, "--controller-manager", LaunchConfiguration(manager)]
    if controller_type:
        words += ["--controller-type", controller_type]
    words += with_flag("--param-file", controller_params_files or ())
    unloading = ['"--unload-on-kill" if "true" == "', LaunchConfiguration(unloads), '" else ""']
    words += [PythonExpression(unloading), *extra_spawner_args]
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                manager,
                default_value="controller_manager",
                description="Controller manager node name",
            ),
            DeclareLaunchArgument(
                unloads,
                default_value="false",
                description="Wait until the node is interrupted and then unload controller",
            ),
            spawner(words),
        ]
    )


def generate_controllers_spawner_launch_description_from_dict(
    controller_info_dict: Mapping[str, Any], extra_spawner_args: Sequence[Any] = ()
) -> LaunchDescription:
    """Return a description that spawns controllers.

    Args:
        controller_info_dict: The file of parameters of each, a list of files, or None.
        extra_spawner_args: More arguments of the spawner.

    Raises:
        ValueError: There is something else instead.
    """
    files = [file for given in controller_info_dict.values() for file in files_of(given)]
    return generate_controllers_spawner_launch_description(
        list(controller_info_dict), files, extra_spawner_args
    )


def generate_load_controller_launch_description(
    controller_name: str,
    controller_params_file: Any = None,
    extra_spawner_args: Sequence[Any] = (),
    *,
    controller_type: str | None = None,
) -> LaunchDescription:
    """Return a description that spawns one controller.

    Args:
        controller_name: Its name.
        controller_params_file: A file with its parameters.
        extra_spawner_args: More arguments of the spawner.
        controller_type: Its type, as in Humble; by default the parameters have it.
    """
    files = [controller_params_file] if controller_params_file else None
    return generate_controllers_spawner_launch_description(
        [controller_name], files, extra_spawner_args, controller_type=controller_type
    )


def generate_spawner_launch_description(
    controller_info_dict: Mapping[str, Mapping[str, Any]], extra_spawner_args: Sequence[Any] = ()
) -> LaunchDescription:
    """Return a description that spawns controllers, each with options of its own.

    Args:
        controller_info_dict: The options of each: `param_file`, `load_only`, `inactive` and
            `ros_args`.
        extra_spawner_args: The options for all.

    Raises:
        ValueError: `param_file` is neither a file nor a list of files.
    """
    words: list[Any] = []
    for name, options in controller_info_dict.items():
        words += [
            "--controller",
            name,
            *with_flag("--param-file", files_of(options.get("param_file"))),
        ]
        words += [
            flag
            for key, flag in (("load_only", "--load-only"), ("inactive", "--inactive"))
            if options.get(key)
        ]
        if "ros_args" in options:
            words += ["--controller-ros-args", options["ros_args"]]
    return LaunchDescription([spawner([*words, *extra_spawner_args])])


def files_of(given: Any) -> list[Any]:
    """Return the files that are given as one, several or none.

    Raises:
        ValueError: It is something else.
    """
    if given is None or isinstance(given, str):
        return [given] if given else []
    if not isinstance(given, list):
        raise ValueError(f"Invalid controller_params_file type parsed in the dict {given}")
    return given


def with_flag(flag: str, values: Sequence[Any]) -> list[Any]:
    """Return values, each behind a flag."""
    return [word for value in values if value for word in (flag, value)]


def spawner(words: Sequence[Any]) -> Node:
    """Return the spawner, which ignores arguments that are empty."""
    return Node(
        package="controller_manager",
        executable="spawner",
        arguments=words,
        output="screen",
    )
