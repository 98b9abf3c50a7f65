"""Services of test_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.test_msgs.msg import BasicTypes as TestMsgsBasicTypes
from aionode.interfaces.test_msgs.msg import Constants, Defaults
from aionode.message import (
    DEFAULT,
    Array,
    Bools,
    Bytes,
    Floats,
    Ints,
    Message,
    ServiceType,
    byte,
    char,
    float32,
    float64,
    int8,
    int16,
    int32,
    int64,
    uint8,
    uint16,
    uint32,
    uint64,
)

__all__ = ["Arrays", "BasicTypes", "Empty"]


class Arrays(ServiceType, typename="test_msgs/srv/Arrays"):
    """For tests: a service of arrays."""

    class Request(Message):
        """The request of Arrays."""

        bool_values: Annotated[Bools, Array[bool, 3]] = DEFAULT
        byte_values: Annotated[Bytes, Array[byte, 3]] = DEFAULT
        char_values: Annotated[Ints, Array[char, 3]] = DEFAULT
        float32_values: Annotated[Floats, Array[float32, 3]] = DEFAULT
        float64_values: Annotated[Floats, Array[float64, 3]] = DEFAULT
        int8_values: Annotated[Ints, Array[int8, 3]] = DEFAULT
        uint8_values: Annotated[Ints, Array[uint8, 3]] = DEFAULT
        int16_values: Annotated[Ints, Array[int16, 3]] = DEFAULT
        uint16_values: Annotated[Ints, Array[uint16, 3]] = DEFAULT
        int32_values: Annotated[Ints, Array[int32, 3]] = DEFAULT
        uint32_values: Annotated[Ints, Array[uint32, 3]] = DEFAULT
        int64_values: Annotated[Ints, Array[int64, 3]] = DEFAULT
        uint64_values: Annotated[Ints, Array[uint64, 3]] = DEFAULT
        string_values: Annotated[list[str], Array[str, 3]] = DEFAULT
        basic_types_values: Annotated[list[TestMsgsBasicTypes], Array[TestMsgsBasicTypes, 3]] = (
            DEFAULT
        )
        constants_values: Annotated[list[Constants], Array[Constants, 3]] = DEFAULT
        defaults_values: Annotated[list[Defaults], Array[Defaults, 3]] = DEFAULT
        bool_values_default: Array[bool, 3] = (False, True, False)
        byte_values_default: Array[byte, 3] = (0, 1, 255)
        char_values_default: Array[char, 3] = (0, 1, 127)
        float32_values_default: Array[float32, 3] = (1.125, 0.0, -1.125)
        float64_values_default: Array[float64, 3] = (3.1415, 0.0, -3.1415)
        int8_values_default: Array[int8, 3] = (0, 127, -128)
        uint8_values_default: Array[uint8, 3] = (0, 1, 255)
        int16_values_default: Array[int16, 3] = (0, 32767, -32768)
        uint16_values_default: Array[uint16, 3] = (0, 1, 65535)
        int32_values_default: Array[int32, 3] = (0, 2147483647, -2147483648)
        uint32_values_default: Array[uint32, 3] = (0, 1, 4294967295)
        int64_values_default: Array[int64, 3] = (0, 9223372036854775807, -9223372036854775808)
        uint64_values_default: Array[uint64, 3] = (0, 1, 18446744073709551615)
        string_values_default: Array[str, 3] = ("", "max value", "min value")

    class Response(Message):
        """The response of Arrays."""

        bool_values: Annotated[Bools, Array[bool, 3]] = DEFAULT
        byte_values: Annotated[Bytes, Array[byte, 3]] = DEFAULT
        char_values: Annotated[Ints, Array[char, 3]] = DEFAULT
        float32_values: Annotated[Floats, Array[float32, 3]] = DEFAULT
        float64_values: Annotated[Floats, Array[float64, 3]] = DEFAULT
        int8_values: Annotated[Ints, Array[int8, 3]] = DEFAULT
        uint8_values: Annotated[Ints, Array[uint8, 3]] = DEFAULT
        int16_values: Annotated[Ints, Array[int16, 3]] = DEFAULT
        uint16_values: Annotated[Ints, Array[uint16, 3]] = DEFAULT
        int32_values: Annotated[Ints, Array[int32, 3]] = DEFAULT
        uint32_values: Annotated[Ints, Array[uint32, 3]] = DEFAULT
        int64_values: Annotated[Ints, Array[int64, 3]] = DEFAULT
        uint64_values: Annotated[Ints, Array[uint64, 3]] = DEFAULT
        string_values: Annotated[list[str], Array[str, 3]] = DEFAULT
        basic_types_values: Annotated[list[TestMsgsBasicTypes], Array[TestMsgsBasicTypes, 3]] = (
            DEFAULT
        )
        constants_values: Annotated[list[Constants], Array[Constants, 3]] = DEFAULT
        defaults_values: Annotated[list[Defaults], Array[Defaults, 3]] = DEFAULT
        bool_values_default: Array[bool, 3] = (False, True, False)
        byte_values_default: Array[byte, 3] = (0, 1, 255)
        char_values_default: Array[char, 3] = (0, 1, 127)
        float32_values_default: Array[float32, 3] = (1.125, 0.0, -1.125)
        float64_values_default: Array[float64, 3] = (3.1415, 0.0, -3.1415)
        int8_values_default: Array[int8, 3] = (0, 127, -128)
        uint8_values_default: Array[uint8, 3] = (0, 1, 255)
        int16_values_default: Array[int16, 3] = (0, 32767, -32768)
        uint16_values_default: Array[uint16, 3] = (0, 1, 65535)
        int32_values_default: Array[int32, 3] = (0, 2147483647, -2147483648)
        uint32_values_default: Array[uint32, 3] = (0, 1, 4294967295)
        int64_values_default: Array[int64, 3] = (0, 9223372036854775807, -9223372036854775808)
        uint64_values_default: Array[uint64, 3] = (0, 1, 18446744073709551615)
        string_values_default: Array[str, 3] = ("", "max value", "min value")


class BasicTypes(ServiceType, typename="test_msgs/srv/BasicTypes"):
    """For tests: a service of every primitive kind of field."""

    class Request(Message):
        """The request of BasicTypes."""

        bool_value: bool = False
        byte_value: byte = b"\x00"
        char_value: char = 0
        float32_value: float32 = 0.0
        float64_value: float64 = 0.0
        int8_value: int8 = 0
        uint8_value: uint8 = 0
        int16_value: int16 = 0
        uint16_value: uint16 = 0
        int32_value: int32 = 0
        uint32_value: uint32 = 0
        int64_value: int64 = 0
        uint64_value: uint64 = 0
        string_value: str = ""

    class Response(Message):
        """The response of BasicTypes."""

        bool_value: bool = False
        byte_value: byte = b"\x00"
        char_value: char = 0
        float32_value: float32 = 0.0
        float64_value: float64 = 0.0
        int8_value: int8 = 0
        uint8_value: uint8 = 0
        int16_value: int16 = 0
        uint16_value: uint16 = 0
        int32_value: int32 = 0
        uint32_value: uint32 = 0
        int64_value: int64 = 0
        uint64_value: uint64 = 0
        string_value: str = ""


class Empty(ServiceType, typename="test_msgs/srv/Empty"):
    """For tests: a service without fields."""

    class Request(Message):
        """The request of Empty."""

    class Response(Message):
        """The response of Empty."""
