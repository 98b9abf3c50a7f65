"""Sizes, alignments and runs of packed values of XCDR1.

Sizes and alignments of XCDR1, the form in which ROS 2 writes messages.

A value is aligned to its own size, counted from the end of the four bytes that open every message.
Only values are aligned, not structures: where a structure starts depends on its first field alone.
Offsets in this package count those four bytes too, so they are places in the data as it is sent.

Runs of values of fixed size, packed in one step wherever they start.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, TypeAlias

from aionode.message import fields

if TYPE_CHECKING:
    from aionode.message import FieldType

__all__ = [
    "COUNT_SIZE",
    "HEADER",
    "PHASES",
    "PRIMITIVES",
    "TEXT",
    "Item",
    "Pack",
    "Primitive",
    "TextPacking",
    "first_alignment",
    "has_views",
    "is_small",
    "lay_out",
    "minimum_size",
    "modulus_of",
    "padding",
    "phase_structs",
    "uniform_alignment",
]

HEADER = b"\x00\x01\x00\x00"
"""What opens a message: CDR, little endian, no options."""

COUNT_SIZE = 4
"""Bytes of the uint32 that opens strings and sequences."""

MOST_LEAVES = 64

DEEPEST = 16


@dataclass(frozen=True, slots=True)
class Primitive:
    """How one value of a primitive kind is written.

    Attributes:
        code: Its letter for `struct`.
        size: Bytes on the wire, which is also its alignment.
        dtype: Its numpy type without byte order.
    """

    code: str
    size: int
    dtype: str


PRIMITIVES = {
    "int8": Primitive("b", 1, "i1"),
    "uint8": Primitive("B", 1, "u1"),
    "int16": Primitive("h", 2, "i2"),
    "uint16": Primitive("H", 2, "u2"),
    "int32": Primitive("i", 4, "i4"),
    "uint32": Primitive("I", 4, "u4"),
    "int64": Primitive("q", 8, "i8"),
    "uint64": Primitive("Q", 8, "u8"),
    "float32": Primitive("f", 4, "f4"),
    "float64": Primitive("d", 8, "f8"),
    "bool": Primitive("?", 1, "b1"),
    "byte": Primitive("c", 1, "u1"),
    "char": Primitive("B", 1, "u1"),
}


def padding(offset: int, alignment: int) -> int:
    """Return how many bytes there are between `offset` and the next aligned place."""
    return (len(HEADER) - offset) % alignment


def first_alignment(kind: FieldType) -> int:
    """Return the alignment of the first value of a field, which aligns the field as a whole."""
    if kind.container in ("bounded", "unbounded"):
        return COUNT_SIZE
    if kind.nested is not None:
        inner = fields(kind.nested)
        return first_alignment(inner[0].type) if inner else 1
    primitive = PRIMITIVES.get(kind.kind)
    return primitive.size if primitive else COUNT_SIZE


def minimum_size(cls: Any) -> int:
    """Return the fewest bytes that a message of this class takes, padding not counted.

    Never 0, so that a sequence that claims more elements than there are bytes is refused unread.
    """
    return totals(cls)[0]


def is_small(cls: Any) -> bool:
    """Tell whether code may be written out for the fields of a nested message.

    Larger ones get a function of their own, so that no definition makes code grow without bound.
    """
    _, leaves, depth = totals(cls)
    return leaves <= MOST_LEAVES and depth <= DEEPEST


def has_views(cls: Any) -> bool:
    """Tell whether messages hold sequences of numbers or of bytes, at any depth.

    They may be large, and are written from where they lie.
    """
    return any(
        has_views(kind.nested)
        if kind.nested is not None
        else kind.container in ("bounded", "unbounded") and kind.kind in PRIMITIVES
        for kind in (field.type for field in fields(cls))
    )


@cache
def totals(cls: Any) -> tuple[int, int, int]:
    """Return the least size, the number of unfolded fields, and the depth of their nesting."""
    size = leaves = depth = 0
    for field in fields(cls):
        kind = field.type
        repeats = {"single": 1, "array": kind.size}.get(kind.container)
        if kind.nested is not None:
            inner_size, inner_leaves, inner_depth = totals(kind.nested)
        else:
            primitive = PRIMITIVES.get(kind.kind)
            inner_size, inner_leaves, inner_depth = (
                primitive.size if primitive else COUNT_SIZE,
                1,
                0,
            )
        size += COUNT_SIZE if repeats is None else inner_size * repeats
        leaves += inner_leaves if kind.container == "single" else 1
        depth = max(depth, inner_depth)
    # A message without fields has one byte that says nothing.
    return max(size, 1), max(leaves, 1), depth + 1


@cache
def uniform_alignment(cls: Any) -> int | None:
    """Return the one alignment of all values of a fixed-size message, None if there is no such one.

    Messages of such a class follow each other without padding, once the first is aligned.
    """
    alignments: set[int | None] = set()
    for field in fields(cls):
        kind = field.type
        if kind.container not in ("single", "array") or (kind.nested and kind.container == "array"):
            return None
        if kind.nested is not None:
            alignments.add(uniform_alignment(kind.nested))
        elif kind.kind in PRIMITIVES:
            alignments.add(PRIMITIVES[kind.kind].size)
        else:
            return None
    return alignments.pop() if len(alignments) == 1 else None


PHASES = 8
"""Places that differ in alignment."""

TEXT = "text"
"""Code of an item that is as long as a string is."""

LONGEST_PACKED = 64
"""Bytes of a string that is packed together with what is around it."""

Pack: TypeAlias = Callable[..., bytes]


@dataclass(frozen=True, slots=True)
class Item:
    """One value of a run.

    Attributes:
        code: For `struct`; empty for an item that only aligns what follows.
        alignment: As of the wire.
        value: The expression that is packed; empty for zeros.
    """

    code: str
    alignment: int
    value: str = ""


def lay_out(run: list[Item], start: int, text_size: int = 0) -> str:
    """Return the format of a run that starts at `start`, with its padding."""
    layout = "<"
    for item in run:
        gap = padding(start + struct.calcsize(layout), item.alignment)
        code = f"{text_size}s" if item.code == TEXT else item.code
        layout += f"{gap}x{code}" if gap else code
    return layout


def phase_structs(run: list[Item], phases: range) -> dict[int, struct.Struct]:
    """Return the Struct of a run for each place, modulo `PHASES`, where it may start."""
    return {phase: struct.Struct(lay_out(run, phase)) for phase in phases}


class TextPacking:
    """Packs a run with one string in it, which starts at a known place.

    Most messages with a string begin with a header, whose frame id is short and mostly of one
    length: for each length that occurs there is one Struct, which makes the message in one step.
    """

    def __init__(self, run: list[Item], start: int) -> None:
        place = next(number for number, item in enumerate(run) if item.code == TEXT)
        self._run = run
        self._start = start
        self._place = sum(bool(item.value) for item in run[:place])
        self._before = struct.Struct(lay_out(run[:place], start))
        self._after = phase_structs(run[place + 1 :], range(PHASES))
        self.known: dict[int, tuple[Pack, int]] = {}
        """What was returned, by length of the string."""

    def __call__(self, size: int) -> tuple[Pack, int]:
        """Return what packs the run if its string has this size in bytes, and where it ends."""
        if size <= LONGEST_PACKED:
            whole = struct.Struct(lay_out(self._run, self._start, size))
            self.known[size] = whole.pack, self._start + whole.size
            return self.known[size]
        before, place = self._before, self._place
        end = self._start + before.size + size
        after = self._after[end % PHASES]

        def pack(*values: object) -> bytes:
            text = values[place]
            rest = after.pack(*values[place + 1 :])
            return b"".join((before.pack(*values[:place]), text, rest))  # type: ignore[arg-type] # it is UTF-8

        return pack, end + after.size


def modulus_of(places: set[int]) -> int:
    """Return the largest power of two, up to `PHASES`, by which all places leave one remainder."""
    modulus = PHASES
    while len({place % modulus for place in places}) > 1:
        modulus //= 2
    return modulus
