"""What a definition says, before the types it names are known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from aionode.message import FieldType
from aionode.message._message import checked_type_name

__all__ = ["HALVES", "InterfaceText", "MemberText", "MessageText", "TypeText", "split_type_name"]

HALVES: dict[str, tuple[str, ...]] = {
    "msg": ("",),
    "srv": ("Request", "Response"),
    "action": ("Goal", "Result", "Feedback"),
}
"""The messages of each kind of interface; that of a ``.msg`` has no name of its own."""


@dataclass(frozen=True, slots=True)
class TypeText:
    """The type of a field as written.

    Attributes:
        name: ``int32``, ``string``, ``Point`` or ``geometry_msgs/Point``.
        string_bound: As in `aionode.message.FieldType`, like the others.
        container: One value, an array or a sequence.
        size: Size or bound of the container.
    """

    name: str
    string_bound: int | None = None
    container: Literal["single", "array", "bounded", "unbounded"] = "single"
    size: int = 0

    def primitive(self) -> FieldType:
        """Return the type, if it is not a message."""
        return FieldType(self.name, None, self.string_bound, self.container, self.size)


@dataclass(frozen=True, slots=True)
class MemberText:
    """A field, or a constant: its type, name, value and place in the file.

    Attributes:
        type: Its type.
        name: Its name.
        value: The default of a field, or None; the value of a constant.
        constant: Whether it is a constant.
        line: Number of its line, from 1.
        column: Number of its first character, from 1.
    """

    type: TypeText
    name: str
    value: object
    constant: bool
    line: int
    column: int


@dataclass(frozen=True, slots=True)
class MessageText:
    """The members of one message, and the comment above them."""

    members: tuple[MemberText, ...]
    comment: str = ""


@dataclass(frozen=True, slots=True)
class InterfaceText:
    """A whole definition: its ROS name, where it is from, and its one, two or three messages."""

    typename: str
    file: str
    parts: tuple[MessageText, ...]


def split_type_name(typename: str) -> tuple[str, str, str]:
    """Return package, kind (``msg``, ``srv`` or ``action``) and name of an interface.

    Raises:
        TypeError: It is not the name of one.
    """
    package, kind, name = checked_type_name(typename).split("/")
    return package, kind, name
