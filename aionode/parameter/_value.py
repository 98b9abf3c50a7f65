"""Parameters: a name, a type and a value, and their conversion to and from messages."""

from __future__ import annotations

import array
from collections.abc import Sequence
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic

from aionode._process.bounded_yaml import loaded_yaml
from aionode.errors import ParameterFileError, brief
from aionode.interfaces.rcl_interfaces import msg as rcl_msg

__all__ = [
    "PARAMETER_SEPARATOR_STRING",
    "AllowableParameterValue",
    "Parameter",
    "ParameterType",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_value_to_python",
]

if TYPE_CHECKING:
    from typing_extensions import TypeVar  # type checkers have it; its TypeVar has defaults

    ValueT_co = TypeVar("ValueT_co", default=Any, covariant=True)
else:
    from typing import TypeVar

    ValueT_co = TypeVar("ValueT_co", covariant=True)

PARAMETER_SEPARATOR_STRING = "."

AllowableParameterValue = (
    None
    | bool
    | int
    | float
    | str
    | bytes
    | Sequence[bytes]
    | Sequence[bool]
    | Sequence[int]
    | Sequence[float]
    | Sequence[str]
)
"""The values that a parameter may have."""

LISTS = (list, tuple, array.array)


class ParameterType(IntEnum):
    """The types of parameters; also available as `Parameter.Type`."""

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
    def from_parameter_value(cls, parameter_value: object) -> ParameterType:
        """Return the type of a value. An empty list counts as BYTE_ARRAY, as in rclpy.

        Raises:
            TypeError: There is no parameter type for it.
        """
        if parameter_value is None:
            return cls.NOT_SET
        if isinstance(parameter_value, bytes | bytearray):
            return cls.BYTE_ARRAY
        for kind, type_ in ELEMENTS:
            if fits_element(parameter_value, kind):
                return type_
        if not isinstance(parameter_value, LISTS):
            message = f"The given value is not one of the allowed types '{parameter_value}'."
            raise TypeError(message)
        for kind, type_ in (((bytes,), cls.BYTE_ARRAY), *ARRAYS):
            if all(fits_element(value, kind) for value in parameter_value):
                return type_
        message = (
            f"The given value is not a list of one of the allowed types '{parameter_value}'; "
            "all its elements must be bool, int, float, str, or bytes of length 1."
        )
        raise TypeError(message)

    def check(self, parameter_value: object) -> bool:
        """Return whether a parameter of this type may have the value."""
        if self is ParameterType.NOT_SET:
            return parameter_value is None
        if self is ParameterType.BYTE_ARRAY:
            return isinstance(parameter_value, bytes | bytearray) or (
                isinstance(parameter_value, list | tuple)
                and all(isinstance(value, bytes) and len(value) == 1 for value in parameter_value)
            )
        for kind, type_ in ELEMENTS:
            if self is type_:
                return fits_element(parameter_value, kind) and in_range(parameter_value)
        for kind, type_ in ARRAYS:
            if self is type_:
                return isinstance(parameter_value, LISTS) and all(
                    fits_element(value, kind) and in_range(value) for value in parameter_value
                )
        return False


# bool before int: True is an int to Python, but not to ROS.
ELEMENTS: tuple[tuple[tuple[type, ...], ParameterType], ...] = (
    ((bool,), ParameterType.BOOL),
    ((int,), ParameterType.INTEGER),
    ((float,), ParameterType.DOUBLE),
    ((str,), ParameterType.STRING),
)
ARRAYS = (
    ((bool,), ParameterType.BOOL_ARRAY),
    ((int,), ParameterType.INTEGER_ARRAY),
    ((float,), ParameterType.DOUBLE_ARRAY),
    ((str,), ParameterType.STRING_ARRAY),
)


def fits_element(value: object, kind: tuple[type, ...]) -> bool:
    """Return whether a value has this type; a bool does not count as an int."""
    return isinstance(value, kind) and not (isinstance(value, bool) and kind == (int,))


def in_range(value: object) -> bool:
    """Return whether an int fits into 64 bits."""
    return not isinstance(value, int) or -(2**63) <= value < 2**63


def expect(value: object, kind: type | tuple[type, ...], what: str) -> None:
    """Raise a TypeError that names `what` unless `value` is of this kind."""
    if not isinstance(value, kind):
        message = f"{what} must be instance of type '{brief(kind)}', not {brief(value)}"
        raise TypeError(message)


class Parameter(Generic[ValueT_co]):
    """A parameter: its name, its type and its value.

    Args:
        name: The name; dots make groups.
        type_: The type; by default that of the value.
        value: The value. Numpy arrays and numbers are converted to lists and numbers.

    Raises:
        TypeError: There is no parameter type for the value.
        ValueError: The value is not of the given type.
    """

    Type = ParameterType

    __slots__ = ("_name", "_type", "_value")

    def __init__(self, name: str, type_: ParameterType | None = None, value: Any = None) -> None:
        if type(value).__module__ == "numpy":
            value = value.tolist()
        if type_ is None:
            type_ = self.Type.from_parameter_value(value)
        expect(type_, self.Type, "type")
        if not type_.check(value):
            message = f"Type '{type_.name}' and value '{value}' do not agree"
            raise ValueError(message)
        self._name = name
        self._type = type_
        self._value: ValueT_co = value

    @property
    def name(self) -> str:
        """The name."""
        return self._name

    @property
    def type_(self) -> ParameterType:
        """The type."""
        return self._type

    @property
    def value(self) -> ValueT_co:
        """The value; None if not set."""
        return self._value

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Parameter):
            return NotImplemented
        mine = (self._name, self._type, self._value)
        return mine == (other._name, other._type, other._value)

    def __hash__(self) -> int:
        return hash((self._name, self._type))

    def __repr__(self) -> str:
        return f"Parameter({self._name!r}, Parameter.Type.{self._type.name}, {self._value!r})"

    @classmethod
    def from_parameter_msg(cls, param_msg: rcl_msg.Parameter) -> Parameter:
        """Create a parameter from a message.

        Raises:
            ValueError: The type in the message is unknown.
        """
        type_ = ParameterType(param_msg.value.type)
        return cls(param_msg.name, type_, parameter_value_to_python(param_msg.value))

    def get_parameter_value(self) -> rcl_msg.ParameterValue:
        """Return the type and value as a message."""
        value: Any = self._value
        # Empty tuples in place of the default arrays, which need numpy: importing that takes longer
        # than starting a node, and most parameters hold no array.
        message = rcl_msg.ParameterValue(
            type=int(self._type),
            bool_array_value=(),
            integer_array_value=(),
            double_array_value=(),
        )
        if self._type is ParameterType.BYTE_ARRAY:
            message.byte_array_value = b"".join(
                bytes([item]) if isinstance(item, int) else item for item in value
            )
        elif self._type is not ParameterType.NOT_SET:
            is_list = isinstance(value, LISTS)
            setattr(message, FIELDS[self._type], list(value) if is_list else value)
        return message

    def to_parameter_msg(self) -> rcl_msg.Parameter:
        """Return the parameter as a message."""
        return rcl_msg.Parameter(name=self._name, value=self.get_parameter_value())


FIELDS = {type_: f"{type_.name.lower()}_value" for type_ in ParameterType}


def parameter_value_to_python(parameter_value: rcl_msg.ParameterValue) -> Any:
    """Convert the value in a message to a built-in Python type; None if it is not set.

    Raises:
        RuntimeError: The type in the message is unknown.
    """
    try:
        type_ = ParameterType(parameter_value.type)
    except ValueError:
        message = f"unexpected parameter type {parameter_value.type}"
        raise RuntimeError(message) from None
    if type_ is ParameterType.NOT_SET:
        return None
    value = getattr(parameter_value, FIELDS[type_])
    if type_ is ParameterType.BYTE_ARRAY:
        # rosidl's classes have a list of bytes here, aionode's have bytes.
        return [item if isinstance(item, bytes) else bytes([item]) for item in value]
    if hasattr(value, "tolist"):
        return value.tolist()  # numpy's numbers are not int and float
    return list(value) if type_ >= ParameterType.BYTE_ARRAY else value


# Text


def get_parameter_value(string_value: str) -> rcl_msg.ParameterValue:
    """Convert a text to a value like ``ros2 param set``, with PyYAML.

    Text that PyYAML rejects is a string, and so is a value that no parameter can hold, such as a
    list of mixed types. Parameter files and ``-p`` follow other rules, those of rcl.
    """
    value = value_in_yaml(string_value)
    if isinstance(value, list):
        for (kind,), type_ in ARRAYS:  # an empty list is one of bools, as in rclpy
            items = list(map(kind, value)) if all(isinstance(it, kind) for it in value) else None
            if items is not None and type_.check(items):
                return Parameter("", type_, items).get_parameter_value()
    elif any(type_.check(value) for _, type_ in ELEMENTS):
        return Parameter("", value=value).get_parameter_value()
    return Parameter("", value=string_value).get_parameter_value()


def value_in_yaml(text: str) -> Any:
    """Return the value that PyYAML reads, or the text itself if it is not YAML."""
    import yaml  # imported only when a text is read

    try:
        return loaded_yaml(text)
    except yaml.YAMLError:
        return text


def parameter_dict_from_yaml_file(
    parameter_file: str | Path,
    use_wildcard: bool = False,
    target_nodes: list[str] | None = None,
    namespace: str = "",
) -> dict[str, rcl_msg.Parameter]:
    """Read the parameters of a file, by name.

    Args:
        parameter_file: Path of the file.
        use_wildcard: Whether to include the section ``/**``.
        target_nodes: The nodes whose sections to include; by default all.
        namespace: Prepended to all names.

    Raises:
        ParameterFileError: The file cannot be read, or has no parameters for one of the nodes (a
            RuntimeError, as in rclpy, and a ValueError).
    """
    from aionode.arguments import read_parameter_file  # as above

    rules = read_parameter_file(parameter_file)
    given = {rule.node for rule in rules}
    wanted = given - {"/**"}
    if target_nodes:
        wanted = {name if name.startswith("/") else f"/{name}" for name in target_nodes}
        if missing := wanted - given:
            problem = f"nothing for {sorted(missing)}, only for {sorted(given)}"
            raise ParameterFileError(str(parameter_file), 0, problem)
    ordered = [rule for rule in rules if rule.node == "/**"] if use_wildcard else []
    ordered += [rule for rule in rules if rule.node in wanted]
    if not ordered:
        raise ParameterFileError(str(parameter_file), 0, "holds none of the wanted parameters")
    return {
        namespace + rule.name: Parameter(namespace + rule.name, value=rule.value).to_parameter_msg()
        for rule in ordered
    }
