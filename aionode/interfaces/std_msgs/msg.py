"""Messages of std_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
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
)

__all__ = [
    "Bool",
    "Byte",
    "ByteMultiArray",
    "Char",
    "ColorRGBA",
    "Empty",
    "Float32",
    "Float32MultiArray",
    "Float64",
    "Float64MultiArray",
    "Header",
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
]


class Header(Message, typename="std_msgs/msg/Header"):
    """When and where the data of a message belongs.

    Attributes:
        stamp: When it was measured, or is valid; not when it was sent.
        frame_id: The coordinate frame that its numbers are in, such as ``base_link``.
    """

    stamp: Time = DEFAULT
    frame_id: str = ""


class MultiArrayDimension(Message, typename="std_msgs/msg/MultiArrayDimension"):
    """One dimension of an array.

    Attributes:
        label: What it is, such as ``height``.
        size: Number of elements along it.
        stride: Number of elements from one of its steps to the next, times `size`.
    """

    label: str = ""
    size: uint32 = 0
    stride: uint32 = 0


class MultiArrayLayout(Message, typename="std_msgs/msg/MultiArrayLayout"):
    """How the flat data of an array is to be read.

    Attributes:
        dim: The dimensions, the outermost first.
        data_offset: Number of elements to skip before the first.
    """

    dim: Annotated[list[MultiArrayDimension], Sequence[MultiArrayDimension]] = DEFAULT
    data_offset: uint32 = 0


class Float64MultiArray(Message, typename="std_msgs/msg/Float64MultiArray"):
    """An array of floats of 64 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Floats, Sequence[float64]] = DEFAULT


class Int8MultiArray(Message, typename="std_msgs/msg/Int8MultiArray"):
    """An array of signed integers of 8 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int8]] = DEFAULT


class String(Message, typename="std_msgs/msg/String"):
    """One value: text."""

    data: str = ""


class ColorRGBA(Message, typename="std_msgs/msg/ColorRGBA"):
    """A color: red, green, blue and opacity, each from 0 to 1."""

    r: float32 = 0.0
    g: float32 = 0.0
    b: float32 = 0.0
    a: float32 = 0.0


class Empty(Message, typename="std_msgs/msg/Empty"):
    """Nothing: that it came is the message."""


class Bool(Message, typename="std_msgs/msg/Bool"):
    """One value: true or false."""

    data: bool = False


class Byte(Message, typename="std_msgs/msg/Byte"):
    """One value: a byte, as bytes of length 1."""

    data: byte = b"\x00"


class ByteMultiArray(Message, typename="std_msgs/msg/ByteMultiArray"):
    """An array of bytes, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Bytes, Sequence[byte]] = DEFAULT


class Char(Message, typename="std_msgs/msg/Char"):
    """One value: an unsigned number of 8 bits."""

    data: char = 0


class Float32(Message, typename="std_msgs/msg/Float32"):
    """One value: a float of 32 bits."""

    data: float32 = 0.0


class Float32MultiArray(Message, typename="std_msgs/msg/Float32MultiArray"):
    """An array of floats of 32 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Floats, Sequence[float32]] = DEFAULT


class Float64(Message, typename="std_msgs/msg/Float64"):
    """One value: a float of 64 bits."""

    data: float64 = 0.0


class Int16(Message, typename="std_msgs/msg/Int16"):
    """One value: a signed integer of 16 bits."""

    data: int16 = 0


class Int16MultiArray(Message, typename="std_msgs/msg/Int16MultiArray"):
    """An array of signed integers of 16 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int16]] = DEFAULT


class Int32(Message, typename="std_msgs/msg/Int32"):
    """One value: a signed integer of 32 bits."""

    data: int32 = 0


class Int32MultiArray(Message, typename="std_msgs/msg/Int32MultiArray"):
    """An array of signed integers of 32 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int32]] = DEFAULT


class Int64(Message, typename="std_msgs/msg/Int64"):
    """One value: a signed integer of 64 bits."""

    data: int64 = 0


class Int64MultiArray(Message, typename="std_msgs/msg/Int64MultiArray"):
    """An array of signed integers of 64 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[int64]] = DEFAULT


class Int8(Message, typename="std_msgs/msg/Int8"):
    """One value: a signed integer of 8 bits."""

    data: int8 = 0


class UInt16(Message, typename="std_msgs/msg/UInt16"):
    """One value: an unsigned integer of 16 bits."""

    data: uint16 = 0


class UInt16MultiArray(Message, typename="std_msgs/msg/UInt16MultiArray"):
    """An array of unsigned integers of 16 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[uint16]] = DEFAULT


class UInt32(Message, typename="std_msgs/msg/UInt32"):
    """One value: an unsigned integer of 32 bits."""

    data: uint32 = 0


class UInt32MultiArray(Message, typename="std_msgs/msg/UInt32MultiArray"):
    """An array of unsigned integers of 32 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[uint32]] = DEFAULT


class UInt64(Message, typename="std_msgs/msg/UInt64"):
    """One value: an unsigned integer of 64 bits."""

    data: uint64 = 0


class UInt64MultiArray(Message, typename="std_msgs/msg/UInt64MultiArray"):
    """An array of unsigned integers of 64 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Ints, Sequence[uint64]] = DEFAULT


class UInt8(Message, typename="std_msgs/msg/UInt8"):
    """One value: an unsigned integer of 8 bits."""

    data: uint8 = 0


class UInt8MultiArray(Message, typename="std_msgs/msg/UInt8MultiArray"):
    """An array of unsigned integers of 8 bits, of any number of dimensions.

    `layout` says how `data` is to be read; it is often left empty for one dimension.
    """

    layout: MultiArrayLayout = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
