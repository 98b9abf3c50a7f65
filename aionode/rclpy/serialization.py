"""Messages as bytes (CDR), and back."""

from __future__ import annotations

from typing import Any

from aionode.rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from aionode.rclpy.type_support import check_for_type_support

__all__ = ["deserialize_message", "serialize_message"]


def serialize_message(message: Any) -> bytes:
    """Return a message as bytes.

    Raises:
        AttributeError: it is no message.
    """
    check_for_type_support(type(message))
    return _rclpy.rclpy_serialize(message, type(message))


def deserialize_message(serialized_message: bytes, message_type: Any) -> Any:
    """Return the message of a class in bytes.

    Raises:
        AttributeError: `message_type` is no message class.
        DecodeError: the bytes hold no such message (a ValueError).
    """
    check_for_type_support(message_type)
    return _rclpy.rclpy_deserialize(serialized_message, message_type)
