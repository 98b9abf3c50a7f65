"""Actions that apply to all later nodes, to the end of their group."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.actions import TimerAction
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from launch_ros.namespaces import namespace_in
from launch_ros.parameter_descriptions import evaluate_values

__all__ = [
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]


def add(context: LaunchContext, key: str, values: list[Any]) -> None:
    """Add to a list that ends with the group; the outer group's list stays unchanged."""
    context.launch_configurations[key] = [*context.launch_configurations.get(key, ()), *values]


class PushROSNamespace(Action):
    """Adds a namespace for nodes."""

    def __init__(self, namespace: SomeSubstitutionsType, **options: Any) -> None:
        super().__init__(**options)
        self.namespace = normalize_to_list_of_substitutions(namespace)

    def execute(self, context: LaunchContext) -> None:
        """Add the namespace."""
        pushed = perform_substitutions(context, self.namespace)
        context.launch_configurations["ros_namespace"] = namespace_in(context, pushed)


PushRosNamespace = PushROSNamespace


class SetParameter(Action):
    """Sets a parameter of all nodes."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **options: Any) -> None:
        super().__init__(**options)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = value

    def execute(self, context: LaunchContext) -> None:
        """Add the parameter."""
        name = perform_substitutions(context, self.name)
        add(context, "global_params", list(evaluate_values(context, {name: self.value}).items()))


class SetParametersFromFile(Action):
    """Sets a parameter file for all nodes."""

    def __init__(self, filename: SomeSubstitutionsType, **options: Any) -> None:
        super().__init__(**options)
        self._SetParametersFromFile__filename = normalize_to_list_of_substitutions(filename)

    def execute(self, context: LaunchContext) -> None:
        """Add the parameter file."""
        add(
            context,
            "global_params",
            [perform_substitutions(context, self._SetParametersFromFile__filename)],
        )


class SetUseSimTime(Action):
    """Sets whether launch's own node uses simulated time; other nodes have a parameter for it."""

    def __init__(self, value: Any, **options: Any) -> None:
        super().__init__(**options)
        self.value = value


class SetRemap(Action):
    """Sets a remapping rule for all nodes."""

    def __init__(
        self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **options: Any
    ) -> None:
        super().__init__(**options)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        """Add the remapping rule."""
        pair = perform_substitutions(context, self.src), perform_substitutions(context, self.dst)
        add(context, "ros_remaps", [pair])


class SetROSLogDir(Action):
    """Sets the folder for the logs of nodes."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **options: Any) -> None:
        super().__init__(**options)
        self.log_dir = normalize_to_list_of_substitutions(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        """Apply the setting to nodes that start later."""
        context.environment["ROS_LOG_DIR"] = perform_substitutions(context, self.log_dir)


class ROSTimer(TimerAction):
    """Executes actions after a delay."""


RosTimer = ROSTimer
