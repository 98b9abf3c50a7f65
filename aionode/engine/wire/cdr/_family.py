"""Families of message classes: aionode's own, and other classes for the same ROS types."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from msgspec import Struct

from aionode.message import Message

__all__ = ["OWN", "PLAIN", "MessageFamily"]


class MessageFamily(Struct, frozen=True, eq=False):
    """Other Python classes for the messages described by aionode's classes.

    The codec takes the names and types of the fields from aionode's class, and reads and creates
    objects of the family's class.

    Attributes:
        class_of: Returns the family's class for an aionode class.
        constructor: Returns the function that creates an object of the family's class for an
            aionode class. It is called with the values of all fields, in order and in the form
            produced by `decode`: arrays and sequences of bytes are views of the data.
        adopt: Returns an object of the family as an aionode message. It is called for values in an
            unusual form; aionode's errors are raised for what aionode cannot encode either.
        prefix: The prefix of a field's name in the name of its attribute.
        has_arrays: Whether sequences of numbers are decoded to arrays of numpy, and not to
            memoryviews of their numbers.
    """

    class_of: Callable[[type[Message]], type[Any]]
    constructor: Callable[[type[Message]], Callable[..., Any]]
    adopt: Callable[[Any], Message]
    prefix: str = ""
    has_arrays: bool = True


def itself(value: Any) -> Any:
    """Return the value unchanged."""
    return value


OWN: Final = MessageFamily(itself, itself, itself)
"""aionode's own classes."""

PLAIN: Final = MessageFamily(itself, itself, itself, has_arrays=False)
"""aionode's own classes, with memoryviews in place of the arrays of sequences."""
