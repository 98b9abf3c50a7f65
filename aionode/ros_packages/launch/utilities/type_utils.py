"""`launch.utilities.type_utils`: texts that stand for values of other types."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args, get_origin

import yaml

from aionode._process.bounded_yaml import loaded_yaml
from launch.substitution import (
    Substitution,
    normalize_to_list_of_substitutions,
    text_of,
)

if TYPE_CHECKING:
    from launch.launch_context import LaunchContext

__all__ = [
    "coerce_to_type",
    "is_substitution",
    "normalize_typed_substitution",
    "perform_typed_substitution",
]

SCALARS = (bool, int, float, str)


def is_substitution(value: Any) -> bool:
    """Return whether a value is a substitution, or a list that contains one."""
    if isinstance(value, Substitution):
        return True
    return isinstance(value, list | tuple) and any(isinstance(item, Substitution) for item in value)


def coerce_to_type(text: str, data_type: Any = None) -> Any:
    """Return the value that a text stands for, by YAML's rules.

    Raises:
        ValueError: It is of another type.
    """
    if data_type is str:
        return text
    try:
        value = loaded_yaml(text)
    except yaml.YAMLError as error:
        if data_type is None:
            return text
        raise ValueError(f"{text!r} is not a {type_name(data_type)}") from error
    if data_type is None:
        return value if isinstance(value, SCALARS) or is_uniform(value) else text
    if data_type is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if data_type is bool and text.strip().lower() in ("0", "1"):
        return text.strip() == "1"
    if fits(value, data_type):
        return value
    raise ValueError(f"{text!r} is not a {type_name(data_type)}")


def fits(value: Any, data_type: Any) -> bool:
    """Return whether a value has a type, which may be a list of a type."""
    if get_origin(data_type) is list:
        (item_type,) = get_args(data_type)
        return isinstance(value, list) and all(fits(item, item_type) for item in value)
    return type(value) is data_type


def is_uniform(value: Any) -> bool:
    """Return whether a value is a list whose items all have one scalar type."""
    return (
        isinstance(value, list)
        and bool(value)
        and type(value[0]) in SCALARS
        and all(type(item) is type(value[0]) for item in value)
    )


def type_name(data_type: Any) -> str:
    """Return the name of a type for an error."""
    return getattr(data_type, "__name__", str(data_type))


def normalize_typed_substitution(value: Any, data_type: Any = None) -> Any:
    """Return a value unchanged, or as a list of the substitutions that make it up."""
    return normalize_to_list_of_substitutions(value) if is_substitution(value) else value


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any = None) -> Any:
    """Return a value, converted to this type if it was a text or substitutions.

    Raises:
        ValueError: It is of another type.
    """
    if is_substitution(value):
        text = text_of(context, value)
        return coerce_to_type(text, data_type)
    if isinstance(value, str) and data_type not in (None, str):
        return coerce_to_type(value, data_type)
    if data_type is str and not isinstance(value, str):
        raise ValueError(f"{value!r} is not a str")
    return value
