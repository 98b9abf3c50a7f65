"""The action that starts a node."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from aionode.launch.plan import ParameterValues
from aionode.names import validate_node_name
from launch.actions import ExecuteProcess
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from launch_ros.namespaces import joined, namespace_in, text_or_none
from launch_ros.node_arguments import parameter_arguments, remap_pairs

__all__ = ["Node"]


class Node(ExecuteProcess):
    """Starts a node: an executable of a package, a program, or a class as ``module:Class``."""

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[Any] | None = None,
        ros_arguments: Iterable[Any] | None = None,
        arguments: Iterable[Any] | None = None,
        **options: Any,
    ) -> None:
        words = [executable, *as_words(arguments)]
        if ros_arguments is not None:
            words += ["--ros-args", *as_words(ros_arguments)]
        super().__init__(cmd=words, name=exec_name, **options)
        if parameters is not None and not isinstance(parameters, list | tuple):
            raise TypeError(f"Node: parameters= is {parameters!r}; use a list")
        self.node_executable = executable
        self.node_package = package
        self._Node__given_name = name
        self._Node__given_namespace = namespace
        self._Node__parameters = list(parameters or ())
        self._Node__remappings = list(remappings or ())
        self._Node__full_name: str | None = None
        self._Node__program_name = ""

    @property
    def node_name(self) -> str:
        """The full name of the node, once the action has been evaluated."""
        if self._Node__full_name is None:
            raise RuntimeError("cannot access 'node_name' before executing action")
        return self._Node__full_name

    def is_node_name_fully_specified(self) -> bool:
        """Return whether the description specifies both the node's name and its namespace."""
        return "<" not in self.node_name

    def _ExecuteLocal__program_words(self, context: LaunchContext, program: list[Any]) -> list[str]:
        """Return the command that starts the executable."""
        executable = perform_substitutions(context, program)
        self._Node__program_name = Path(executable).name.rpartition(":")[2]
        if self.node_package is None:
            return command_of(executable)
        package = text_or_none(context, self.node_package) or ""
        return context.packages.command(package, executable)

    def _ExecuteLocal__program_name(self, context: LaunchContext, words: list[str]) -> str:
        """Return the name of the executable, or of the class."""
        return self._Node__program_name

    def _ExecuteLocal__node_name_in(self, context: LaunchContext) -> str | None:
        """Return the full name of the node, if name and namespace are known."""
        return self.node_name if self.is_node_name_fully_specified() else None

    def _ExecuteLocal__arguments_of_ros(
        self, context: LaunchContext
    ) -> list[str | ParameterValues]:
        """Return the words after ``--ros-args``: name, namespace, parameters, remapping rules."""
        name = text_or_none(context, self._Node__given_name)
        if name is not None:
            validate_node_name(name)
        namespace = namespace_in(context, text_or_none(context, self._Node__given_namespace))
        self._Node__full_name = joined(
            namespace or self.UNSPECIFIED_NODE_NAMESPACE, name or self.UNSPECIFIED_NODE_NAME
        )
        arguments: list[str | ParameterValues] = ["--ros-args"]
        if name is not None:
            arguments += ["-r", f"__node:={name}"]
        if namespace is not None:
            arguments += ["-r", f"__ns:={namespace}"]
        arguments += parameter_arguments(
            context, self._Node__parameters, self._ExecuteLocal__node_name_in(context)
        )
        for source, target in remap_pairs(context, self._Node__remappings):
            arguments += ["-r", f"{source}:={target}"]
        return arguments

    def describe(self) -> str:
        """Return a description of the node, by its name if known."""
        named = self._Node__given_name if isinstance(self._Node__given_name, str) else None
        executable = normalize_to_list_of_substitutions(self.node_executable)
        return named or "".join(getattr(sub, "text", sub.describe()) for sub in executable)


def as_words(arguments: Iterable[Any] | None) -> list[Any]:
    """Return arguments as separate words; a single text is one argument."""
    if arguments is None:
        return []
    return [arguments] if isinstance(arguments, str) else list(arguments)


def command_of(executable: str) -> list[str]:
    """Return the command of an executable without a package.

    It may be a program; a Python file, such as a program of rclpy; or a node class, as
    ``module:Class`` or ``file.py:Class``.
    """
    if ":" in executable and not Path(executable).exists():
        return [sys.executable, "-m", "aionode", "run", executable]
    if executable.endswith(".py"):
        return [sys.executable, "-m", "aionode.rclpy", executable]
    return [executable]
