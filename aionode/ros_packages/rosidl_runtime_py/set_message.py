"""Filling messages with values from dictionaries."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from rosidl_parser.definition import AbstractNestedType, NamespacedType
from rosidl_runtime_py.convert import get_message_slot_types
from rosidl_runtime_py.import_message import import_message_from_namespaced_type

__all__ = ["set_message_fields"]

HEADER = "std_msgs.msg._header.Header"

TIME = "builtin_interfaces.msg._time.Time"


def set_message_fields(
    msg: Any,
    values: dict[str, Any],
    expand_header_auto: bool = False,
    expand_time_now: bool = False,
) -> list[Callable[[Any], None]]:
    """Set fields of a message, and return the setters for those that stand for the current time.

    Args:
        msg: The message.
        values: New values, by the names of the fields.
        expand_header_auto: A header may be ``auto``: its stamp is one of the fields returned.
        expand_time_now: A time may be ``now``: it is one of the fields returned.

    Raises:
        AttributeError: The message has no such field.
        TypeError: A value is not of the type of its field.
    """
    filling = Filling(expand_header_auto, expand_time_now)
    filling.fill(msg, values)
    return filling.times


@dataclass
class Filling:
    """Fills one message, and those nested in it."""

    expand_header_auto: bool
    expand_time_now: bool
    times: list[Callable[[Any], None]] = field(default_factory=list)
    """Setters of the fields that stand for the current time."""

    def fill(self, msg: Any, values: Any) -> None:
        """Set fields of a message."""
        if not hasattr(values, "items"):
            raise TypeError(
                f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}"
            )
        for name, value in values.items():
            before = getattr(msg, name)
            kind = f"{type(before).__module__}.{type(before).__name__}"
            if self.expand_header_auto and (kind, value) == (HEADER, "auto"):
                self.times.append(partial(setattr, before, "stamp"))
            elif self.expand_time_now and (kind, value) == (TIME, "now"):
                self.times.append(partial(setattr, msg, name))
            else:
                setattr(msg, name, self.converted(get_message_slot_types(msg)[name], before, value))

    def converted(self, type_: Any, before: Any, value: Any) -> Any:
        """Return the new value of a field of this type."""
        if isinstance(before, array):
            return array(before.typecode, value)
        if isinstance(before, np.ndarray):
            return np.array(value, dtype=before.dtype)
        if isinstance(type_, AbstractNestedType) and isinstance(type_.value_type, NamespacedType):
            cls = import_message_from_namespaced_type(type_.value_type)
            return [self.filled(cls, element) for element in value]
        if type(value) is type(before):
            return value
        try:
            return type(before)(value)
        except TypeError:
            return self.filled(type(before), value)

    def filled(self, cls: Any, value: Any) -> Any:
        """Return a new message with these values."""
        message = cls()
        self.fill(message, value)
        return message
