"""Resolving a field path of a message, such as ``poses[3].position``."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from aionode.errors import CommandError
from aionode.message import Message, fields, type_name

if TYPE_CHECKING:
    from aionode.message import FieldType

__all__ = ["field_of"]

FIELD_PART = re.compile(r"([A-Za-z_][A-Za-z0-9_]*)((?:\[[0-9]{1,18}\])*)")


def field_of(msg: Message, path: str) -> tuple[Any, FieldType | None]:
    """Return the value of a field such as ``pose.position`` or ``poses[0]``, and its type.

    Raises:
        CommandError: there is no such field or index.
    """
    value: Any = msg
    type_: FieldType | None = None
    for part in filter(None, path.split(".")):
        match = FIELD_PART.fullmatch(part)
        types = {f.name: f.type for f in fields(type(value))} if isinstance(value, Message) else {}
        if match is None or match[1] not in types:
            where = type_name(type(value)) if isinstance(value, Message) else "a single value"
            has = f" has {', '.join(types)}" if types else " has no fields"
            raise CommandError(f"Invalid field '{path}': no '{part}' in it; {where}{has}")
        value, type_ = getattr(value, match[1]), types[match[1]]
        for index in map(int, re.findall(r"[0-9]+", match[2])):
            if type_.container == "single" or index >= len(value):
                problem = f"nothing at [{index}] of {match[1]}, which is {type_}"
                raise CommandError(f"Invalid field '{path}': {problem}")
            value, type_ = value[index], type_.element
            value = value.item() if hasattr(value, "item") else value
    return value, type_
