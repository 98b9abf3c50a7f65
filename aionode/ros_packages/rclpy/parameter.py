"""Parameters."""

from __future__ import annotations

import array
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rcl_interfaces.msg import Parameter as ParameterMsg
from rcl_interfaces.msg import ParameterType, ParameterValue

from aionode import parameter as core
from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.parameter import PARAMETER_SEPARATOR_STRING, parameter_value_to_python
from rclpy._impl import messages as msg
from rosidl_generator_py import from_aionode

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = [
    "PARAMETER_SEPARATOR_STRING",
    "AllowableParameterValue",
    "Parameter",
    "ParameterMsg",
    "ParameterType",
    "ParameterValue",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_value_to_python",
]

WILDCARD = "/**"  # the section for every node

AllowableParameterValue = Any
AllowableParameterValueT = TypeVar("AllowableParameterValueT")


class Type(IntEnum):
    """The type of a parameter."""

    NOT_SET = 0
    BOOL = 1
    INTEGER = 2
    DOUBLE = 3
    STRING = 4
    BYTE_ARRAY = 5
    BOOL_ARRAY = 6
    INTEGER_ARRAY = 7
    DOUBLE_ARRAY = 8
    STRING_ARRAY = 9

    @classmethod
    def from_parameter_value(cls, parameter_value: Any) -> Type:
        """Return the type of a value. An empty list counts as BYTE_ARRAY.

        Raises:
            TypeError: no type matches it.
        """
        if parameter_value is None:
            return cls.NOT_SET
        for kind, type_ in SINGLE:
            if isinstance(parameter_value, kind):
                return type_
        if not isinstance(parameter_value, list | tuple | array.array):
            raise TypeError(f"The given value is not one of the allowed types '{parameter_value}'.")
        for kind, type_ in ELEMENTS:
            if all(isinstance(element, kind) for element in parameter_value):
                return type_
        raise TypeError(
            f"The given value is not a list of one of the allowed types '{parameter_value}'."
        )

    def check(self, parameter_value: Any) -> bool:
        """Return whether a parameter of this type may have the value."""
        if self is Type.NOT_SET:
            return parameter_value is None
        for kind, type_ in SINGLE:
            if self is type_:
                return isinstance(parameter_value, kind)
        if not isinstance(parameter_value, list | tuple):
            numbers = self in (Type.INTEGER_ARRAY, Type.DOUBLE_ARRAY)
            if not (numbers and isinstance(parameter_value, array.array)):
                return False
        kind = next(kind for kind, type_ in ELEMENTS if self is type_)
        return all(
            isinstance(element, kind) and (not isinstance(element, bytes) or len(element) == 1)
            for element in parameter_value
        )


# bool before int, because True is an int in Python
SINGLE: tuple[tuple[type, Type], ...] = (
    (bool, Type.BOOL),
    (int, Type.INTEGER),
    (float, Type.DOUBLE),
    (str, Type.STRING),
)
ELEMENTS: tuple[tuple[type, Type], ...] = (
    (bytes, Type.BYTE_ARRAY),
    (bool, Type.BOOL_ARRAY),
    (int, Type.INTEGER_ARRAY),
    (float, Type.DOUBLE_ARRAY),
    (str, Type.STRING_ARRAY),
)


def field_of(type_: IntEnum) -> str:
    """Return the field of a ParameterValue for values of a type."""
    return f"{type_.name.lower()}_value"


class Parameter(core.Parameter, Generic[AllowableParameterValueT]):
    """A parameter: its name, its type and its value.

    Args:
        name: The name; dots make groups.
        type_: The type; by default that of the value.
        value: The value.

    Raises:
        TypeError: no type matches the value.
        ValueError: the value is not of the given type.
    """

    Type = Type  # type: ignore[assignment] # another enumeration of the same numbers

    @classmethod
    def from_parameter_msg(cls, param_msg: Any) -> Parameter[Any]:
        """Return the parameter in a message.

        Raises:
            ValueError: its type is unknown.
        """
        type_ = Type(param_msg.value.type)
        value = None if type_ is Type.NOT_SET else getattr(param_msg.value, field_of(type_))
        return cls(param_msg.name, type_, value)  # type: ignore[arg-type] # as above

    @property
    def type_(self) -> Any:
        """The type."""
        return super().type_

    def get_parameter_value(self) -> Any:
        """Return type and value as a message."""
        message = msg.ParameterValue(type=int(self.type_))
        if self.type_ != Type.NOT_SET:
            setattr(message, field_of(self.type_), self.value)
        return message

    def to_parameter_msg(self) -> Any:
        """Return the parameter as a message."""
        return msg.Parameter(name=self.name, value=self.get_parameter_value())


def get_parameter_value(string_value: str) -> Any:
    """Parse a value in YAML syntax into a message; other texts are strings."""
    return from_aionode(core.get_parameter_value(string_value))


def parameter_dict_from_yaml_file(
    parameter_file: str,
    use_wildcard: bool = False,
    target_nodes: list[str] | None = None,
    namespace: str = "",
) -> dict[str, Any]:
    """Return the parameters in a file as messages, by name.

    Args:
        parameter_file: Path of the file.
        use_wildcard: Whether to include those of ``/**``.
        target_nodes: The nodes whose parameters to return; all by default.
        namespace: Prepended to the names as it is, so usually with a dot at its end.

    Raises:
        RuntimeError: the file is malformed, or has no parameters of these nodes.
    """
    sections = list(node_sections(loaded_yaml(read_file(parameter_file))))
    wanted = {f"/{name.removeprefix('/')}" for name in target_nodes or ()}
    chosen = [values for name, values in sections if use_wildcard and name == WILDCARD]
    chosen += [
        values for name, values in sections if (name in wanted if wanted else name != WILDCARD)
    ]
    parameters: dict[str, Any] = {}
    for values in chosen:
        parameters.update(messages_of(values, namespace))
    if not parameters:
        raise RuntimeError("Param file does not contain any valid parameters")
    return parameters


def node_sections(content: Any, above: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the full name of each node in a parameter file, with its parameters.

    Names may be without a leading slash, and sections of namespaces hold those of their nodes.
    """
    if not isinstance(content, dict):
        return
    for key, section in content.items():
        name = f"{above}/{str(key).removeprefix('/')}"
        if isinstance(section, dict) and isinstance(section.get("ros__parameters"), dict):
            yield name, section["ros__parameters"]
        else:
            yield from node_sections(section, name)


def messages_of(values: dict[str, Any], namespace: str = "") -> dict[str, Any]:
    """Return the parameters in nested dicts as messages, by their full names."""
    parameters: dict[str, Any] = {}
    for name, value in values.items():
        full_name = f"{namespace}{name}"
        if isinstance(value, dict):
            parameters.update(messages_of(value, full_name + PARAMETER_SEPARATOR_STRING))
        else:
            message = msg.Parameter(name=full_name)
            message.value = get_parameter_value(str(value))
            parameters[full_name] = message
    return parameters
