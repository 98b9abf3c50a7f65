"""Messages of rcl_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import (
    DEFAULT,
    Bools,
    Bytes,
    Floats,
    Ints,
    Message,
    Sequence,
    byte,
    float64,
    int64,
    uint8,
    uint32,
    uint64,
)

__all__ = [
    "FloatingPointRange",
    "IntegerRange",
    "ListParametersResult",
    "Log",
    "LoggerLevel",
    "Parameter",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterEventDescriptors",
    "ParameterType",
    "ParameterValue",
    "SetLoggerLevelsResult",
    "SetParametersResult",
]


class ParameterValue(Message, typename="rcl_interfaces/msg/ParameterValue"):
    """The value of a parameter: `type`, a constant of ParameterType, says in which field."""

    type: uint8 = 0
    bool_value: bool = False
    integer_value: int64 = 0
    double_value: float64 = 0.0
    string_value: str = ""
    byte_array_value: Annotated[Bytes, Sequence[byte]] = DEFAULT
    bool_array_value: Annotated[Bools, Sequence[bool]] = DEFAULT
    integer_array_value: Annotated[Ints, Sequence[int64]] = DEFAULT
    double_array_value: Annotated[Floats, Sequence[float64]] = DEFAULT
    string_array_value: Annotated[list[str], Sequence[str]] = DEFAULT


class Parameter(Message, typename="rcl_interfaces/msg/Parameter"):
    """A parameter: its name and value."""

    name: str = ""
    value: ParameterValue = DEFAULT


class FloatingPointRange(Message, typename="rcl_interfaces/msg/FloatingPointRange"):
    """Which values a float parameter can have.

    Attributes:
        from_value: The smallest.
        to_value: The largest, which always fits.
        step: The distance between values, counted from the smallest; 0 means any value in between.
    """

    from_value: float64 = 0.0
    to_value: float64 = 0.0
    step: float64 = 0.0


class IntegerRange(Message, typename="rcl_interfaces/msg/IntegerRange"):
    """Which values an integer parameter can have.

    Attributes:
        from_value: The smallest.
        to_value: The largest, which always fits.
        step: The distance between values, counted from the smallest; 0 means any value in between.
    """

    from_value: int64 = 0
    to_value: int64 = 0
    step: uint64 = 0


class ListParametersResult(Message, typename="rcl_interfaces/msg/ListParametersResult"):
    """Names of parameters, and the prefixes they have."""

    names: Annotated[list[str], Sequence[str]] = DEFAULT
    prefixes: Annotated[list[str], Sequence[str]] = DEFAULT


class Log(Message, typename="rcl_interfaces/msg/Log"):
    """One line of a node's log, as ``/rosout`` carries it.

    Attributes:
        stamp: When it was written.
        level: Severity; the constants are the usual ones.
        name: The logger, usually that of the node.
        msg: The text.
        file: Source file of the call.
        function: Function of the call.
        line: Line of the call in that file.
    """

    DEBUG: ClassVar[uint8] = 10
    INFO: ClassVar[uint8] = 20
    WARN: ClassVar[uint8] = 30
    ERROR: ClassVar[uint8] = 40
    FATAL: ClassVar[uint8] = 50

    stamp: Time = DEFAULT
    level: uint8 = 0
    name: str = ""
    msg: str = ""
    file: str = ""
    function: str = ""
    line: uint32 = 0


class LoggerLevel(Message, typename="rcl_interfaces/msg/LoggerLevel"):
    """A logger and the severity from which it logs; levels as in Log."""

    LOG_LEVEL_UNKNOWN: ClassVar[uint8] = 0
    LOG_LEVEL_DEBUG: ClassVar[uint8] = 10
    LOG_LEVEL_INFO: ClassVar[uint8] = 20
    LOG_LEVEL_WARN: ClassVar[uint8] = 30
    LOG_LEVEL_ERROR: ClassVar[uint8] = 40
    LOG_LEVEL_FATAL: ClassVar[uint8] = 50

    name: str = ""
    level: uint32 = 0


class ParameterDescriptor(Message, typename="rcl_interfaces/msg/ParameterDescriptor"):
    """A node's description of one of its parameters.

    Attributes:
        name: Its name.
        type: Its type, a constant of ParameterType.
        description: What it is for, with the unit.
        additional_constraints: What else a value has to satisfy, in words.
        read_only: Whether it keeps its first value.
        dynamic_typing: Whether its type can change.
        floating_point_range: Its range, or nothing; for floats.
        integer_range: Its range, or nothing; for integers.
    """

    name: str = ""
    type: uint8 = 0
    description: str = ""
    additional_constraints: str = ""
    read_only: bool = False
    dynamic_typing: bool = False
    floating_point_range: Annotated[list[FloatingPointRange], Sequence[FloatingPointRange, 1]] = (
        DEFAULT
    )
    integer_range: Annotated[list[IntegerRange], Sequence[IntegerRange, 1]] = DEFAULT


class ParameterEvent(Message, typename="rcl_interfaces/msg/ParameterEvent"):
    """Which parameters of a node are new, changed or gone."""

    stamp: Time = DEFAULT
    node: str = ""
    new_parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT
    changed_parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT
    deleted_parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT


class ParameterEventDescriptors(Message, typename="rcl_interfaces/msg/ParameterEventDescriptors"):
    """Which descriptors of a node's parameters are new, changed or gone."""

    new_parameters: Annotated[list[ParameterDescriptor], Sequence[ParameterDescriptor]] = DEFAULT
    changed_parameters: Annotated[list[ParameterDescriptor], Sequence[ParameterDescriptor]] = (
        DEFAULT
    )
    deleted_parameters: Annotated[list[ParameterDescriptor], Sequence[ParameterDescriptor]] = (
        DEFAULT
    )


class ParameterType(Message, typename="rcl_interfaces/msg/ParameterType"):
    """The types that a parameter can have, as constants."""

    PARAMETER_NOT_SET: ClassVar[uint8] = 0
    PARAMETER_BOOL: ClassVar[uint8] = 1
    PARAMETER_INTEGER: ClassVar[uint8] = 2
    PARAMETER_DOUBLE: ClassVar[uint8] = 3
    PARAMETER_STRING: ClassVar[uint8] = 4
    PARAMETER_BYTE_ARRAY: ClassVar[uint8] = 5
    PARAMETER_BOOL_ARRAY: ClassVar[uint8] = 6
    PARAMETER_INTEGER_ARRAY: ClassVar[uint8] = 7
    PARAMETER_DOUBLE_ARRAY: ClassVar[uint8] = 8
    PARAMETER_STRING_ARRAY: ClassVar[uint8] = 9


class SetLoggerLevelsResult(Message, typename="rcl_interfaces/msg/SetLoggerLevelsResult"):
    """Whether a logger's level was set, or why not."""

    successful: bool = False
    reason: str = ""


class SetParametersResult(Message, typename="rcl_interfaces/msg/SetParametersResult"):
    """Whether a parameter was set, or why not."""

    successful: bool = False
    reason: str = ""
