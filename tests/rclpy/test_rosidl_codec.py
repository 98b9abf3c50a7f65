"""Encoding and decoding of rosidl messages: the same bytes as aionode's own."""

from __future__ import annotations

import array
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from aionode.engine.wire import cdr
from aionode.errors import DecodeError, MessageError
from aionode.message import Message, snapshot
from rosidl_generator_py import (
    decode,
    encode,
    from_aionode,
    message_class,
    service_class,
    to_aionode,
)
from tests.support.strategies import any_messages, various_classes

String = message_class("std_msgs/msg/String")
Sequences = message_class("test_msgs/msg/UnboundedSequences")
Arrays = message_class("test_msgs/msg/Arrays")


@given(any_messages())
def test_bytes_are_those_of_aionode(message: Message) -> None:
    """There is one encoding, whichever library writes it."""
    assert encode(from_aionode(message)) == cdr.encode(message)


@given(any_messages())
def test_what_is_encoded_can_be_decoded(message: Message) -> None:
    """A message is equal after its way over the network, and can be changed."""
    msg = from_aionode(message)

    again = decode(type(msg), encode(msg))

    assert again == msg
    assert snapshot(to_aionode(again)) == snapshot(message)


@pytest.mark.slow
def test_a_new_message_is_decoded_into_what_its_constructor_makes() -> None:
    """Decoding bypasses the constructor, and must produce values of the same types."""
    for cls in various_classes().values():
        fresh: Any = type(from_aionode(cls()))()

        again = decode(type(fresh), encode(fresh))

        assert encode(again) == encode(fresh)  # a float32 is rounded: 0.3
        assert again._check_fields == fresh._check_fields
        for name in fresh.get_fields_and_field_types():
            assert type(getattr(again, name)) is type(getattr(fresh, name)), (cls, name)


def test_a_decoded_message_shares_no_memory_with_its_data() -> None:
    """Programs modify what they receive, and keep it."""
    data = bytearray(encode(Sequences(float32_values=[1.0], uint8_values=b"ab")))
    msg = decode(Sequences, data)
    data[:] = bytes(len(data))

    msg.float32_values.append(2.0)

    assert msg.float32_values == array.array("f", [1.0, 2.0])
    assert msg.uint8_values == array.array("B", b"ab")
    assert decode(Arrays, encode(Arrays())).float32_values.flags.writeable


def test_the_other_byte_order_is_decoded() -> None:
    """A big-endian machine may be on the network."""
    assert decode(message_class("std_msgs/msg/Int32"), bytes.fromhex("00000000 00000001")).data == 1


def test_unusual_values_are_encoded_as_in_ros() -> None:
    """ROS converts them in C; a program that assigns them works there."""
    made = Sequences(
        bool_values=(True, np.bool_(False)),
        byte_values=(b"a", b"b"),
        string_values=("a", "b"),
        basic_types_values=(message_class("test_msgs/msg/BasicTypes")(int8_value=True),),
    )

    again = decode(Sequences, encode(made))

    assert again.bool_values == [True, False]
    assert again.byte_values == [b"a", b"b"]
    assert again.string_values == ["a", "b"]
    assert again.basic_types_values[0].int8_value == 1


def test_an_array_of_another_type_is_converted_or_refused() -> None:
    """A slot may hold anything, because its check is off."""
    scan = message_class("sensor_msgs/msg/LaserScan")()
    scan._ranges = array.array("d", [1.0, 2.0])

    assert decode(type(scan), encode(scan)).ranges == array.array("f", [1.0, 2.0])


@pytest.mark.parametrize(
    ("msg", "text"),
    [
        (String(data=5), "std_msgs/msg/String.data: 5 (int), needs a str"),
        (
            message_class("std_msgs/msg/Int8")(data=300),
            "std_msgs/msg/Int8.data: 300, int8 holds -128 to 127",
        ),
        (
            message_class("std_msgs/msg/Float64")(data=np.array([1.0])),
            "std_msgs/msg/Float64.data: array([1.]) (ndarray), needs a float",
        ),
        (
            Arrays(float32_values=[1.0]),
            "test_msgs/msg/Arrays.float32_values: 1 elements, needs 3",
        ),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(msg: Any, text: str) -> None:
    """ROS sends something else instead, or raises a SystemError that names nothing."""
    with pytest.raises(MessageError) as caught:
        encode(msg)

    assert str(caught.value) == text


def test_a_nested_message_of_another_kind_is_refused() -> None:
    """The error is that of rclpy."""
    with pytest.raises(AttributeError, match="'String' object has no attribute 'sec'"):
        encode(message_class("std_msgs/msg/Header")(stamp=String()))


def test_damaged_data_is_refused() -> None:
    """The error names type and offset."""
    with pytest.raises(DecodeError, match="std_msgs/msg/String"):
        decode(String, b"\0\1\0\0\5\0\0\0ab")


def test_what_is_no_message_is_refused() -> None:
    """The error says what would be valid."""
    service = service_class("std_srvs/srv/Trigger")
    with pytest.raises(TypeError, match=r"not a message class; use one of its parts"):
        decode(service, b"")
    with pytest.raises(TypeError, match="not a message class"):
        encode(5)
