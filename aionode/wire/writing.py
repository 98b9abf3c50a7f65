"""The part of an encoder's generator that knows where what it writes will be."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

from aionode.wire.layout import COUNT_SIZE, HEADER, first_alignment, padding
from aionode.wire.packing import (
    PHASES,
    TEXT,
    Item,
    TextPacking,
    modulus_of,
    phase_structs,
)
from aionode.wire.source import Source

if TYPE_CHECKING:
    from aionode.message import FieldType

__all__ = ["Writing"]


class Writing:
    """Collects values into runs, and runs and what lies between them into the parts of a message.

    What is known of `pos` at the place reached: its value as `_offset`, or None where that depends
    on the message; in any case that it is `_residue` modulo `_modulus`.
    """

    def __init__(self) -> None:
        self._source = Source()
        self._run: list[Item] = []
        self._text_size = ""
        self._parts: list[str] = []
        self._listed = False
        self._offset: int | None = 0
        self._modulus, self._residue = PHASES, 0

    def _unknown(self) -> None:
        """Note that nothing is known of `pos`."""
        self._offset = None
        self._modulus, self._residue = 1, 0

    def _forget_offset(self) -> None:
        """Leave what is known of `pos` to the variable."""
        if self._offset is not None:
            self._source.line(f"pos = {self._offset}")
            self._offset = None

    def _count(self, kind: FieldType, count: str) -> None:
        """Write how many elements follow, or check it where their number is fixed."""
        if kind.container == "array":
            self._source.require(f"{count} == {kind.size}")
            self._run.append(Item("", first_alignment(kind)))
            return
        if kind.container == "bounded":
            self._source.require(f"{count} <= {kind.size}")
        self._run.append(Item("I", COUNT_SIZE, count))

    def _align_elements(self, alignment: int, count: str) -> None:
        """Write the gap between a count and elements larger than it; no elements have no gap."""
        self._flush()
        if alignment <= COUNT_SIZE:
            return
        source = self._source
        gap = source.constant("gap", bytes(COUNT_SIZE))
        if self._modulus == PHASES:
            if padding(self._residue, alignment) == 0:
                return
            condition = count
        else:
            condition = f"{count} and not pos & {COUNT_SIZE}"
        pad = source.local("pad")
        source.line(f"{pad} = {gap} if {condition} else b''")
        self._variable(pad, f"len({pad})", COUNT_SIZE)

    def _variable(self, part: str, size: str, alignment: int) -> None:
        """Write a part whose size is only known from the message."""
        self._flush()
        self._parts.append(part)
        self._move(size, alignment)

    def _move(self, size: str, alignment: int) -> None:
        """Set `pos` after something that is `size` long, always a multiple of `alignment`."""
        if self._offset is None:
            self._source.position(f"pos += {size}")
        else:
            self._source.position(f"pos = {self._offset} + {size}")
            self._offset = None
        # It started aligned, as far as that is known.
        self._modulus = min(alignment, self._modulus)
        self._residue = len(HEADER) % self._modulus

    def _flush(self) -> None:
        """Pack the run collected so far."""
        if not self._run:
            return
        run, self._run = self._run, []
        values = ", ".join(item.value for item in run if item.value)
        if any(item.code == TEXT for item in run):
            self._pack_text(run, values)
            return
        structs = phase_structs(run, range(self._residue, PHASES, self._modulus))
        one = structs[self._residue]
        if len({each.format for each in structs.values()}) == 1:
            if one.size:
                self._parts.append(self._packing(one, values))
            if self._offset is not None:
                self._offset += one.size
            else:
                self._source.position(f"pos += {one.size}")
        else:
            self._pack_by_phase(structs, values)
        self._ends({phase + each.size for phase, each in structs.items()})

    def _ends(self, places: set[int]) -> None:
        """Note where a run may have ended."""
        self._modulus = modulus_of(places)
        self._residue = places.pop() % self._modulus

    def _packing(self, packed: struct.Struct, values: str) -> str:
        """Return the expression of a run that is the same wherever it starts."""
        if not values:
            return self._source.constant("zeros", packed.pack())
        return f"{self._source.constant('pack', packed.pack)}({values})"

    def _pack_by_phase(self, structs: dict[int, struct.Struct], values: str) -> None:
        """Write a run whose padding depends on where it starts."""
        source = self._source
        table = [structs.get(phase, struct.Struct("")) for phase in range(PHASES)]
        steps = source.constant("sizes", tuple(each.size for each in table))
        part, phase = source.local("run"), source.local("phase")
        source.line(f"{phase} = pos & {PHASES - 1}")
        if values:
            packs = source.constant("packs", tuple(each.pack for each in table))
            source.line(f"{part} = {packs}[{phase}]({values})")
        else:
            zeros = source.constant("zeros", tuple(bytes(each.size) for each in table))
            source.line(f"{part} = {zeros}[{phase}]")
        self._parts.append(part)
        source.position(f"pos += {steps}[{phase}]")

    def _pack_text(self, run: list[Item], values: str) -> None:
        """Write a run with a string in it."""
        source = self._source
        assert self._offset is not None  # noqa: S101 - else the string is a part of its own
        packing = TextPacking(run, self._offset)
        known = source.constant("known", packing.known)
        more = source.constant("more", packing)
        pack, part = source.local("pack"), source.local("run")
        source.line(f"try: {pack}, pos = {known}[{self._text_size}]")
        source.line(f"except KeyError: {pack}, pos = {more}({self._text_size})")
        source.line(f"{part} = {pack}({values})")
        self._parts.append(part)
        self._ends({packing(size)[1] for size in range(PHASES)})
        self._offset = None

    def _spill(self) -> None:
        """Move the parts named so far into the list `out`, before a loop adds to it."""
        if not self._listed:
            self._source.line(f"out = [{', '.join(self._parts)}]")
            self._listed = True
        elif self._parts:
            self._source.line(f"out += ({', '.join(self._parts)},)")
        self._parts.clear()
