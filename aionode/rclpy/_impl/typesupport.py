"""How messages of either family are encoded: rclpy's as rosidl makes them, and aionode's own."""

from __future__ import annotations

from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from aionode.message import ActionType, Message, ServiceType, serialized, type_name
from aionode.rclpy import _rosidl
from aionode.wire import cdr

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = [
    "MessageSupport",
    "ServiceSupport",
    "aionode_class",
    "expect_message",
    "message_like",
    "message_support",
    "ros_name",
    "service_support",
]


class MessageSupport:
    """How to send messages of one class.

    Attributes:
        wire_type: The class of its encoded messages, for the core.
    """

    def __init__(self, msg_type: type[Any], wire_type: Any) -> None:
        self.wire_type = wire_type
        self._msg_type = msg_type

    @cached_property
    def encode(self) -> Callable[[Any], bytes]:
        """Returns a message as bytes."""
        return cdr.encoder(self._msg_type) if is_own(self._msg_type) else _rosidl.encode

    @cached_property
    def decode(self) -> Callable[[bytes], Any]:
        """Returns the message in bytes."""
        cls = self._msg_type
        return cdr.decoder(cls) if is_own(cls) else _rosidl.decoder_of(cls)


class ServiceSupport(NamedTuple):
    """How to send the requests and responses of one service class."""

    wire_type: Any
    request: MessageSupport
    response: MessageSupport


def is_own(cls: Any) -> bool:
    """Whether a class is one of aionode's."""
    return isinstance(cls, type) and issubclass(cls, Message | ServiceType | ActionType)


def ros_name(cls: Any) -> str:
    """Return the ROS name of a message, service or action class of either family.

    Raises:
        TypeError: it is no such class.
    """
    return type_name(cls) if is_own(cls) else _rosidl.ros_type_name(cls)


def aionode_class(cls: Any) -> Any:
    """Return aionode's class of the same type."""
    return cls if is_own(cls) else _rosidl.aionode_class(cls)


def message_like(cls: Any, name: str) -> Any:
    """Return the message class with a ROS name that is of the same family as `cls`."""
    found = _rosidl.message_class(name)
    return _rosidl.aionode_class(found) if is_own(cls) else found


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


def expect_message(message: Any, name: str) -> None:
    """Raise a TypeError unless an object is a message of a type, of either family."""
    try:
        given = ros_name(type(message))
    except (TypeError, AttributeError):
        given = type(message).__name__
    if given != name:
        raise TypeError(f"Must pass a {name} object, not {given}")
