"""Messages that stay in their encoded form."""

from __future__ import annotations

from typing import Any

import pytest

from aionode.engine.wire import cdr
from aionode.engine.wire.typehash import type_hash
from aionode.errors import DecodeError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.message import SerializedMessage, fields, serialized, type_name, unserialized


def test_encoding_returns_the_bytes_as_they_are() -> None:
    """A bridge must not pay for a codec that it does not need."""
    data = cdr.encode(String(data="hello"))

    message = serialized(String)(data)

    assert cdr.encode(message) is data
    assert b"".join(cdr.parts_encoder(type(message))(message)) == data


def test_decoding_keeps_the_bytes() -> None:
    """Whether they are a valid message shows only when they are decoded."""
    kept = cdr.decode(serialized(String), memoryview(b"\0\1\0\0 no message"))

    assert isinstance(kept, SerializedMessage)
    assert kept.data == b"\0\1\0\0 no message"
    with pytest.raises(DecodeError):
        cdr.decode(String, kept.data)


def test_the_type_is_that_of_the_class_it_stands_for() -> None:
    """Endpoints of both communicate, as name, fields and hash are the same."""
    for cls in (String, Imu):
        assert type_name(serialized(cls)) == type_name(cls)
        assert type_hash(serialized(cls)) == type_hash(cls)
        assert fields(serialized(cls)) == fields(cls)
        assert unserialized(serialized(cls)) is cls
        assert unserialized(cls) is cls
    assert type_hash(serialized(AddTwoInts)) == type_hash(AddTwoInts)
    assert unserialized(serialized(AddTwoInts).Request) is AddTwoInts.Request


def test_a_class_has_one_serialized_class() -> None:
    """Otherwise each endpoint would convert what others send."""
    assert serialized(String) is serialized(String)
    assert serialized(String) is not serialized(Int32)


@pytest.mark.parametrize("given", [str, "std_msgs/msg/String", Fibonacci])
def test_other_classes_are_refused(given: Any) -> None:
    """An action consists of services and messages, each of which can be serialized."""
    with pytest.raises(TypeError):
        serialized(given)
