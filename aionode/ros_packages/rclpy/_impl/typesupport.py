"""How messages of either family are encoded: rclpy's as rosidl makes them, and aionode's own."""

from __future__ import annotations

from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from aionode.message import ActionType, Message, ServiceType, serialized
from rosidl_generator_py import (
    aionode_class,
    decoder_of,
    encode,
    message_class,
    ros_type_name,
)

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = [
    "MessageSupport",
    "ServiceSupport",
    "expect_message",
    "message_like",
    "message_support",
    "service_support",
    "type_of",
]


class MessageSupport:
    """How to send messages of one class.

    Attributes:
        encode: Returns a message as bytes.
        wire_type: The class of its encoded messages, for the core.
    """

    encode = staticmethod(encode)

    def __init__(self, msg_type: Any, wire_type: Any) -> None:
        self.wire_type = wire_type
        self._msg_type = msg_type

    @cached_property
    def decode(self) -> Callable[[bytes], Any]:
        """Returns the message in bytes."""
        return decoder_of(self._msg_type)


class ServiceSupport(NamedTuple):
    """How to send the requests and responses of one service class."""

    wire_type: Any
    request: MessageSupport
    response: MessageSupport


def is_own(cls: Any) -> bool:
    """Whether a class is one of aionode's."""
    return isinstance(cls, type) and issubclass(cls, Message | ServiceType | ActionType)


def message_like(cls: Any, name: str) -> Any:
    """Return the message class with a ROS name that is of the same family as `cls`."""
    like = message_class(name)
    return aionode_class(like) if is_own(cls) else like


@cache
def message_support(cls: Any) -> MessageSupport:
    """Return how to send messages of `cls`."""
    return MessageSupport(cls, serialized(aionode_class(cls)))


@cache
def service_support(cls: Any) -> ServiceSupport:
    """Return how to send the requests and responses of `cls`."""
    wire_type = serialized(aionode_class(cls))
    return ServiceSupport(
        wire_type,
        MessageSupport(cls.Request, wire_type.Request),
        MessageSupport(cls.Response, wire_type.Response),
    )


def type_of(message: object) -> str:
    """Return the ROS name of a message's type; the name of the class of any other object."""
    try:
        return ros_type_name(type(message))
    except TypeError:
        return type(message).__name__


def expect_message(message: Any, name: str) -> None:
    """Raise a TypeError unless an object is a message of a type, of either family."""
    given = type_of(message)
    if given != name:
        raise TypeError(f"Must pass a {name} object, not {given}")
