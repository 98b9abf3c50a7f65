"""The base of buffers and clients of buffers, and the types that can be transformed."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any

from geometry_msgs.msg import TransformStamped

from rclpy.duration import Duration
from rosidl_generator_py import message_class

__all__ = [
    "BufferInterface",
    "ConvertRegistration",
    "NotImplementedException",
    "Stamped",
    "TransformRegistration",
    "TransformStamped",
    "TypeException",
    "convert",
]

NOW = Duration()
"""The time limit of those who do not wait."""


class TypeException(Exception):  # noqa: N818  # tf2's name
    """No function is registered for a type."""

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(Exception):  # noqa: N818  # tf2's name
    """A subclass of `BufferInterface` lacks a method."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class TransformRegistration:
    """The functions that express objects in another frame, by type; one table for all."""

    __type_map: dict[Any, Callable[[Any, Any], Any]] = {}  # noqa: RUF012  # one for all

    def print_me(self) -> None:
        """Print the table."""
        print(TransformRegistration.__type_map)  # noqa: T201  # as tf2_ros does

    def add(self, key: Any, callback: Callable[[Any, Any], Any]) -> None:
        """Register a function: (object, transform) -> object."""
        TransformRegistration.__type_map[key] = callback

    def get(self, key: Any) -> Callable[[Any, Any], Any]:
        """Return the function for a type.

        Raises:
            TypeException: there is none.
        """
        return entry_of(TransformRegistration.__type_map, key)


class ConvertRegistration:
    """The functions that convert between types; one table for all."""

    __to_msg_map: dict[Any, Callable[[Any], Any]] = {}  # noqa: RUF012  # one for all
    __from_msg_map: dict[Any, Callable[[Any], Any]] = {}  # noqa: RUF012  # one for all
    __convert_map: dict[Any, Callable[[Any], Any]] = {}  # noqa: RUF012  # one for all

    def add_from_msg(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Register a function that converts a message to an object."""
        ConvertRegistration.__from_msg_map[key] = callback

    def add_to_msg(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Register a function that converts an object to a message."""
        ConvertRegistration.__to_msg_map[key] = callback

    def add_convert(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Register a function that converts an object of one type to another."""
        ConvertRegistration.__convert_map[key] = callback

    def get_from_msg(self, key: Any) -> Callable[[Any], Any]:
        """Return the function that converts a message; raise TypeException if there is none."""
        return entry_of(ConvertRegistration.__from_msg_map, key)

    def get_to_msg(self, key: Any) -> Callable[[Any], Any]:
        """Return the function that converts to a message; raise TypeException if there is none."""
        return entry_of(ConvertRegistration.__to_msg_map, key)

    def get_convert(self, key: Any) -> Callable[[Any], Any]:
        """Return the function that converts between two types; TypeException if there is none."""
        return entry_of(ConvertRegistration.__convert_map, key)


def entry_of(table: dict[Any, Callable[..., Any]], key: Any) -> Callable[..., Any]:
    """Return an entry of a table; raise TypeException if there is none."""
    if key not in table:
        raise TypeException(f"Type {key} is not loaded or supported")
    return table[key]


def convert(a: Any, b_type: Any) -> Any:
    """Convert an object to another type."""
    registration = ConvertRegistration()
    try:
        direct = registration.get_convert((type(a), b_type))
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
        return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))
    return direct(a)


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:  # tf2's name
    """Give an object a header, and return it."""
    obj.header = message_class("std_msgs/msg/Header")(frame_id=frame_id, stamp=stamp)
    return obj


class BufferInterface:
    """Looks transforms up, in a place defined by the subclass."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration = NOW, new_type: Any = None
    ) -> Any:
        """Return an object with a header in another frame."""
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        by = self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout)
        res = do_transform(object_stamped, by)
        return res if new_type is None else convert(res, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Duration = NOW,
        new_type: Any = None,
    ) -> Any:
        """Return an object with a header in another frame at another time."""
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        by = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout
        )
        res = do_transform(object_stamped, by)
        return res if new_type is None else convert(res, new_type)

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Any, timeout: Duration = NOW
    ) -> Any:
        """Return the transform between two frames."""
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> Any:
        """Return the transform between two frames at two times."""
        raise NotImplementedException

    def can_transform(
        self, target_frame: str, source_frame: str, time: Any, timeout: Duration = NOW
    ) -> Any:
        """Return whether a transform is available."""
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> Any:
        """Return whether a transform between two times is available."""
        raise NotImplementedException
