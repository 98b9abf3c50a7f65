"""Pieces of Python source in ruff's format."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator

__all__ = [
    "WIDTH",
    "class_line",
    "doc_lines",
    "import_lines",
    "import_order",
    "literal",
    "wrapped",
]

WIDTH = 100
"""Maximum line length; longer lines are wrapped where possible."""


def import_lines(module: str, names: Iterable[str]) -> Iterator[str]:
    """Yield one import, and one for each renamed name, in the order of isort."""
    renamed = sorted(name for name in names if " as " in name)
    usual = sorted(set(names) - set(renamed), key=lambda name: import_order(name, ignore_case=True))
    statements = [[name] for name in renamed] + [usual] * bool(usual)
    for imported in sorted(statements, key=first_of):
        line = f"from {module} import {', '.join(imported)}"
        if len(line) <= WIDTH:
            yield line
        else:
            yield from wrapped(f"from {module} import (", imported, ")")


def first_of(imported: list[str]) -> tuple[int, list[str | int]]:
    """Return isort's sort key for an import, by the name that its first one has in its module."""
    return import_order(imported[0].partition(" as ")[0], ignore_case=True)


def import_order(name: str, *, ignore_case: bool = False) -> tuple[int, list[str | int]]:
    """Return isort's sort key for a name: constants, classes, others; 8 before 16.

    Imports are sorted ignoring case, exports are not.
    """
    kind = 0 if name.isupper() and len(name) > 1 else 1 if name[0].isupper() else 2
    parts = re.findall(r"\d+|\D+", name.lower() if ignore_case else name)
    return kind, [int(part) if part.isdigit() else part for part in parts]


def wrapped(start: str, items: list[str], end: str, indent: str = "") -> list[str]:
    """Format a list of items as one line if it fits, else with one line per item."""
    line = f"{start}{', '.join(items)}{end}"
    if len(line) <= WIDTH:
        return [line]
    return [start, *(f"{indent}    {item}," for item in items), f"{indent}{end}"]


def class_line(name: str, bases: list[str], indent: str) -> list[str]:
    """Return the head of a class, as three lines if it is long."""
    line = f"{indent}class {name}({', '.join(bases)}):"
    if len(line) <= WIDTH:
        return [line]
    return [f"{indent}class {name}(", f"{indent}    {', '.join(bases)}", f"{indent}):"]


def doc_lines(text: str, indent: str) -> list[str]:
    """Return the lines of a docstring."""
    text = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    first, *more = text.split("\n")
    if not more and not first.endswith('"'):
        return [f'{indent}"""{first}"""']
    return [f'{indent}"""{first}', *(f"{indent}{line}".rstrip() for line in more), f'{indent}"""']


def literal(value: object) -> str:
    """Return a Python literal in ruff's format."""
    if isinstance(value, tuple):
        items = ", ".join(map(literal, value))
        return f"({items},)" if len(value) == 1 else f"({items})"
    if isinstance(value, float) and not math.isfinite(value):
        return f'float("{value}")'
    text = repr(value)
    if isinstance(value, str | bytes) and text.endswith("'") and '"' not in text:
        start = text.index("'")
        return f'{text[:start]}"{text[start + 1 : -1]}"'
    return text
