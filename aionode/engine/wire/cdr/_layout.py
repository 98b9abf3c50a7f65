"""Sizes and alignments of XCDR1, ROS 2's encoding, and runs of values packed in one step.

A value is aligned to its own size, counted from the end of the four-byte header of each message.
Only values are aligned, not structures: the start of a structure depends only on its first field.
Offsets in this package include the header, so they are positions in the data as sent.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any, TypeAlias

from msgspec import Struct

from aionode.engine.wire.cdr._constants import COUNT_SIZE, HEADER
from aionode.message import fields

if TYPE_CHECKING:
    from aionode.message import FieldType

__all__ = [
    "PHASES",
    "PRIMITIVES",
    "TEXT",
    "Item",
    "Pack",
    "Primitive",
    "TextPacking",
    "first_alignment",
    "has_buffers",
    "has_views",
    "is_small",
    "lay_out",
    "minimum_size",
    "modulus_of",
    "padding",
    "phase_structs",
    "uniform_alignment",
]

MAX_LEAVES = 64
"""Maximum number of fields, including nested ones, of a message whose code is inlined."""

MAX_DEPTH = 16
"""Maximum nesting depth of a message whose code is inlined."""

PHASES = 8
"""Number of start positions that differ in alignment: the largest alignment is 8."""

TEXT = "text"
"""Code of an item whose size is that of a string."""

MAX_PACKED = 64
"""Maximum size of a string that is packed together with the values around it, in bytes."""

Pack: TypeAlias = Callable[..., bytes]


class Primitive(Struct, frozen=True):
    """How a value of a primitive type is encoded.

    Attributes:
        code: Its format character for `struct`.
        size: Size in bytes, which is also its alignment.
        dtype: Its numpy type without the byte order.
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
    """Return the number of padding bytes between `offset` and the next aligned position."""
    return (len(HEADER) - offset) % alignment


@cache
def first_alignment(kind: FieldType) -> int:
    """Return the alignment of a field, which is that of its first value."""
    if kind.container in ("bounded", "unbounded"):
        return COUNT_SIZE
    if kind.nested is not None:
        inner = fields(kind.nested)
        return first_alignment(inner[0].type) if inner else 1
    primitive = PRIMITIVES.get(kind.kind)
    return primitive.size if primitive else COUNT_SIZE


def minimum_size(cls: Any) -> int:
    """Return the minimum encoded size of a message class in bytes, without padding.

    It is never 0, so a sequence that claims more elements than there are bytes is rejected early.
    """
    return totals(cls)[0]


def is_small(cls: Any) -> bool:
    """Return whether the code for a nested message may be inlined.

    Larger messages get a function of their own, which bounds the size of the generated code.
    """
    _, leaves, depth = totals(cls)
    return leaves <= MAX_LEAVES and depth <= MAX_DEPTH


def has_views(cls: Any) -> bool:
    """Return whether messages contain sequences of numbers or bytes, at any depth.

    These can be large, and are sent from their own memory without a copy.
    """
    return holds_numbers_in(cls, ("bounded", "unbounded"))


def has_buffers(cls: Any) -> bool:
    """Return whether messages contain unbounded sequences of this kind.

    Since ROS 2 Lyrical, their publishers use a second key.
    """
    return holds_numbers_in(cls, ("unbounded",))


@cache
def holds_numbers_in(cls: Any, containers: tuple[str, ...]) -> bool:
    """Return whether messages contain numbers or bytes in one of these containers."""
    return any(
        holds_numbers_in(kind.nested, containers)
        if kind.nested is not None
        else kind.container in containers and kind.kind in PRIMITIVES
        for kind in (field.type for field in fields(cls))
    )


@cache
def totals(cls: Any) -> tuple[int, int, int]:
    """Return the minimum size, the number of flattened fields, and the nesting depth."""
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
    # A message without fields is encoded as one meaningless byte.
    return max(size, 1), max(leaves, 1), depth + 1


@cache
def uniform_alignment(cls: Any) -> int | None:
    """Return the common alignment of all values of a fixed-size message; None if they differ.

    Messages of such a class follow each other without padding once the first one is aligned.
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


class Item(Struct, frozen=True):
    """One value of a run.

    Attributes:
        code: Its format for `struct`; empty for an item that only aligns the next one.
        alignment: Its alignment in the encoded message.
        value: The expression that is packed; empty for zeros.
    """

    code: str
    alignment: int
    value: str = ""


def lay_out(run: list[Item], start: int, text_size: int = 0) -> str:
    """Return the `struct` format, including padding, of a run that starts at offset `start`."""
    layout = "<"
    for item in run:
        gap = padding(start + struct.calcsize(layout), item.alignment)
        code = f"{text_size}s" if item.code == TEXT else item.code
        layout += f"{gap}x{code}" if gap else code
    return layout


def phase_structs(run: list[Item], phases: range) -> dict[int, struct.Struct]:
    """Return the Struct of a run for each of the given start offsets modulo `PHASES`."""
    return {phase: struct.Struct(lay_out(run, phase)) for phase in phases}


class TextPacking:
    """Packs a run that contains one string and starts at a known offset.

    Most messages with a string start with a header whose frame id is short and rarely changes its
    length. There is one Struct for each length that occurs, which packs the run in one step.
    """

    def __init__(self, run: list[Item], start: int) -> None:
        place = next(number for number, item in enumerate(run) if item.code == TEXT)
        self._run = run
        self._start = start
        self._place = sum(bool(item.value) for item in run[:place])
        self._before = struct.Struct(lay_out(run[:place], start))
        self._after = phase_structs(run[place + 1 :], range(PHASES))
        self.known: dict[int, tuple[Pack, int]] = {}
        """Earlier results for short strings, by the string's size in bytes."""

    def __call__(self, size: int) -> tuple[Pack, int]:
        """Return the packing function for a string of `size` bytes, and the run's end offset."""
        if size <= MAX_PACKED:
            whole = struct.Struct(lay_out(self._run, self._start, size))
            self.known[size] = whole.pack, self._start + whole.size
            return self.known[size]
        before, place = self._before, self._place
        end = self._start + before.size + size
        after = self._after[end % PHASES]

        def pack(*values: object) -> bytes:
            text = values[place]
            rest = after.pack(*values[place + 1 :])
            return b"".join((before.pack(*values[:place]), text, rest))  # type: ignore[arg-type] # encoded by the caller

        return pack, end + after.size


def modulus_of(places: set[int]) -> int:
    """Return the largest power of two, up to `PHASES`, modulo which all offsets are equal."""
    modulus = PHASES
    while len({place % modulus for place in places}) > 1:
        modulus //= 2
    return modulus
