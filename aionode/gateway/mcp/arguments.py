"""The arguments of tools: their schemas, and what a model reads of one that does not fit."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from typing import Any, Final, TypeVar

import msgspec

from aionode.errors import MessageError

__all__ = ["Arguments", "Nothing", "fitting", "meant", "schema_of"]

ArgumentsT = TypeVar("ArgumentsT", bound="Arguments")

MOST_NAMED: Final = 10
"""Names that an error lists, where none is similar to what was given."""


class Arguments(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The arguments of a tool; one that it does not have is an error."""


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
    """Return the arguments of a call.

    Raises:
        MessageError: one of them does not fit, is missing or unknown.
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
        fits = f"; one of {', '.join(choices)} fits" if choices else ""
        raise MessageError(path, f"{problem}{fits}") from None


def meant(name: object, known: Iterable[str]) -> str:
    """Return what a name may have been meant for, or what there is, as the end of an error."""
    names = list(known)
    close = difflib.get_close_matches(str(name), names, 3)
    if close:
        return f"; did you mean {' or '.join(close)}?"
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return f"; there is {', '.join(names[:MOST_NAMED])}{more}" if names else "; there is none"
