"""Units of fields, as far as the comments of a definition state them."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from aionode.message._schema import documentation

if TYPE_CHECKING:
    from aionode.message._message import Message

__all__ = ["units"]

REALS: Final = ("float32", "float64")

WORDS: Final = {
    "millimeter": "mm",
    "centimeter": "cm",
    "kilometer": "km",
    "meter": "m",
    "metre": "m",
    "nanosecond": "ns",
    "microsecond": "µs",
    "millisecond": "ms",
    "second": "s",
    "sec": "s",
    "minute": "min",
    "hour": "h",
    "radian": "rad",
    "degree": "°",
    "deg": "°",
    "degrees celsius": "°C",
    "celsius": "°C",
    "kelvin": "K",
    "hertz": "Hz",
    "volt": "V",
    "ampere": "A",
    "amp": "A",
    "watt": "W",
    "ohm": "Ω",
    "newton": "N",
    "pascal": "Pa",
    "tesla": "T",
    "lux": "lx",
    "gram": "g",
    "kilogram": "kg",
    "percent": "%",
    "pixel": "px",
    "byte": "B",
}
"""The symbols of units that comments write as words, without the s of a plural."""

SYMBOL: Final = (
    r"(?:[nµumckM]?(?:m|s|g|Hz|V|A|Ah|W|Wh|N|Pa|T|J|Ω)|rad|°C|°|K|%|lx|px|dB|min|h|rpm)"
    r"(?:[²³]|\^-?\d)?"
)

WORD: Final = rf"(?:{'|'.join(sorted(WORDS, key=len, reverse=True))})s?"

ONE: Final = rf"(?:(?i:{WORD})|{SYMBOL})"
EACH: Final = rf"(?:\({ONE}(?:[/·*]{ONE})*\)(?:[²³]|\^\d)|{ONE})"
UNIT: Final = rf"{EACH}(?:(?: per |[/·*]){EACH})*"

SAID: Final = rf"(?:\b[Ii]n +|(?<!\w)[\[(])({UNIT})(?![\w/²³^·])(?= and ({UNIT})\b)?"
"""A unit as comments give it: ``in m/s``, ``[rad]`` or ``(meters)``; a second one after ``and``."""


@cache
def units(cls: type[Message]) -> dict[str, str]:
    """Return the units of the fields of a message class, as far as its comments state them.

    The key ``""`` has the unit of all fields, as of those of a Point. A comment that names several
    units says nothing.
    """
    text, described = documentation(cls)
    fields = cls.__ros_fields__
    whole = unit_of(text)
    if whole and not described and all(field.type.kind in REALS for field in fields):
        return {"": whole}
    return {
        field.name: unit for field in fields if (unit := unit_of(described.get(field.name, "")))
    }


def unit_of(text: str) -> str | None:
    """Return the only unit that a text names; None if there is none, or more than one."""
    named: set[Any] = {part for said in re.finditer(SAID, text) for part in said.groups() if part}
    symbols = {symbol(part) for part in named}
    return symbols.pop() if len(symbols) == 1 else None


def symbol(text: str) -> str:
    """Return a unit by its symbols: ``meters per second`` is ``m/s``."""
    parts = re.split(r"( per |[/·*()])", text)
    names = (WORDS.get(part.lower()) or WORDS.get(part.lower().removesuffix("s")) for part in parts)
    joined = "".join(name or part for name, part in zip(names, parts, strict=True))
    return joined.replace(" per ", "/").replace("^2", "²").replace("^3", "³")
