"""Parameters and remapping rules of nodes, as arguments or as values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import yaml

from aionode._packages import package_of_stand_in
from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.errors import PackageNotFoundError
from aionode.launch.plan import Log, ParameterValues
from launch.launch_context import LaunchContext
from launch.substitution import (
    text_of,
)
from launch_ros.parameter_descriptions import (
    Parameter,
    ParameterFile,
    evaluate_values,
)

__all__ = ["parameter_arguments", "remap_pairs", "values_for_node"]


def remap_pairs(context: LaunchContext, remappings: Iterable[Any]) -> list[tuple[str, str]]:
    """Return remapping rules: those of the group, then those of the node."""
    pairs = list(context.launch_configurations.get("ros_remaps", ()))
    for rule in remappings:
        if isinstance(rule, str):
            raise TypeError(f"remapping {rule!r}: use a pair such as ('from', 'to')")
        source, target = (text_of(context, side) for side in rule)
        pairs.append((source, target))
    return pairs


def parameter_arguments(
    context: LaunchContext, parameters: Iterable[Any], node_name: str | None
) -> list[str | ParameterValues]:
    """Return the arguments for a node's parameters, in order: the last one applies."""
    arguments: list[str | ParameterValues] = []
    for known in context.launch_configurations.get("global_params", ()):
        if isinstance(known, tuple):
            arguments += ["-p", f"{known[0]}:={known[1]}"]
        else:
            arguments += ["--params-file", str(Path(known).absolute())]
    for given in parameters:
        if isinstance(given, Parameter):
            name, value = given.evaluate(context)
            arguments += ["-p", f"{name}:={yaml.dump(value)}"]
            continue
        file = file_of(context, given)
        if file is None:
            values = evaluate_values(context, given)
            content = {node_name or "/**": {"ros__parameters": values}}
            arguments += ["--params-file", ParameterValues(content)]
        elif isinstance(file, ParameterValues) or Path(file).is_file():
            arguments += ["--params-file", file]
        elif (package := package_of_stand_in(str(file))) is not None:
            raise PackageNotFoundError(package, (), ())
        else:
            # ROS's launch continues, too: files that only some robots have are common.
            context.steps.append(
                Log(f"there is no parameter file {file}: the node starts without it", "WARN")
            )
    return arguments


def file_of(context: LaunchContext, given: Any) -> str | ParameterValues | None:
    """Return the path of a parameter file, or its content; None if it is a dictionary."""
    if isinstance(given, Mapping):
        return None
    file = given if isinstance(given, ParameterFile) else ParameterFile(given)
    return file.evaluate(context)


def values_for_node(
    context: LaunchContext, parameters: Iterable[Any], name: str, namespace: str
) -> dict[str, Any]:
    """Return the parameters of a node by name, including those of its files."""
    values: dict[str, Any] = {}
    for given in parameters:
        if isinstance(given, Parameter):
            key, value = given.evaluate(context)
            values[key] = value
            continue
        file = file_of(context, given)
        if file is None:
            values.update(evaluate_values(context, given))
            continue
        content = (
            file.content if isinstance(file, ParameterValues) else loaded_yaml(read_file(file))
        )
        values.update(values_in_file(content or {}, name, namespace))
    return values


def values_in_file(content: Mapping[str, Any], name: str, namespace: str) -> dict[str, Any]:
    """Return a parameter file's values for a node: those for all nodes, then its own."""
    by_node = dict(sections(content))
    own = f"{namespace.strip('/')}/{name}".strip("/")
    parameters: dict[str, Any] = {}
    for key in ("**", f"**/{name}", own):
        parameters.update(flat(by_node.get(key, {})))
    return parameters


def sections(content: Mapping[str, Any], path: str = "") -> Iterable[tuple[str, Any]]:
    """Yield the node names in a parameter file, with their parameters."""
    for key, value in content.items():
        if key == "ros__parameters":
            yield path.strip("/"), value or {}
        elif isinstance(value, Mapping):
            yield from sections(value, f"{path}/{str(key).strip('/')}")


def flat(values: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return nested parameters by their full names."""
    flattened: dict[str, Any] = {}
    for key, value in values.items():
        if isinstance(value, Mapping):
            flattened.update(flat(value, f"{prefix}{key}."))
        else:
            flattened[f"{prefix}{key}"] = value
    return flattened
