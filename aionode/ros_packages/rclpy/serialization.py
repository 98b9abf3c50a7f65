"""Messages as bytes (CDR), and back."""

from __future__ import annotations

from typing import Any

from rclpy._impl.typesupport import deserialized, message_support
from rclpy.type_support import check_for_type_support

__all__ = ["deserialize_message", "serialize_message"]


def serialize_message(message: Any) -> bytes:
    """Return a message as bytes.

    Raises:
        AttributeError: it is not a message.
    """
    message_type: Any = type(message)
    check_for_type_support(message_type)
    return message_support(message_type).encode(message)


def deserialize_message(serialized_message: bytes, message_type: Any) -> Any:
    """Decode a message of a class from bytes.

    Raises:
        AttributeError: `message_type` is not a message class.
        RMWError: the bytes are not such a message (a RuntimeError).
    """
    check_for_type_support(message_type)
    return deserialized(serialized_message, message_type)
