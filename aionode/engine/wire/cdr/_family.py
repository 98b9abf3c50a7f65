"""Families of classes that hold messages: aionode's own, and others for the same ROS types."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from aionode.message import Message

__all__ = ["OWN", "MessageFamily"]


@dataclass(frozen=True, eq=False, slots=True)
class MessageFamily:
    """Other Python classes for the messages that aionode's classes describe.

    The codec takes names and types of the fields from aionode's class, and reads and makes objects
    of the family's class.

    Attributes:
        class_of: Returns the family's class for a class of aionode.
        constructor: Returns what makes an object of the family's class for a class of aionode. It
            is called with the values of all fields, in their order and in the form in which
            `decode` gives them: arrays and sequences of bytes are views of the data.
        adopt: Returns an object of the family as a message of aionode. It is called for values in
            an unusual form; what aionode cannot encode either is refused with aionode's errors.
        prefix: What stands before the name of a field in the name of its attribute.
    """

    class_of: Callable[[type[Message]], type[Any]]
    constructor: Callable[[type[Message]], Callable[..., Any]]
    adopt: Callable[[Any], Message]
    prefix: str = ""


def itself(value: Any) -> Any:
    """Return the value."""
    return value


OWN: Final = MessageFamily(itself, itself, itself)
"""aionode's own classes."""
