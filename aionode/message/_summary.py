"""Summaries of messages: bounded in bytes, for people and agents."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from msgspec import Struct

from aionode.message._message import Message
from aionode.message._snapshot import snapshot
from aionode.message._units import units
from aionode.message.conversion import json_float

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy as np

    from aionode.message._field_types import FieldType

__all__ = ["summarize"]

MIN_BYTES: Final = 64
"""The least limit: what says that there is no room has to fit."""

HEAD: Final = 8
"""Elements that are shown of an array with more than are shown whole."""

PIECES: Final = 2000
"""Maximum values to visit before a shorter form is tried."""


class TooLongError(Exception):
    """A form of a summary has more values than could fit."""


class Detail(Struct):
    """How much of a message is shown.

    Attributes:
        elements: Maximum elements of an array that is shown whole.
        characters: Maximum characters of a string that is shown whole.
        left: The number of values for which there is still room.
    """

    elements: int
    characters: int
    left: int = PIECES

    def take(self) -> None:
        """Count one value.

        Raises:
            TooLongError: there are too many.
        """
        self.left -= 1
        if self.left < 0:
            raise TooLongError


DETAILS: Final = ((64, 1000), (16, 400), (8, 200), (4, 80), (2, 40), (1, 20), (0, 10))
"""The elements and characters of each form, the longest first."""


def summarize(msg: Message, limit: int = 4000) -> dict[str, Any]:
    """Return what is in a message, small enough to be read by people and language models.

    The result has builtin types only, and as JSON in UTF-8 at most `limit` bytes. ``type`` is the
    name of the type, and ``value`` has the fields by name, as `to_builtins` has them, but

    - a long array is a dict of its ``shape``, its ``dtype`` (or the ``type`` of its messages), the
      ``min`` and ``max`` of its finite numbers, and its first elements as ``head``;
    - a long string ends in ``...`` and how many characters it has;
    - a float32 has its seven digits, and NaN and the infinities are strings, as in JSON.

    ``units`` has the units by path, such as ``{"angular_velocity": "rad/s"}``, as far as the
    comments of the definitions tell them; ``points[].x`` is a field of each element. If fields have
    no room at all, ``left_out`` has how many.

    Args:
        msg: The message.
        limit: The most bytes, at least 64.

    Raises:
        MessageError: A value does not fit its field.
        ValueError: `limit` is less than 64.
    """
    if limit < MIN_BYTES:
        raise ValueError(f"limit: {limit} bytes given; a summary needs at least {MIN_BYTES}")
    msg = snapshot(msg)
    name = named(msg.__class__)
    for elements, characters in DETAILS:
        detail = Detail(elements, characters, min(PIECES, limit))
        try:
            value = summary_of(msg, detail)
        except TooLongError:
            continue
        for notes in ({"units": units_within(msg, value)}, {}):
            summary = {"type": name, "value": value, **{k: v for k, v in notes.items() if v}}
            if size(summary) <= limit:
                return summary
    return what_fits(msg, name, limit)


def named(cls: type[Message]) -> str:
    """Return the name of a type, as far as it has one in ROS."""
    return cls.__ros_type__ or cls.__qualname__


def what_fits(msg: Message, name: str, limit: int) -> dict[str, Any]:
    """Return a summary of the first fields that have room, each in its shortest form."""
    summary: dict[str, Any] = {"type": name, "value": {}, "left_out": len(msg.__ros_fields__)}
    if size(summary) > limit:
        return {"left_out": len(msg.__ros_fields__)}
    for field in msg.__ros_fields__:
        detail = Detail(*DETAILS[-1], limit)
        try:
            value = summarized(field.type, getattr(msg, field.name), detail)
        except TooLongError:
            continue
        summary["value"][field.name] = value
        summary["left_out"] -= 1
        if size(summary) > limit:
            del summary["value"][field.name]
            summary["left_out"] += 1
    return summary


def size(summary: dict[str, Any]) -> int:
    """Return the bytes of a summary as `json.dumps` writes it."""
    import json  # few programs need it

    return len(json.dumps(summary, ensure_ascii=False).encode())


def summary_of(message: Message, detail: Detail) -> dict[str, Any]:
    """Return the summarized fields of a message."""
    return {
        field.name: summarized(field.type, getattr(message, field.name), detail)
        for field in message.__ros_fields__
    }


def summarized(type_: FieldType, value: Any, detail: Detail) -> object:
    """Return the summary of a field's value."""
    if type_.container == "single":
        return single(type_, value, detail)
    element = type_.element
    if len(value) <= detail.elements:
        return [single(element, item, detail) for item in elements(type_, value)]
    described: dict[str, Any] = {"shape": [len(value)]}
    if type_.nested is None:
        described["dtype"] = "uint8" if type_.form == "bytes" else type_.kind
    else:
        described["type"] = named(type_.nested)
    if type_.form == "ndarray" and type_.kind != "bool":
        described |= {
            name: single(element, extreme, detail) for name, extreme in extremes(value).items()
        }
    head = elements(type_, value[: min(HEAD, detail.elements)])
    described["head"] = [single(element, item, detail) for item in head]
    return described


def elements(type_: FieldType, value: Any) -> Iterable[Any]:
    """Return the elements of an array as Python's own values; those of bytes as numbers."""
    if type_.form == "ndarray":
        return value.tolist()  # type: ignore[no-any-return] # a list
    return [bytes((number,)) for number in value] if type_.kind == "byte" else value


def extremes(values: np.ndarray[Any, Any]) -> dict[str, Any]:
    """Return the least and greatest finite number of an array; nothing if it has none."""
    import numpy as np

    finite = values[np.isfinite(values)]
    return {"min": finite.min().item(), "max": finite.max().item()} if finite.size else {}


def single(type_: FieldType, value: Any, detail: Detail) -> object:
    """Return the summary of a single value."""
    detail.take()
    if type_.nested is not None:
        return summary_of(value, detail)
    if type_.kind == "float32":
        return json_float(float(f"{value:.7g}"))
    if type_.kind == "float64":
        return json_float(value)
    if type_.kind == "byte":
        return value[0]
    if type_.kind in {"string", "wstring"} and len(value) > detail.characters:
        return f"{value[: detail.characters]}... ({len(value)} characters)"
    return value


def units_within(message: Message, shown: Any) -> dict[str, str]:
    """Return the units of what is shown of a message, by path."""
    found = dict(units(message.__class__))
    for field in message.__ros_fields__:
        if field.type.nested is None:
            continue
        path, inner, value = field.name, shown[field.name], getattr(message, field.name)
        if field.type.container != "single":
            inner = inner["head"] if isinstance(inner, dict) else inner
            if not inner:
                continue
            path, inner, value = f"{path}[]", inner[0], value[0]
        for name, unit in units_within(value, inner).items():
            found.pop(field.name, None)  # what it says of its own fields is more exact
            found[f"{path}.{name}" if name else path] = unit
    return found
