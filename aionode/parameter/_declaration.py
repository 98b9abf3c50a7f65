"""Reading the declaration of a parameter: its name, first value, and descriptor."""

from __future__ import annotations

from typing import Any

from aionode.errors import InvalidParameterException
from aionode.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor, ParameterValue
from aionode.parameter._value import Parameter, ParameterType, expect

__all__ = ["adapted", "first_value", "split_entry", "validate_parameter_name"]


def validate_parameter_name(name: str) -> bool:
    """Return True if `name` is a valid parameter name, that is not empty.

    Raises:
        InvalidParameterException: The name is empty.
    """
    if not name:
        raise InvalidParameterException(name)
    return True


def split_entry(entry: tuple[Any, ...], index: int) -> tuple[str, Any, ParameterDescriptor]:
    """Return the name, value and descriptor of one entry of `declare_parameters`."""
    if not 1 <= len(entry) <= 3:
        message = (
            f"Invalid parameter tuple length at index {index} in parameters list: {entry}; "
            "expecting length between 1 and 3"
        )
        raise TypeError(message)
    name, value, descriptor = (*entry, *(None, None))[:3]
    if descriptor is None:
        descriptor = ParameterDescriptor()
    expect(name, str, f"First element at index {index} in parameters list")
    expect(descriptor, ParameterDescriptor, f"Third element at index {index} in parameters list")
    for ranges in (descriptor.integer_range, descriptor.floating_point_range):
        if len(ranges) > 1:
            message = f"{name}: the descriptor has {len(ranges)} ranges; at most one is allowed"
            raise ValueError(message)
    return name, value, descriptor


def first_value(name: str, value: Any, descriptor: ParameterDescriptor) -> Parameter:
    """Return the parameter as declared, and set the type in its descriptor.

    Raises:
        ValueError: The type cannot be determined.
    """
    if isinstance(value, ParameterType):
        if value is ParameterType.NOT_SET:
            message = f"Cannot declare parameter '{name}' as statically typed of type NOT_SET"
            raise ValueError(message)
        if descriptor.dynamic_typing:
            message = (
                f"When declaring parameter '{name}' passing a descriptor with "
                "`dynamic_typing=True` is not allowed when the parameter type is provided"
            )
            raise ValueError(message)
        descriptor.type = int(value)
        return Parameter(name)
    if isinstance(value, ParameterValue):
        parameter = Parameter.from_parameter_msg(ParameterMsg(name=name, value=value))
    else:
        parameter = Parameter(name, value=value)
    if not descriptor.dynamic_typing and parameter.type_ is ParameterType.NOT_SET:
        message = (
            f"Cannot declare the statically typed parameter '{name}' with a default value of type "
            "PARAMETER_NOT_SET: give a value, a Parameter.Type, or dynamic_typing=True"
        )
        raise ValueError(message)
    descriptor.type = int(parameter.type_)
    return parameter


def adapted(parameter: Parameter, descriptor: ParameterDescriptor | None) -> Parameter:
    """Return `parameter`; an empty list, whose type is ambiguous, gets the declared type."""
    if descriptor is None or descriptor.dynamic_typing:
        return parameter
    wanted = ParameterType(descriptor.type)
    is_empty = parameter.type_ is ParameterType.BYTE_ARRAY and not parameter.value
    if is_empty and wanted > ParameterType.BYTE_ARRAY:
        return Parameter(parameter.name, wanted, [])
    return parameter
