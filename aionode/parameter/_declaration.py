"""Parse the declaration of a parameter: its name, initial value and descriptor."""

from __future__ import annotations

from typing import Any

from aionode.errors import InvalidParameterException
from aionode.interfaces.rcl_interfaces import msg as rcl_msg
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.parameter._value import Parameter, ParameterType, expect

__all__ = [
    "first_value",
    "refuse_many_ranges",
    "split_entry",
    "validate_parameter_name",
]


def validate_parameter_name(name: str) -> bool:
    """Return True if `name` is a valid parameter name, which means not empty.

    Raises:
        InvalidParameterException: The name is empty.
    """
    if not name:
        raise InvalidParameterException(name)
    return True


def split_entry(entry: tuple[Any, ...], index: int) -> tuple[str, Any, Any]:
    """Split an entry of `declare_parameters` into name, value and descriptor (or None).

    Raises:
        TypeError: it has another form, or its name is not a string.
    """
    if not 1 <= len(entry) <= 3:
        message = (
            f"Invalid parameter tuple length at index {index} in parameters list: {entry}; "
            "expecting length between 1 and 3"
        )
        raise TypeError(message)
    name, value, descriptor = (*entry, *(None, None))[:3]
    expect(name, str, f"First element at index {index} in parameters list")
    return name, value, descriptor


def refuse_many_ranges(name: str, descriptor: ParameterDescriptor) -> None:
    """Raise ValueError if a descriptor has more than one range."""
    for ranges in (descriptor.integer_range, descriptor.floating_point_range):
        if len(ranges) > 1:
            message = f"{name}: the descriptor has {len(ranges)} ranges; at most one is allowed"
            raise ValueError(message)


def first_value(
    name: str,
    value: Any,
    descriptor: ParameterDescriptor,
    parameter_class: type[Parameter] = Parameter,
    messages: Any = rcl_msg,
) -> Parameter:
    """Return the initial parameter, and set the type in its descriptor.

    Args:
        name: Its name.
        value: Its value, plain or as a message, or its type.
        descriptor: Its descriptor.
        parameter_class: The class of the result.
        messages: The classes of messages with a value, by name.

    Raises:
        ValueError: The type cannot be determined.
    """
    if isinstance(value, parameter_class.Type):
        if value == ParameterType.NOT_SET:
            message = f"Cannot declare parameter '{name}' as statically typed of type NOT_SET"
            raise ValueError(message)
        if descriptor.dynamic_typing:
            message = (
                f"When declaring parameter '{name}' passing a descriptor with "
                "`dynamic_typing=True` is not allowed when the parameter type is provided"
            )
            raise ValueError(message)
        descriptor.type = int(value)
        return parameter_class(name)
    if isinstance(value, messages.ParameterValue):
        parameter = parameter_class.from_parameter_msg(messages.Parameter(name=name, value=value))
    else:
        parameter = parameter_class(name, value=value)
    if not descriptor.dynamic_typing and parameter.type_ == ParameterType.NOT_SET:
        message = (
            f"Cannot declare the statically typed parameter '{name}' with a default value of type "
            "PARAMETER_NOT_SET: give a value, a Parameter.Type, or dynamic_typing=True"
        )
        raise ValueError(message)
    descriptor.type = int(parameter.type_)
    return parameter
