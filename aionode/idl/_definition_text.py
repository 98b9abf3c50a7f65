"""Formats the definition of a class as text."""

from __future__ import annotations

import itertools
import re
import textwrap
from collections.abc import Iterator
from typing import Literal, TypeAlias

from aionode.idl._definition import HALVES, split_type_name
from aionode.idl._folder import read
from aionode.idl._installed import installed_file
from aionode.idl.named import NAMED
from aionode.interfaces import shipped_packages
from aionode.message import (
    ActionType,
    Field,
    FieldType,
    Message,
    ServiceType,
    constants,
    documentation,
    fields,
    type_name,
)

__all__ = ["definition_text"]

WIDTH = 96
"""Maximum length of a comment line, in characters."""

STAND_IN = re.compile(
    r"The (request|response|goal|result|feedback) of \w+\.|\S+, as (in \S+|a node describes it)\."
)
"""The docstring of classes whose definition has no comment."""

OWN_COMMENTS = "# Comments: aionode's own; a sourced ROS 2 has those of its files.\n\n"
"""The header above comments that `ros2 interface show` does not print."""

CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]")


Comments: TypeAlias = Literal["none", "outer", "all"]
"""The comments to show: none, those of the type itself, or those of nested types as well."""


def definition_text(
    cls: type[Message | ServiceType | ActionType],
    *,
    nested: bool = False,
    comments: Comments = "none",
) -> str:
    """Return the text of a ``.msg``, ``.srv`` or ``.action`` file that defines `cls`.

    Args:
        cls: A message, service or action class.
        nested: Show the fields of nested messages below each field, indented by tabs, like ``ros2
            interface show``. Such text is for reading only and cannot be parsed.
        comments: Which comments to show: those in the sourced ROS 2's file of the type, or else
            those from the class's docstring. A line at the top says where those of a shipped type
            are from.

    Raises:
        TypeError: `cls` is not such a class, or has no ROS name.
    """
    package, kind, _ = split_type_name(type_name(cls))
    messages = [cls] if issubclass(cls, Message) else [getattr(cls, half) for half in HALVES[kind]]
    parts = source_parts(cls) if comments != "none" else None
    if parts is None:
        sections = [
            lines(message, package, nested=nested, comments=comments) for message in messages
        ]
        is_new = documentation(cls)[0] != documentation(messages[0])[0]
        if cls not in messages and comments != "none" and is_new:
            sections[0] = itertools.chain(summary(cls), sections[0])
    else:
        sections = [
            source_lines(part, message, nested=nested, comments=comments)
            for part, message in zip(parts, messages, strict=True)
        ]
    text = "---\n".join("".join(f"{line}\n" for line in part) for part in sections)
    is_own = parts is None and package in shipped_packages()
    return f"{OWN_COMMENTS}{text}" if is_own and "# " in text else text


def lines(
    cls: type[Message], package: str, *, nested: bool, comments: Comments = "none"
) -> Iterator[str]:
    """Yield the lines of one message, constants first."""
    described = {}
    if comments != "none":
        described = documentation(cls)[1]
        yield from summary(cls, alone=not fields(cls) and not constants(cls))
    for constant in constants(cls):
        yield f"{constant.type} {constant.name}={literal(constant.type, constant.value)}"
    for field in fields(cls):
        yield from comment(described.get(field.name, ""))
        default = "" if field.default is None else f" {default_text(field)}"
        yield f"{type_text(field.type, package)} {field.name}{default}"
        if nested:
            yield from nested_lines(field, comments)


def summary(cls: type[Message | ServiceType | ActionType], *, alone: bool = False) -> Iterator[str]:
    """Yield the docstring of a class, followed by an empty line unless it is `alone`.

    Standard types state their units there: "A point in space: coordinates in m."
    """
    text = documentation(cls)[0]
    if text and STAND_IN.fullmatch(text) is None:
        yield from comment(text)
        if not alone:
            yield ""


def comment(text: str) -> Iterator[str]:
    """Yield docstring text as comment lines."""
    for line in textwrap.wrap(text.replace("``", "`"), WIDTH):
        yield f"# {line}"


def nested_lines(field: Field, comments: Comments) -> Iterator[str]:
    """Yield the fields of the message in a field, indented."""
    cls = field.type.nested
    if cls is None:
        return
    inner: Comments = "all" if comments == "all" else "none"
    parts = source_parts(cls) if inner == "all" else None
    if parts is not None:
        nested_lines = source_lines(parts[0], cls, nested=True, comments=inner)
    else:
        package = split_type_name(type_name(cls))[0]
        nested_lines = lines(cls, package, nested=True, comments=inner)
    for line in nested_lines:
        yield f"\t{line}" if line else ""


def source_parts(cls: type[Message | ServiceType | ActionType]) -> list[list[str]] | None:
    """Return the lines of the file that defines a class, split into parts; None without a file."""
    typename = type_name(cls)
    file = NAMED.file_of(typename, cls) or installed_file(typename)
    if file is None or file.suffix == ".idl":  # which has another format
        return None
    parts: list[list[str]] = [[]]
    for line in read(file).splitlines():
        if line.strip() == "---":
            parts.append([])
        else:
            parts[-1].append(line)
    return parts


def source_lines(
    part: list[str], cls: type[Message], *, nested: bool, comments: Comments
) -> Iterator[str]:
    """Yield the lines of a file, each field followed by those of its nested message."""
    by_name = {field.name: field for field in fields(cls)}
    for line in part:
        yield line
        words = line.partition("#")[0].split()
        field = by_name.get(words[1]) if len(words) > 1 else None
        if nested and field is not None:
            yield from nested_lines(field, comments)


def type_text(type_: FieldType, package: str) -> str:
    """Return a type as written in a definition of `package`."""
    return str(type_).removeprefix(f"{package}/") if type_.nested else str(type_)


def default_text(field: Field) -> str:
    """Return the default of a field."""
    if isinstance(field.default, tuple):
        unit = FieldType("uint8") if field.type.kind == "byte" else field.type.element
        return f"[{', '.join(literal(unit, item) for item in field.default)}]"
    return literal(field.type, field.default)


def literal(type_: FieldType, value: object) -> str:
    """Return a single value."""
    if isinstance(value, bytes):
        return str(value[0])
    if isinstance(value, str):
        return quoted(value)
    return str(value).lower() if type_.kind == "bool" else repr(value)


def quoted(text: str) -> str:
    """Return a string in double quotes, on one line."""
    text = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + CONTROL.sub(lambda match: f"\\u{ord(match[0]):04x}", text) + '"'
