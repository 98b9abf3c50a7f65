"""The approximate memory of messages, for the byte limits of queues."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from aionode.message._message import fields

if TYPE_CHECKING:
    from aionode.message._field_types import FieldType

__all__ = ["memory_size"]

OBJECT_BYTES: Final = 100
"""The approximate size of a Python object: a message, a string or an array."""

NUMBER_BYTES: Final = 8
"""The maximum size of a number in an array."""

Size: TypeAlias = Callable[[Any], int]


@cache
def memory_size(cls: Any) -> Size | None:
    """Return a function that estimates how many bytes a message of a class takes.

    Returns None if all take about the same, as no field has a variable size. The function looks
    only at lengths, except inside sequences of messages whose own size varies.
    """
    parts = [part for field in fields(cls) if (part := size_of_field(field.name, field.type))]
    if not parts:
        return None
    fixed_bytes = fixed_size(cls)
    if len(parts) == 1:
        (only,) = parts
        return lambda msg: fixed_bytes + only(msg)
    return lambda msg: fixed_bytes + sum([part(msg) for part in parts])


def size_of_field(name: str, kind: FieldType) -> Size | None:
    """Return a function for the variable size of a field; None if it has a fixed size."""
    value = attrgetter(name)
    if kind.container == "single":
        if kind.nested is None:
            return (lambda msg: value(msg).__sizeof__()) if kind.kind in TEXTS else None
        of_message = memory_size(kind.nested)
        return None if of_message is None else lambda msg: of_message(value(msg))
    if kind.nested is not None:
        of_element = memory_size(kind.nested)
        if of_element is not None:
            return lambda msg: sum(map(of_element, value(msg)))
        element_bytes = fixed_size(kind.nested)
    elif kind.kind in TEXTS:
        return lambda msg: sum([text.__sizeof__() for text in value(msg)])
    else:
        element_bytes = 1 if kind.form == "bytes" or kind.kind == "uint8" else NUMBER_BYTES
    return None if kind.container == "array" else lambda msg: element_bytes * len(value(msg))


@cache
def fixed_size(cls: Any) -> int:
    """Estimate the fixed part of a message's size."""
    return OBJECT_BYTES + sum(
        max(field.type.size if field.type.container == "array" else 1, 1)
        * (NUMBER_BYTES if field.type.nested is None else fixed_size(field.type.nested))
        for field in fields(cls)
        if field.type.container in ("single", "array")
    )


TEXTS: Final = ("string", "wstring")
