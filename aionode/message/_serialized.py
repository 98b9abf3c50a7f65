"""Classes whose messages stay encoded, for programs with other message classes.

A transport carries such a message without looking at its contents: encoding returns its bytes, and
decoding keeps them.
"""

from __future__ import annotations

from functools import cache
from typing import Any, ClassVar

__all__ = ["SerializedMessage", "serialized", "unserialized"]


class SerializedMessage:
    """A message in the encoding of ROS 2 (CDR with its header of 4 bytes); immutable by convention.

    Use the classes that `serialized` returns.

    Attributes:
        data: The encoded message.
    """

    __slots__ = ("data",)
    __ros_type__: ClassVar[str] = ""
    __ros_serialized__: ClassVar[Any] = None
    """The message class that this one stands for."""

    def __init__(self, data: bytes | bytearray | memoryview) -> None:
        self.data = data if type(data) is bytes else bytes(data)

    def __repr__(self) -> str:
        return f"<serialized {self.__ros_type__}: {len(self.data)} bytes>"


@cache
def serialized(cls: Any) -> Any:
    """Return the serialized counterpart of a message class, or of a service's two halves.

    Endpoints of the result communicate with those of `cls`: name, hash and description of the type
    are the same. The bytes are neither checked when sent nor when received.

    Raises:
        TypeError: `cls` is not a message or service class.
    """
    name = getattr(cls, "__ros_type__", None) if isinstance(cls, type) else None
    if not name:
        raise TypeError(f"{cls!r}: not a message or service class")
    members: dict[str, Any] = {"__slots__": (), "__ros_type__": name, "__ros_serialized__": cls}
    if hasattr(cls, "__ros_fields__"):
        return type(f"Serialized{cls.__name__}", (SerializedMessage,), members)
    if not hasattr(cls, "Request"):
        raise TypeError(f"{cls!r}: an action; serialize the services and messages of its .Impl")
    members["Request"] = serialized(cls.Request)
    members["Response"] = serialized(cls.Response)
    return type(f"Serialized{cls.__name__}", (), members)


def unserialized(cls: Any) -> Any:
    """Return the class that a serialized one stands for, or else `cls` itself."""
    return getattr(cls, "__ros_serialized__", None) or cls
