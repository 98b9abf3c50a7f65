"""Runs of values of fixed size, packed in one step wherever they start."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from aionode.wire.layout import padding

__all__ = [
    "PHASES",
    "TEXT",
    "Item",
    "Pack",
    "TextPacking",
    "lay_out",
    "modulus_of",
    "phase_structs",
]

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
