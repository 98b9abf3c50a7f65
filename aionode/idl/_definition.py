"""Parsed definitions, before type names in them are resolved."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from aionode.message import FieldType
from aionode.message.type_names import checked_type_name

__all__ = [
    "HALVES",
    "InterfaceText",
    "LineError",
    "MemberText",
    "MessageText",
    "TypeText",
    "split_type_name",
]

RECORDED_TYPE_NAME = re.compile(r"[A-Za-z]\w*/(msg|srv|action)/[A-Za-z]\w*", re.ASCII)
"""Names in recordings, whose spelling ROS 2 would not allow."""

HALVES: dict[str, tuple[str, ...]] = {
    "msg": ("",),
    "srv": ("Request", "Response"),
    "action": ("Goal", "Result", "Feedback"),
}
"""The nested messages of each kind of interface; that of a ``.msg`` has no name of its own."""


@dataclass(frozen=True, slots=True)
class TypeText:
    """The type of a field as written.

    Attributes:
        name: ``int32``, ``string``, ``Point`` or ``geometry_msgs/Point``.
        string_bound: As in `aionode.message.FieldType`, like the next two.
        container: Single value, array or sequence.
        size: Size or bound of the container.
    """

    name: str
    string_bound: int | None = None
    container: Literal["single", "array", "bounded", "unbounded"] = "single"
    size: int = 0

    def primitive(self) -> FieldType:
        """Return the type of a field that is not a message."""
        return FieldType(self.name, None, self.string_bound, self.container, self.size)


@dataclass(frozen=True, slots=True)
class MemberText:
    """A field or constant, with its position in the file.

    Attributes:
        type: Its type.
        name: Its name.
        value: The default of a field, or None; the value of a constant.
        constant: Whether it is a constant.
        line: Line number, from 1.
        column: Column of its name, from 1.
        comment: Its comment, on one line.
    """

    type: TypeText
    name: str
    value: object
    constant: bool
    line: int
    column: int
    comment: str = ""


@dataclass(frozen=True, slots=True)
class MessageText:
    """The members of one message, and the comment above them."""

    members: tuple[MemberText, ...]
    comment: str = ""

    def docstring(self, fallback: str) -> str:
        """Return the docstring of its class: its comment, or `fallback`, and those of its fields.

        `aionode.message.documentation` reads both from there.
        """
        said = [
            f"    {member.name}: {member.comment}"
            for member in self.members
            if member.comment and not member.constant
        ]
        text = self.comment or fallback
        return "\n".join([text, "", "Attributes:", *said]) if said else text


@dataclass(frozen=True, slots=True)
class InterfaceText:
    """A whole definition: its ROS name, its file, and its one, two or three messages."""

    typename: str
    file: str
    parts: tuple[MessageText, ...]


class LineError(Exception):
    """A definition cannot be parsed; has the problem and its offset in the line or text."""

    def __init__(self, offset: int, problem: str) -> None:
        self.offset = offset
        self.problem = problem
        super().__init__(problem)


def split_type_name(typename: str) -> tuple[str, str, str]:
    """Split an interface name into package, kind (``msg``, ``srv`` or ``action``) and name.

    Raises:
        TypeError: It is not a valid name of an interface.
    """
    if RECORDED_TYPE_NAME.fullmatch(typename) is None:
        checked_type_name(typename)
    package, kind, name = typename.split("/")
    return package, kind, name
