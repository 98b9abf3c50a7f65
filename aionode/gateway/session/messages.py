"""Creates messages from what clients write."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import MessageError
from aionode.gateway.session.encoding.values import from_json
from aionode.message import Message, fields

if TYPE_CHECKING:
    from aionode.clock import Clock

__all__ = ["as_message", "large_message"]

CDR_HEADER: Final = 4


def as_message(
    cls: Any, values: Message | Mapping[str, Any] | list[Any] | bytes, clock: Clock
) -> Any:
    """Return a message of a class: unchanged, or created from a client's values or bytes.

    Args:
        cls: The class.
        values: The message, its values by name or in order (see `from_json`), or its CDR bytes.
        clock: The clock for stamps that the client leaves to the robot.

    Raises:
        MessageError: a value does not fit its field.
        DecodeError: the bytes are not such a message.
    """
    if isinstance(values, Message):
        return values
    if isinstance(values, bytes | bytearray | memoryview):
        from aionode.engine.wire import cdr  # few clients send bytes

        return cdr.decode(cls, values)
    return from_json(cls, values, clock.now().nanoseconds)


def least_bytes(cls: Any, values: object) -> int:
    """Return the minimum size of the messages in a message's lists, in bytes."""
    if isinstance(values, list):
        values = dict(zip((field.name for field in fields(cls)), values, strict=False))
    if not isinstance(values, Mapping):
        return 0
    total = 0
    for field in fields(cls):
        nested, inner = field.type.nested, values.get(field.name)
        if nested is None or not inner:
            continue
        if field.type.container == "single":
            total += least_bytes(nested, inner)
        elif isinstance(inner, list):
            total += len(inner) * empty_bytes(nested)
            total += sum(least_bytes(nested, item) for item in inner if item)
    return total


@cache
def empty_bytes(cls: Any) -> int:
    """Return the size of an empty message, in bytes of CDR."""
    from aionode.engine.wire import cdr  # few clients send large messages

    return len(cdr.encode(cls())) - CDR_HEADER


def large_message(cls: Any, values: Any, clock: Clock, max_bytes: int) -> Any:
    """Return a message; see `as_message`. Called in a thread.

    Raises:
        MessageError: it takes more than `max_bytes`.
    """
    from aionode.engine.wire import cdr  # few clients send large messages

    least = least_bytes(cls, values)
    if least > max_bytes:  # the empty messages alone would exhaust the memory
        raise MessageError(
            cls.__ros_type__, f"takes {least} bytes, at most {max_bytes} are allowed"
        )
    message = as_message(cls, values, clock)
    size = len(cdr.encode(message))
    if size > max_bytes:
        raise MessageError(cls.__ros_type__, f"takes {size} bytes, at most {max_bytes} are allowed")
    return message
