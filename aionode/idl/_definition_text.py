"""Writes the definition of a class as text."""

from __future__ import annotations

import re
from collections.abc import Iterator

from aionode.idl._definition import HALVES, split_type_name
from aionode.message import (
    ActionType,
    Field,
    FieldType,
    Message,
    ServiceType,
    constants,
    fields,
    type_name,
)

__all__ = ["definition_text"]

CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]")


def definition_text(cls: type[Message | ServiceType | ActionType], *, nested: bool = False) -> str:
    """Return the text of a ``.msg``, ``.srv`` or ``.action`` file that defines `cls`.

    Args:
        cls: A message, service or action class.
        nested: Show the fields of nested messages below each field, indented by tabs, as
            ``ros2 interface show`` does. Such text is for reading only and cannot be parsed.

    Raises:
        TypeError: `cls` is not such a class, or has no ROS name.
    """
    package, kind, _ = split_type_name(type_name(cls))
    messages = [cls] if issubclass(cls, Message) else [getattr(cls, half) for half in HALVES[kind]]
    parts = ("".join(f"{line}\n" for line in lines(m, package, nested=nested)) for m in messages)
    return "---\n".join(parts)


def lines(cls: type[Message], package: str, *, nested: bool) -> Iterator[str]:
    """Yield the lines of one message, constants first."""
    for constant in constants(cls):
        yield f"{constant.type} {constant.name}={literal(constant.type, constant.value)}"
    for field in fields(cls):
        default = "" if field.default is None else f" {default_text(field)}"
        yield f"{type_text(field.type, package)} {field.name}{default}"
        if nested and field.type.nested is not None:
            inside = split_type_name(type_name(field.type.nested))[0]
            for line in lines(field.type.nested, inside, nested=True):
                yield f"\t{line}"


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
