"""Messages of example_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import (
    DEFAULT,
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
    "Bool",
    "Byte",
    "ByteMultiArray",
    "Char",
    "Empty",
    "Float32",
    "Float32MultiArray",
    "Float64",
    "Float64MultiArray",
    "Int8",
    "Int8MultiArray",
    "Int16",
    "Int16MultiArray",
    "Int32",
    "Int32MultiArray",
    "Int64",
    "Int64MultiArray",
    "MultiArrayDimension",
    "MultiArrayLayout",
    "String",
    "UInt8",
    "UInt8MultiArray",
    "UInt16",
    "UInt16MultiArray",
    "UInt32",
    "UInt32MultiArray",
    "UInt64",
    "UInt64MultiArray",
    "WString",
]


class Bool(Message, typename="example_interfaces/msg/Bool"):
    """Bool."""

    data: bool = False


class Byte(Message, typename="example_interfaces/msg/Byte"):
    """Byte."""

    data: byte = b"\x00"


class MultiArrayDimension(Message, typename="example_interfaces/msg/MultiArrayDimension"):
    """MultiArrayDimension."""

    label: str = ""
    size: uint32 = 0
    stride: uint32 = 0


class MultiArrayLayout(Message, typename="example_interfaces/msg/MultiArrayLayout"):
    """MultiArrayLayout."""

    dim: Annotated[list[MultiArrayDimension], Sequence[MultiArrayDimension]] = DEFAULT
    data_offset: uint32 = 0


class ByteMultiArray(Message, typename="example_interfaces/msg/ByteMultiArray"):
    """ByteMultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Bytes, Sequence[byte]] = DEFAULT


class Char(Message, typename="example_interfaces/msg/Char"):
    """Char."""

    data: char = 0


class Empty(Message, typename="example_interfaces/msg/Empty"):
    """Empty."""


class Float32(Message, typename="example_interfaces/msg/Float32"):
    """Float32."""

    data: float32 = 0.0


class Float32MultiArray(Message, typename="example_interfaces/msg/Float32MultiArray"):
    """Float32MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Floats, Sequence[float32]] = DEFAULT


class Float64(Message, typename="example_interfaces/msg/Float64"):
    """Float64."""

    data: float64 = 0.0


class Float64MultiArray(Message, typename="example_interfaces/msg/Float64MultiArray"):
    """Float64MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Floats, Sequence[float64]] = DEFAULT


class Int16(Message, typename="example_interfaces/msg/Int16"):
    """Int16."""

    data: int16 = 0


class Int16MultiArray(Message, typename="example_interfaces/msg/Int16MultiArray"):
    """Int16MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int16]] = DEFAULT


class Int32(Message, typename="example_interfaces/msg/Int32"):
    """Int32."""

    data: int32 = 0


class Int32MultiArray(Message, typename="example_interfaces/msg/Int32MultiArray"):
    """Int32MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int32]] = DEFAULT


class Int64(Message, typename="example_interfaces/msg/Int64"):
    """Int64."""

    data: int64 = 0


class Int64MultiArray(Message, typename="example_interfaces/msg/Int64MultiArray"):
    """Int64MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int64]] = DEFAULT


class Int8(Message, typename="example_interfaces/msg/Int8"):
    """Int8."""

    data: int8 = 0


class Int8MultiArray(Message, typename="example_interfaces/msg/Int8MultiArray"):
    """Int8MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int8]] = DEFAULT


class String(Message, typename="example_interfaces/msg/String"):
    """String."""

    data: str = ""


class UInt16(Message, typename="example_interfaces/msg/UInt16"):
    """UInt16."""

    data: uint16 = 0


class UInt16MultiArray(Message, typename="example_interfaces/msg/UInt16MultiArray"):
    """UInt16MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[uint16]] = DEFAULT


class UInt32(Message, typename="example_interfaces/msg/UInt32"):
    """UInt32."""

    data: uint32 = 0


class UInt32MultiArray(Message, typename="example_interfaces/msg/UInt32MultiArray"):
    """UInt32MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[uint32]] = DEFAULT


class UInt64(Message, typename="example_interfaces/msg/UInt64"):
    """UInt64."""

    data: uint64 = 0


class UInt64MultiArray(Message, typename="example_interfaces/msg/UInt64MultiArray"):
    """UInt64MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[uint64]] = DEFAULT


class UInt8(Message, typename="example_interfaces/msg/UInt8"):
    """UInt8."""

    data: uint8 = 0


class UInt8MultiArray(Message, typename="example_interfaces/msg/UInt8MultiArray"):
    """UInt8MultiArray."""

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class WString(Message, typename="example_interfaces/msg/WString"):
    """WString."""

    data: wstring = ""
