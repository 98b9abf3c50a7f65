"""`launch_ros.parameter_descriptions`: the parameters of nodes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import yaml

from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.launch.plan import ParameterValues
from launch.frontend.parse_substitution import parse_words
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)
from launch.utilities.type_utils import (
    coerce_to_type,
    is_substitution,
    is_uniform,
    perform_typed_substitution,
)

__all__ = [
    "Parameter",
    "ParameterFile",
    "ParameterValue",
    "evaluate_value",
    "evaluate_values",
]


class ParameterValue:
    """A value of a given type."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value = value
        self.value_type = value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value."""
        if isinstance(self.value, list | tuple) and not is_substitution(self.value):
            return [evaluate_value(context, item) for item in self.value]
        if is_substitution(self.value) and self.value_type is None:
            return evaluate_value(context, self.value)
        return perform_typed_substitution(context, self.value, self.value_type)


class Parameter:
    """A parameter: its name and its value."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self._Parameter__parameter_value = ParameterValue(value, value_type=value_type)

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return the name and the value."""
        return perform_substitutions(context, self.name), self._Parameter__parameter_value.evaluate(
            context
        )


class ParameterFile:
    """A parameter file whose texts may contain substitutions."""

    def __init__(self, param_file: Any, *, allow_substs: Any = False) -> None:
        self.param_file = normalize_to_list_of_substitutions(param_file)
        self.allow_substs = allow_substs

    def evaluate(self, context: LaunchContext) -> str | ParameterValues:
        """Return the path of the file, or its content after substitution."""
        path = perform_substitutions(context, self.param_file)
        if not perform_typed_substitution(context, self.allow_substs, bool):
            return path
        text = perform_substitutions(context, parse_words(read_file(path).decode()))
        return ParameterValues(loaded_yaml(text))


def evaluate_value(context: LaunchContext, value: Any) -> Any:
    """Return the value of a part of a description; texts follow the rules of YAML.

    Raises:
        TypeError: A parameter cannot have this value.
    """
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if is_substitution(value):
        return value_of_text(text_of(context, value))
    if isinstance(value, str | bool | int | float | bytes):
        return value
    if isinstance(value, Sequence) and value:
        items = [item_of(context, item) for item in value]
        if all(type(item) in (int, float) for item in items) and not is_uniform(items):
            items = [float(item) for item in items]
        return items
    raise TypeError(
        f"a parameter cannot be {value!r}; use bool, int, float, str or a list of one of them"
    )


def item_of(context: LaunchContext, item: Any) -> Any:
    """Return an item of a list."""
    if isinstance(item, list | tuple):
        text = text_of(context, item)
        return coerce_to_type(text)
    return evaluate_value(context, item)


def value_of_text(text: str) -> Any:
    """Return the YAML value of a text, if a parameter can have that value."""
    hint = (
        "for a text use ParameterValue(value, value_type=str) of launch_ros.parameter_descriptions"
    )
    if not text:
        return ""
    try:
        value = loaded_yaml(text)
    except yaml.YAMLError as error:
        raise TypeError(
            f"a parameter cannot be {text[:80]!r}, which is not YAML; {hint}"
        ) from error
    if isinstance(value, bool | int | float | str | bytes) or is_uniform(value):
        return value
    raise TypeError(f"a parameter cannot be {text[:80]!r}; {hint}")


def evaluate_values(
    context: LaunchContext, given: Mapping[Any, Any], prefix: str = ""
) -> dict[str, Any]:
    """Return parameters by their full names; keys of nested dictionaries are joined by dots."""
    values: dict[str, Any] = {}
    for name, value in given.items():
        full = prefix + text_of(context, name)
        if isinstance(value, Mapping):
            values.update(evaluate_values(context, value, f"{full}."))
        else:
            try:
                values[full] = evaluate_value(context, value)
            except (TypeError, ValueError) as error:
                raise TypeError(f"parameter '{full}': {error}") from error
    return values
