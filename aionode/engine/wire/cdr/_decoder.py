"""Generates one decoder function for each message type.

The generated function assumes little-endian data as ROS writes it, and validates little: invalid
data raises an exception somewhere, and the fallback decoder then decodes the data again. It either
reports the exact position of the error or succeeds, as it is more lenient.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from aionode.engine.wire.cdr._codegen import CodeBuilder, NeedsFallback
from aionode.engine.wire.cdr._constants import COUNT_SIZE, HEADER, NOTHING
from aionode.engine.wire.cdr._family import OWN, MessageFamily
from aionode.engine.wire.cdr._layout import (
    PHASES,
    PRIMITIVES,
    is_small,
    minimum_size,
    uniform_alignment,
)
from aionode.engine.wire.cdr._strings import StringsReader, read_wide_strings, wide_string
from aionode.message import DTYPES, fields, type_name
from aionode.message.validation import EMPTY

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.message import FieldType

__all__ = ["generate_decoder"]

HEADER_LAYOUT = "<Hxx"
"""Format of the message header for `struct`; its last two bytes are ignored."""

MAGIC = int.from_bytes(HEADER[:2], "little")
"""First two bytes of the header, as the generated function unpacks them."""

FALLBACK_ERRORS = (NeedsFallback, struct.error, IndexError, ValueError)
"""Raised by the generated function if data is truncated, corrupt or not as ROS writes it."""

UNKNOWN = ()
"""Cached text before the first message: `startswith(())` is never true."""

SKIPPED = 31
"""Number of messages after a cache miss for which the cached text is not compared."""

MAX_KEPT = 256
"""Maximum size of a string that is cached in case the next message has the same one, in bytes."""


def generate_decoder(
    cls: Any,
    fallback: Callable[[Any], Any],
    other: Callable[[Any], Any] | None = None,
    *,
    family: MessageFamily = OWN,
) -> Callable[[Any], Any]:
    """Return the function that decodes messages of class `cls`.

    Args:
        cls: A message class.
        fallback: Decodes data that the function cannot decode, or raises the error.
        other: Decodes data that is not a bytes object. Without it, the function only accepts
            memoryviews.
        family: The family of the messages it creates.
    """
    return DecoderGenerator(cls, family, of_bytes=other is not None).whole(fallback, other)


@cache
def element_decoder(
    cls: Any, family: MessageFamily, *, of_bytes: bool
) -> Callable[[Any, memoryview, int], tuple[Any, int]]:
    """Return a function that decodes a nested message, and returns the message and its end."""
    return DecoderGenerator(cls, family, of_bytes=of_bytes).element()


class RunArray(Struct, frozen=True):
    """An array of fixed size in a run: target variable, element type, offset and length."""

    target: str
    kind: str
    offset: int
    count: int


class DecoderGenerator:
    """Generates the decoder of one message type.

    Adjacent values of fixed size are collected into a run, and each run is unpacked in one step.
    `_offset` is the value of the variable `pos` at the start of the current run, or None if that
    depends on the data. In both cases, that position, not counting the header, is `_residue` modulo
    `_modulus`, so the generator knows which alignments need no padding.
    """

    def __init__(self, cls: Any, family: MessageFamily, *, of_bytes: bool) -> None:
        self._cls = cls
        self._family = family
        self._of_bytes = of_bytes
        self._source = CodeBuilder()
        self._layout = "<"
        """Format of the current run, for `struct`."""
        self._targets: list[str] = []
        """Variables that the values of the current run are assigned to."""
        self._arrays: list[RunArray] = []
        """Arrays of fixed size in the current run."""
        self._magic = ""
        """Variable that holds the start of the header until it is checked."""
        self._has_view = False
        self._offset: int | None = 0
        self._modulus, self._residue = PHASES, -len(HEADER) % PHASES

    def whole(
        self, fallback: Callable[[Any], Any], other: Callable[[Any], Any] | None
    ) -> Callable[[Any], Any]:
        """Return the function that decodes a whole message."""
        source = self._source
        fallback_name = source.constant("plain", fallback)
        misfits = source.constant("misfits", FALLBACK_ERRORS)
        if other is not None:
            name = source.constant("other", other)
            source.line(f"if data.__class__ is not bytes: return {name}(data)")
        with source.block("try:"):
            self._read_header()
            result = self._message(self._cls)
            self._flush()
            source.line(f"return {result}")
        source.line(f"except {misfits}: pass")
        source.line(f"return {fallback_name}(data)")
        return source.function("def decode(data):", type_name(self._cls))

    def element(self) -> Callable[[Any, memoryview, int], tuple[Any, int]]:
        """Return the function that decodes a message starting at any `pos`."""
        self._has_view = True
        self._unknown()
        result = self._message(self._cls)
        self._flush()
        self._source.line(f"return {result}, pos")
        return self._source.function("def read(data, view, pos):", type_name(self._cls))

    def _message(self, cls: Any) -> str:
        """Decode all fields; return the expression that constructs the message."""
        described = fields(cls)
        if not described:
            self._value("x", 1)
        # Positional, as keyword arguments would cost twice as much.
        values = [self._field(field.type, field.name) for field in described]
        return f"{self._class(cls)}({', '.join(values)})"

    def _class(self, cls: Any) -> str:
        """Return the name of a message's constructor, derived from its validated type name."""
        make = self._family.constructor(cls)
        return self._source.constant(type_name(cls).rpartition("/")[2], make)

    def _field(self, kind: FieldType, name: str) -> str:
        """Decode one field; return the expression of its value."""
        if kind.container == "single" and kind.nested is not None and is_small(kind.nested):
            return self._message(kind.nested)
        local = self._source.local(name)
        if kind.nested is not None:
            self._messages(kind, kind.nested, local)
        elif kind.kind not in PRIMITIVES:
            read = self._text if kind.container == "single" else self._strings
            read(kind, local)
        elif kind.container == "single":
            primitive = PRIMITIVES[kind.kind]
            self._value(primitive.code, primitive.size, local)
        elif kind.form == "bytes":
            self._octets(kind, local)
        else:
            self._numbers(kind, local)
        return local

    def _text(self, kind: FieldType, local: str) -> None:
        source = self._source
        if kind.kind == "wstring":
            size = self._count(kind)
            start = self._skip(f"4 * {size}", COUNT_SIZE)
            source.require("pos <= len(data)")
            source.line(f"{local} = {source.constant('wide', wide_string)}(data[{start}:pos])")
        elif self._has_view or not self._of_bytes:
            self._new_text(local, self._skip(self._count(kind), 1))
        else:
            self._repeated_text(kind, local)
        if kind.string_bound is not None:
            source.require(f"len({local}) <= {kind.string_bound}")

    def _repeated_text(self, kind: FieldType, local: str) -> None:
        """Decode a text that is probably the same as in the last message, such as a frame id.

        A text that equals the cached one need not be validated or created again. It is compared
        together with its length, and at the start of a message also with the header, so truncated
        data never matches. After a cache miss the comparison is skipped for `SKIPPED` messages, so
        texts that change every time cost little more.
        """
        source = self._source
        last, skip = source.variable("last", (UNKNOWN, "")), source.variable("skip", 0)
        known = source.local("known")
        source.line(f"{known}, {local} = {last}")
        if self._layout == HEADER_LAYOUT:
            with source.block(f"if {skip} or not data.startswith({known}):"):
                size = self._count(kind)
                start = self._skip(size, 1)
                self._new_text(local, start)
                self._remember(skip, size, f"{last} = data[:pos], {local}")
            source.position(f"else: pos = len({known})")
            return
        size = self._count(kind)
        start = self._skip(size, 1)
        raw = f"data[{start} - {COUNT_SIZE}:pos]"
        with source.block(f"if {skip} or {raw} != {known}:"):
            self._new_text(local, start)
            self._remember(skip, size, f"{last} = {raw}, {local}")

    def _remember(self, skip: str, size: str, statement: str) -> None:
        """Cache a new text, unless the comparison is being skipped."""
        self._source.line(f"if {skip} > 0: {skip} -= 1")
        with self._source.block("else:"):
            self._source.line(f"{skip} = {SKIPPED}")
            self._source.line(f"if {size} <= {MAX_KEPT}: {statement}")

    def _new_text(self, local: str, start: str) -> None:
        """Decode a text; it must end with a NUL inside the data."""
        self._source.line("if data[pos - 1]: raise NeedsFallback")
        text = f"data[{start}:pos - 1]"
        # `decode` is faster, but memoryviews do not have it.
        expression = f"{text}.decode()" if self._of_bytes else f"str({text}, 'utf-8')"
        self._source.line(f"{local} = {expression}")

    def _strings(self, kind: FieldType, local: str) -> None:
        source = self._source
        count = self._count(kind)
        self._align(COUNT_SIZE)
        wide = kind.kind == "wstring"
        read = source.constant("texts", read_wide_strings if wide else StringsReader())
        source.line(f"{local}, pos = {read}(data, {self._place()}, {count})")
        self._unknown()
        if kind.string_bound is not None:
            source.require(f"max(map(len, {local}), default=0) <= {kind.string_bound}")

    def _octets(self, kind: FieldType, local: str) -> None:
        if kind.container == "array":
            self._value(f"{kind.size}s", 1, local)
            return
        count = self._count(kind)
        start = self._skip(count, 1)
        self._source.require("pos <= len(data)")
        self._source.line(f"{local} = {self._view()}[{start}:pos]")

    def _numbers(self, kind: FieldType, local: str) -> None:
        source = self._source
        primitive = PRIMITIVES[kind.kind]
        if kind.container == "array":
            offset = self._value(f"{kind.size * primitive.size}x", primitive.size)
            self._arrays.append(RunArray(local, kind.kind, offset, kind.size))
            return
        count = self._count(kind)
        self._align_elements(primitive.size, count)
        if self._family.has_arrays:
            empty = source.constant("empty", EMPTY[DTYPES[kind.kind]]())
            source.line(f"{local} = {self._array(kind.kind, count, 'pos')} if {count} else {empty}")
            source.position(f"pos += {primitive.size} * {count}")
            return
        empty = source.constant("nothing", NOTHING)
        start = self._skip(f"{primitive.size} * {count}", primitive.size)
        source.require("pos <= len(data)")
        numbers = f"{self._view()}[{start}:pos].cast({primitive.code!r})"
        source.line(f"{local} = {numbers} if {count} else {empty}")

    def _messages(self, kind: FieldType, cls: Any, local: str) -> None:
        source = self._source
        count = self._count(kind)
        self._flush()
        if kind.container in ("bounded", "unbounded"):
            source.require(f"{minimum_size(cls)} * {count} <= len(data) - {self._place()}")
            if self._uniform_messages(cls, count, local):
                return
        view = self._view()
        read = source.constant("read", element_decoder(cls, self._family, of_bytes=self._of_bytes))
        if self._offset is not None:
            source.line(f"pos = {self._offset}")
        self._unknown()
        if kind.container == "single":
            source.line(f"{local}, pos = {read}(data, {view}, pos)")
            return
        item = source.local("item")
        source.line(f"{local} = []")
        with source.loop(f"for _ in range({count}):"):
            source.line(f"{item}, pos = {read}(data, {view}, pos)")
            source.line(f"{local}.append({item})")

    def _uniform_messages(self, cls: Any, count: str, local: str) -> bool:
        """Decode messages of equally aligned scalars with one Struct; return False for others."""
        alignment = uniform_alignment(cls)
        if alignment is None or has_arrays(cls):
            return False
        source = self._source
        self._align_elements(alignment, count)
        before = self._modulus, self._residue
        self._modulus, self._residue = alignment, 0
        result = self._message(cls)
        self._modulus, self._residue = before
        element = struct.Struct(self._layout)
        targets, self._layout, self._targets = self._targets, "<", []
        start = self._skip(f"{element.size} * {count}", alignment)
        source.require("pos <= len(data)")
        unpack = source.constant("unpack", element.iter_unpack)
        elements = f"{unpack}({self._view()}[{start}:pos])"
        source.line(f"{local} = [{result} for {', '.join(targets)}, in {elements}]")
        return True

    # Runs and positions

    def _read_header(self) -> None:
        """Read the header as part of the first run, which also checks it."""
        self._magic = self._source.local("magic")
        self._value(HEADER_LAYOUT[1:], 1, self._magic)

    def _count(self, kind: FieldType) -> str:
        """Return the expression of the number of elements, or bytes of text, that follow."""
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
        """Add a value of fixed size to the run; return its offset from the start of the run."""
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
        """Unpack the current run and start a new one."""
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
        """Return the expression of the start of the run plus `further` bytes."""
        if self._offset is not None:
            return str(self._offset + further)
        return f"pos + {further}" if further else "pos"

    def _advance(self, size: int) -> None:
        """Move the start of the next run by `size` bytes."""
        if size and self._offset is None:
            self._source.position(f"pos += {size}")
        elif self._offset is not None:
            self._offset += size
        self._residue = (self._residue + size) % self._modulus

    def _align(self, alignment: int) -> None:
        """Move to the next aligned position."""
        self._flush()
        if alignment <= self._modulus:
            self._advance(-self._residue % alignment)
            return
        self._source.line(f"pos = {aligned(alignment)}")
        self._modulus, self._residue = alignment, 0

    def _align_elements(self, alignment: int, count: str) -> None:
        """Move to the first of `count` elements; an empty sequence has no padding."""
        if self._offset is not None:
            self._source.line(f"pos = {self._offset}")
            self._offset = None
        if alignment > COUNT_SIZE and (self._modulus < alignment or self._residue):
            self._source.line(f"if {count}: pos = {aligned(alignment)}")
        self._unknown(self._kept(alignment))

    def _skip(self, size: str, alignment: int) -> str:
        """Skip a value of variable size; return the expression of its start.

        Args:
            size: Expression of its size.
            alignment: A number of which the size is always a multiple.
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
        """Return the alignment of `pos` after skipping a multiple of `alignment` bytes."""
        known = min(alignment, self._modulus)
        while self._residue % known:
            known //= 2
        return known

    def _unknown(self, modulus: int = 1) -> None:
        """Record that `pos` depends on the data and is only known to be aligned to `modulus`."""
        self._offset = None
        self._modulus, self._residue = modulus, 0

    def _view(self) -> str:
        """Return the name of the memoryview of `data`."""
        if not self._has_view:
            self._source.line("view = memoryview(data)")
            self._has_view = True
        return "view"

    def _array(self, kind: str, count: str, place: str) -> str:
        """Return the expression of an array that is a view of `data`."""
        import numpy as np

        if kind == "bool":
            return f"{self._source.constant('bools', bools)}(data, {count}, {place})"
        dtype = self._source.constant("dtype", np.dtype(f"<{PRIMITIVES[kind].dtype}"))
        make = self._source.constant("frombuffer", np.frombuffer)
        return f"{make}(data, {dtype}, {count}, {place})"

    def _run_arrays(self) -> None:
        """Create the arrays of the run; slicing one array per element type is cheaper."""
        source = self._source
        for kind in dict.fromkeys(array.kind for array in self._arrays):
            arrays = [array for array in self._arrays if array.kind == kind]
            first, last, size = arrays[0], arrays[-1], PRIMITIVES[kind].size
            if len(arrays) == 1 or kind == "bool":
                for array in arrays:
                    expression = self._array(kind, str(array.count), self._place(array.offset))
                    source.line(f"{array.target} = {expression}")
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
    """Return the expression of the next aligned position at or after `pos`."""
    shift = len(HEADER) % alignment
    if shift:
        return f"(pos + {alignment - 1 - shift} & -{alignment}) + {shift}"
    return f"pos + {alignment - 1} & -{alignment}"


def bools(data: Any, count: int, pos: int) -> Any:
    """Return a bool array that is a view of `data`, or a copy if bytes other than 0 and 1 occur."""
    import numpy as np

    numbers = np.frombuffer(data, np.uint8, count, pos)
    if count and numbers.max() > 1:
        numbers = numbers != 0
        numbers.flags.writeable = False
    return numbers.view(np.bool_)


def has_arrays(cls: Any) -> bool:
    """Return whether a message of fixed size contains arrays."""
    kinds = [field.type for field in fields(cls)]
    return any(
        kind.container == "array" or (kind.nested is not None and has_arrays(kind.nested))
        for kind in kinds
    )
