"""The part of a decoder's generator that knows where what it reads is."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from aionode.wire.layout import COUNT_SIZE, HEADER, PRIMITIVES
from aionode.wire.source import Source

if TYPE_CHECKING:
    from aionode.message import FieldType

__all__ = ["HEADER_LAYOUT", "Reading", "RunArray"]

PLACES = 8
"""Places that differ in alignment."""

HEADER_LAYOUT = "<Hxx"

MAGIC = int.from_bytes(HEADER[:2], "little")


@dataclass(frozen=True, slots=True)
class RunArray:
    """An array of fixed size in a run: where it goes, of what it is, and where it lies."""

    target: str
    kind: str
    offset: int
    count: int


class Reading:
    """Collects values into runs, and reads each run in one step.

    What is known of `pos` at the start of the run being collected: its value as `_offset`, or None
    where that depends on the data; in any case that, not counting the header, it is `_residue`
    modulo `_modulus`.
    """

    def __init__(self) -> None:
        self._source = Source()
        self._layout = "<"
        self._targets: list[str] = []
        self._arrays: list[RunArray] = []
        self._magic = ""
        self._has_view = False
        self._offset: int | None = 0
        self._modulus, self._residue = PLACES, -len(HEADER) % PLACES

    def _read_header(self) -> None:
        """Begin with what opens a message; it is checked with the first run."""
        self._magic = self._source.local("magic")
        self._value(HEADER_LAYOUT[1:], 1, self._magic)

    def _count(self, kind: FieldType) -> str:
        """Return the expression of how many elements, or bytes of text, follow."""
        if kind.container == "array":
            return str(kind.size)
        if kind.nested is not None and kind.container == "single":
            return "1"
        count = self._source.local("n")
        self._value("I", COUNT_SIZE, count)
        self._flush()
        if kind.container == "bounded":
            self._source.require(f"{count} <= {kind.size}")
        return count

    def _value(self, code: str, alignment: int, target: str = "") -> int:
        """Read one value of fixed size into `target`; return its offset from the run's start."""
        if alignment > self._modulus:
            self._align(alignment)
        at = self._residue + struct.calcsize(self._layout)
        gap = -at % alignment
        offset = struct.calcsize(self._layout) + gap
        self._layout += f"{gap}x{code}" if gap else code
        if target:
            self._targets.append(target)
        return offset

    def _flush(self) -> None:
        """Read the run collected so far."""
        packed = struct.Struct(self._layout)
        source = self._source
        if self._targets:
            unpack = source.constant("unpack", packed.unpack_from)
            at = "" if self._offset == 0 else f", {self._place()}"
            source.line(f"{', '.join(self._targets)}, = {unpack}(data{at})")
        elif packed.size:
            source.require(f"len(data) >= {self._place(packed.size)}")
        self._run_arrays()
        if self._magic:
            source.require(f"{self._magic} == {MAGIC}")
        self._layout, self._targets, self._magic = "<", [], ""
        self._advance(packed.size)

    def _place(self, further: int = 0) -> str:
        """Return the expression of where the run starts, or of what is `further`."""
        if self._offset is not None:
            return str(self._offset + further)
        return f"pos + {further}" if further else "pos"

    def _advance(self, size: int) -> None:
        """Note that the next run starts `size` further."""
        if size and self._offset is None:
            self._source.position(f"pos += {size}")
        elif self._offset is not None:
            self._offset += size
        self._residue = (self._residue + size) % self._modulus

    def _align(self, alignment: int) -> None:
        """Go to the next aligned place."""
        self._flush()
        if alignment <= self._modulus:
            self._advance(-self._residue % alignment)
            return
        self._source.line(f"pos = {aligned(alignment)}")
        self._modulus, self._residue = alignment, 0

    def _align_elements(self, alignment: int, count: str) -> None:
        """Go to the first of `count` elements after a count; none are not aligned."""
        if self._offset is not None:
            self._source.line(f"pos = {self._offset}")
            self._offset = None
        if alignment > COUNT_SIZE and (self._modulus < alignment or self._residue):
            self._source.line(f"if {count}: pos = {aligned(alignment)}")
        self._unknown(self._kept(alignment))

    def _skip(self, size: str, alignment: int) -> str:
        """Set `pos` to the end of something variable; return the expression of its start.

        Args:
            size: Expression of how long it is.
            alignment: What that is always a multiple of.
        """
        source = self._source
        if self._offset is not None:
            start = str(self._offset)
            source.line(f"pos = {start} + {size}")
        else:
            start = source.local("start")
            source.line(f"{start} = pos")
            source.line(f"pos += {size}")
        self._unknown(self._kept(alignment))
        return start

    def _kept(self, alignment: int) -> int:
        """Return what `pos` stays aligned to after a multiple of `alignment`."""
        known = min(alignment, self._modulus)
        while self._residue % known:
            known //= 2
        return known

    def _unknown(self, modulus: int = 1) -> None:
        """Note that `pos` depends on the data, and is aligned to `modulus`."""
        self._offset = None
        self._modulus, self._residue = modulus, 0

    def _view(self) -> str:
        """Return the name of the memoryview of `data`."""
        if not self._has_view:
            self._source.line("view = memoryview(data)")
            self._has_view = True
        return "view"

    def _array(self, kind: str, count: str, place: str) -> str:
        """Return the expression that makes an array over `data`."""
        import numpy as np

        if kind == "bool":
            return f"{self._source.constant('bools', bools)}(data, {count}, {place})"
        dtype = self._source.constant("dtype", np.dtype(f"<{PRIMITIVES[kind].dtype}"))
        make = self._source.constant("frombuffer", np.frombuffer)
        return f"{make}(data, {dtype}, {count}, {place})"

    def _run_arrays(self) -> None:
        """Make the arrays of the run: those of one kind as slices of one, which costs less."""
        source = self._source
        for kind in dict.fromkeys(array.kind for array in self._arrays):
            arrays = [array for array in self._arrays if array.kind == kind]
            first, last, size = arrays[0], arrays[-1], PRIMITIVES[kind].size
            if len(arrays) == 1 or kind == "bool":
                for array in arrays:
                    made = self._array(kind, str(array.count), self._place(array.offset))
                    source.line(f"{array.target} = {made}")
                continue
            count = (last.offset - first.offset) // size + last.count
            all_ = source.local("all")
            source.line(f"{all_} = {self._array(kind, str(count), self._place(first.offset))}")
            for array in arrays:
                start = (array.offset - first.offset) // size
                part = source.constant("part", slice(start, start + array.count))
                source.line(f"{array.target} = {all_}[{part}]")
        self._arrays.clear()


def aligned(alignment: int) -> str:
    """Return the expression of the next aligned place at or after `pos`."""
    shift = len(HEADER) % alignment
    if shift:
        return f"(pos + {alignment - 1 - shift} & -{alignment}) + {shift}"
    return f"pos + {alignment - 1} & -{alignment}"


def bools(data: Any, count: int, pos: int) -> Any:
    """Return an array of bool over `data`; a copy if another byte than 0 and 1 means True."""
    import numpy as np

    numbers = np.frombuffer(data, np.uint8, count, pos)
    if count and numbers.max() > 1:
        numbers = numbers != 0
        numbers.flags.writeable = False
    return numbers.view(np.bool_)
