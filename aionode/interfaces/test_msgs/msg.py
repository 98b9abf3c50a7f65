"""Messages of test_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.message import (
    DEFAULT,
    Array,
    Bools,
    Bounded,
    Bytes,
    Floats,
    Ints,
    Message,
    Sequence,
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
    wstring,
)

__all__ = [
    "Arrays",
    "BasicTypes",
    "BoundedPlainSequences",
    "BoundedSequences",
    "Builtins",
    "Constants",
    "Defaults",
    "Empty",
    "MultiNested",
    "Nested",
    "Strings",
    "UnboundedSequences",
    "WStrings",
]


class Builtins(Message, typename="test_msgs/msg/Builtins"):
    """For tests: time and duration."""

    duration_value: Duration = DEFAULT
    time_value: Time = DEFAULT


class BasicTypes(Message, typename="test_msgs/msg/BasicTypes"):
    """For tests: every primitive kind of field."""

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


class Constants(Message, typename="test_msgs/msg/Constants"):
    """For tests: constants of every primitive kind."""

    BOOL_CONST: ClassVar[bool] = True
    BYTE_CONST: ClassVar[byte] = b"2"
    CHAR_CONST: ClassVar[char] = 100
    FLOAT32_CONST: ClassVar[float32] = 1.125
    FLOAT64_CONST: ClassVar[float64] = 1.125
    INT8_CONST: ClassVar[int8] = -50
    UINT8_CONST: ClassVar[uint8] = 200
    INT16_CONST: ClassVar[int16] = -1000
    UINT16_CONST: ClassVar[uint16] = 2000
    INT32_CONST: ClassVar[int32] = -30000
    UINT32_CONST: ClassVar[uint32] = 60000
    INT64_CONST: ClassVar[int64] = -40000000
    UINT64_CONST: ClassVar[uint64] = 50000000


class Defaults(Message, typename="test_msgs/msg/Defaults"):
    """For tests: fields of every primitive kind with defaults."""

    bool_value: bool = True
    byte_value: byte = b"2"
    char_value: char = 100
    float32_value: float32 = 1.125
    float64_value: float64 = 1.125
    int8_value: int8 = -50
    uint8_value: uint8 = 200
    int16_value: int16 = -1000
    uint16_value: uint16 = 2000
    int32_value: int32 = -30000
    uint32_value: uint32 = 60000
    int64_value: int64 = -40000000
    uint64_value: uint64 = 50000000


class Arrays(Message, typename="test_msgs/msg/Arrays"):
    """For tests: every kind of field in arrays of three."""

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
    basic_types_values: Annotated[list[BasicTypes], Array[BasicTypes, 3]] = DEFAULT
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
    alignment_check: int32 = 0


class BoundedPlainSequences(Message, typename="test_msgs/msg/BoundedPlainSequences"):
    """For tests: every kind of field but strings in sequences of at most three."""

    bool_values: Annotated[Bools, Sequence[bool, 3]] = DEFAULT
    byte_values: Annotated[Bytes, Sequence[byte, 3]] = DEFAULT
    char_values: Annotated[Ints, Sequence[char, 3]] = DEFAULT
    float32_values: Annotated[Floats, Sequence[float32, 3]] = DEFAULT
    float64_values: Annotated[Floats, Sequence[float64, 3]] = DEFAULT
    int8_values: Annotated[Ints, Sequence[int8, 3]] = DEFAULT
    uint8_values: Annotated[Bytes, Sequence[uint8, 3]] = DEFAULT
    int16_values: Annotated[Ints, Sequence[int16, 3]] = DEFAULT
    uint16_values: Annotated[Ints, Sequence[uint16, 3]] = DEFAULT
    int32_values: Annotated[Ints, Sequence[int32, 3]] = DEFAULT
    uint32_values: Annotated[Ints, Sequence[uint32, 3]] = DEFAULT
    int64_values: Annotated[Ints, Sequence[int64, 3]] = DEFAULT
    uint64_values: Annotated[Ints, Sequence[uint64, 3]] = DEFAULT
    basic_types_values: Annotated[list[BasicTypes], Sequence[BasicTypes, 3]] = DEFAULT
    constants_values: Annotated[list[Constants], Sequence[Constants, 3]] = DEFAULT
    defaults_values: Annotated[list[Defaults], Sequence[Defaults, 3]] = DEFAULT
    bool_values_default: Sequence[bool, 3] = (False, True, False)
    byte_values_default: Sequence[byte, 3] = (0, 1, 255)
    char_values_default: Sequence[char, 3] = (0, 1, 127)
    float32_values_default: Sequence[float32, 3] = (1.125, 0.0, -1.125)
    float64_values_default: Sequence[float64, 3] = (3.1415, 0.0, -3.1415)
    int8_values_default: Sequence[int8, 3] = (0, 127, -128)
    uint8_values_default: Sequence[uint8, 3] = (0, 1, 255)
    int16_values_default: Sequence[int16, 3] = (0, 32767, -32768)
    uint16_values_default: Sequence[uint16, 3] = (0, 1, 65535)
    int32_values_default: Sequence[int32, 3] = (0, 2147483647, -2147483648)
    uint32_values_default: Sequence[uint32, 3] = (0, 1, 4294967295)
    int64_values_default: Sequence[int64, 3] = (0, 9223372036854775807, -9223372036854775808)
    uint64_values_default: Sequence[uint64, 3] = (0, 1, 18446744073709551615)
    alignment_check: int32 = 0


class BoundedSequences(Message, typename="test_msgs/msg/BoundedSequences"):
    """For tests: every kind of field in sequences of at most three."""

    bool_values: Annotated[Bools, Sequence[bool, 3]] = DEFAULT
    byte_values: Annotated[Bytes, Sequence[byte, 3]] = DEFAULT
    char_values: Annotated[Ints, Sequence[char, 3]] = DEFAULT
    float32_values: Annotated[Floats, Sequence[float32, 3]] = DEFAULT
    float64_values: Annotated[Floats, Sequence[float64, 3]] = DEFAULT
    int8_values: Annotated[Ints, Sequence[int8, 3]] = DEFAULT
    uint8_values: Annotated[Bytes, Sequence[uint8, 3]] = DEFAULT
    int16_values: Annotated[Ints, Sequence[int16, 3]] = DEFAULT
    uint16_values: Annotated[Ints, Sequence[uint16, 3]] = DEFAULT
    int32_values: Annotated[Ints, Sequence[int32, 3]] = DEFAULT
    uint32_values: Annotated[Ints, Sequence[uint32, 3]] = DEFAULT
    int64_values: Annotated[Ints, Sequence[int64, 3]] = DEFAULT
    uint64_values: Annotated[Ints, Sequence[uint64, 3]] = DEFAULT
    string_values: Annotated[list[str], Sequence[str, 3]] = DEFAULT
    basic_types_values: Annotated[list[BasicTypes], Sequence[BasicTypes, 3]] = DEFAULT
    constants_values: Annotated[list[Constants], Sequence[Constants, 3]] = DEFAULT
    defaults_values: Annotated[list[Defaults], Sequence[Defaults, 3]] = DEFAULT
    bool_values_default: Sequence[bool, 3] = (False, True, False)
    byte_values_default: Sequence[byte, 3] = (0, 1, 255)
    char_values_default: Sequence[char, 3] = (0, 1, 127)
    float32_values_default: Sequence[float32, 3] = (1.125, 0.0, -1.125)
    float64_values_default: Sequence[float64, 3] = (3.1415, 0.0, -3.1415)
    int8_values_default: Sequence[int8, 3] = (0, 127, -128)
    uint8_values_default: Sequence[uint8, 3] = (0, 1, 255)
    int16_values_default: Sequence[int16, 3] = (0, 32767, -32768)
    uint16_values_default: Sequence[uint16, 3] = (0, 1, 65535)
    int32_values_default: Sequence[int32, 3] = (0, 2147483647, -2147483648)
    uint32_values_default: Sequence[uint32, 3] = (0, 1, 4294967295)
    int64_values_default: Sequence[int64, 3] = (0, 9223372036854775807, -9223372036854775808)
    uint64_values_default: Sequence[uint64, 3] = (0, 1, 18446744073709551615)
    string_values_default: Sequence[str, 3] = ("", "max value", "min value")
    alignment_check: int32 = 0


class Empty(Message, typename="test_msgs/msg/Empty"):
    """For tests: no fields."""


class UnboundedSequences(Message, typename="test_msgs/msg/UnboundedSequences"):
    """For tests: every kind of field in sequences of any length."""

    bool_values: Annotated[Bools, Sequence[bool]] = DEFAULT
    byte_values: Annotated[Bytes, Sequence[byte]] = DEFAULT
    char_values: Annotated[Ints, Sequence[char]] = DEFAULT
    float32_values: Annotated[Floats, Sequence[float32]] = DEFAULT
    float64_values: Annotated[Floats, Sequence[float64]] = DEFAULT
    int8_values: Annotated[Ints, Sequence[int8]] = DEFAULT
    uint8_values: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    int16_values: Annotated[Ints, Sequence[int16]] = DEFAULT
    uint16_values: Annotated[Ints, Sequence[uint16]] = DEFAULT
    int32_values: Annotated[Ints, Sequence[int32]] = DEFAULT
    uint32_values: Annotated[Ints, Sequence[uint32]] = DEFAULT
    int64_values: Annotated[Ints, Sequence[int64]] = DEFAULT
    uint64_values: Annotated[Ints, Sequence[uint64]] = DEFAULT
    string_values: Annotated[list[str], Sequence[str]] = DEFAULT
    basic_types_values: Annotated[list[BasicTypes], Sequence[BasicTypes]] = DEFAULT
    constants_values: Annotated[list[Constants], Sequence[Constants]] = DEFAULT
    defaults_values: Annotated[list[Defaults], Sequence[Defaults]] = DEFAULT
    bool_values_default: Sequence[bool] = (False, True, False)
    byte_values_default: Sequence[byte] = (0, 1, 255)
    char_values_default: Sequence[char] = (0, 1, 127)
    float32_values_default: Sequence[float32] = (1.125, 0.0, -1.125)
    float64_values_default: Sequence[float64] = (3.1415, 0.0, -3.1415)
    int8_values_default: Sequence[int8] = (0, 127, -128)
    uint8_values_default: Sequence[uint8] = (0, 1, 255)
    int16_values_default: Sequence[int16] = (0, 32767, -32768)
    uint16_values_default: Sequence[uint16] = (0, 1, 65535)
    int32_values_default: Sequence[int32] = (0, 2147483647, -2147483648)
    uint32_values_default: Sequence[uint32] = (0, 1, 4294967295)
    int64_values_default: Sequence[int64] = (0, 9223372036854775807, -9223372036854775808)
    uint64_values_default: Sequence[uint64] = (0, 1, 18446744073709551615)
    string_values_default: Sequence[str] = ("", "max value", "min value")
    alignment_check: int32 = 0


class MultiNested(Message, typename="test_msgs/msg/MultiNested"):
    """For tests: messages of arrays and sequences, in arrays and sequences."""

    array_of_arrays: Annotated[list[Arrays], Array[Arrays, 3]] = DEFAULT
    array_of_bounded_sequences: Annotated[list[BoundedSequences], Array[BoundedSequences, 3]] = (
        DEFAULT
    )
    array_of_unbounded_sequences: Annotated[
        list[UnboundedSequences], Array[UnboundedSequences, 3]
    ] = DEFAULT
    bounded_sequence_of_arrays: Annotated[list[Arrays], Sequence[Arrays, 3]] = DEFAULT
    bounded_sequence_of_bounded_sequences: Annotated[
        list[BoundedSequences], Sequence[BoundedSequences, 3]
    ] = DEFAULT
    bounded_sequence_of_unbounded_sequences: Annotated[
        list[UnboundedSequences], Sequence[UnboundedSequences, 3]
    ] = DEFAULT
    unbounded_sequence_of_arrays: Annotated[list[Arrays], Sequence[Arrays]] = DEFAULT
    unbounded_sequence_of_bounded_sequences: Annotated[
        list[BoundedSequences], Sequence[BoundedSequences]
    ] = DEFAULT
    unbounded_sequence_of_unbounded_sequences: Annotated[
        list[UnboundedSequences], Sequence[UnboundedSequences]
    ] = DEFAULT


class Nested(Message, typename="test_msgs/msg/Nested"):
    """For tests: a message in a message."""

    basic_types_value: BasicTypes = DEFAULT


class Strings(Message, typename="test_msgs/msg/Strings"):
    """For tests: strings with and without bounds, alone and in containers."""

    STRING_CONST: ClassVar[str] = "Hello world!"

    string_value: str = ""
    string_value_default1: str = "Hello world!"
    string_value_default2: str = "Hello'world!"
    string_value_default3: str = 'Hello"world!'
    string_value_default4: str = "Hello'world!"
    string_value_default5: str = 'Hello"world!'
    bounded_string_value: Bounded[str, 22] = ""
    bounded_string_value_default1: Bounded[str, 22] = "Hello world!"
    bounded_string_value_default2: Bounded[str, 22] = "Hello'world!"
    bounded_string_value_default3: Bounded[str, 22] = 'Hello"world!'
    bounded_string_value_default4: Bounded[str, 22] = "Hello'world!"
    bounded_string_value_default5: Bounded[str, 22] = 'Hello"world!'


class WStrings(Message, typename="test_msgs/msg/WStrings"):
    """For tests: wide strings with and without bounds, alone and in containers."""

    wstring_value: wstring = ""
    wstring_value_default1: wstring = "Hello world!"
    wstring_value_default2: wstring = "Hellö wörld!"
    wstring_value_default3: wstring = "ハローワールド"
    array_of_wstrings: Annotated[list[str], Array[wstring, 3]] = DEFAULT
    bounded_sequence_of_wstrings: Annotated[list[str], Sequence[wstring, 3]] = DEFAULT
    unbounded_sequence_of_wstrings: Annotated[list[str], Sequence[wstring]] = DEFAULT
