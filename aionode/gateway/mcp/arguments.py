"""The arguments of tools: their schemas, and errors that tell a model how to correct them."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from typing import Any, Final, TypeVar

import msgspec

from aionode.errors import MessageError

__all__ = ["Arguments", "Nothing", "fitting", "meant", "schema_of"]

ArgumentsT = TypeVar("ArgumentsT", bound="Arguments")

MAX_NAMED: Final = 10
"""Number of names listed by an error if none is similar to the given one."""


class Arguments(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The arguments of a tool; unknown arguments are an error."""


class Nothing(Arguments, frozen=True):
    """No arguments."""


def schema_of(cls: type[Arguments]) -> dict[str, Any]:
    """Return the JSON Schema of the arguments of a tool, without references."""
    _, components = msgspec.json.schema_components((cls,))
    schema = dict(components[cls.__name__])
    schema.pop("title", None)
    schema.pop("description", None)
    return schema


def fitting(cls: type[ArgumentsT], values: Mapping[str, Any]) -> ArgumentsT:
    """Convert the arguments of a call.

    Raises:
        MessageError: one of them is invalid, missing or unknown.
    """
    unknown = [name for name in values if name not in cls.__struct_fields__]
    if unknown:
        raise MessageError(
            str(unknown[0]), f"no such argument{meant(unknown[0], cls.__struct_fields__)}"
        )
    try:
        return msgspec.convert(dict(values), cls)
    except msgspec.ValidationError as error:
        problem, _, place = str(error).partition(" - at ")
        path = re.sub(r"^`\$\.?|`$", "", place) or "arguments"
        choices = schema_of(cls)["properties"].get(path, {}).get("enum")
        fits = f"; use one of {', '.join(choices)}" if choices else ""
        raise MessageError(path, f"{problem}{fits}") from None


def meant(name: object, known: Iterable[str]) -> str:
    """Return the end of an error about an unknown name: similar names, or those that exist."""
    names = list(known)
    close = difflib.get_close_matches(str(name), names, 3)
    if close:
        return f"; did you mean {' or '.join(close)}?"
    more = f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else ""
    return f"; use one of {', '.join(names[:MAX_NAMED])}{more}" if names else "; there are none"
