"""Generates one encoder function for each message type.

Nested messages are inlined, so runs of values of fixed size are packed by one `struct.Struct` even
across nesting levels. A run after a value of variable size has one Struct for each of the eight
start positions that differ in alignment. The generated function handles messages in their usual
form (ndarrays with the field's dtype, lists of str) and leaves all others to a slower fallback,
which also raises the errors.
"""

from __future__ import annotations

import struct
import sys
from functools import cache
from typing import TYPE_CHECKING, Any, Final, TypeVar

from aionode.engine.wire.cdr._codegen import CodeBuilder, NeedsFallback
from aionode.engine.wire.cdr._coerce import array_coercer, octets, real_numbers, whole_numbers
from aionode.engine.wire.cdr._constants import COUNT_SIZE, HEADER
from aionode.engine.wire.cdr._family import OWN, MessageFamily
from aionode.engine.wire.cdr._layout import (
    PHASES,
    PRIMITIVES,
    TEXT,
    Item,
    TextPacking,
    first_alignment,
    is_small,
    lay_out,
    modulus_of,
    padding,
    phase_structs,
    uniform_alignment,
)
from aionode.engine.wire.cdr._strings import StringsWriter, wide_bytes, wide_strings
from aionode.message import fields, type_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.message import FieldType

__all__ = ["FALLBACK_ERRORS", "JOIN", "generate_encoder", "views"]

Encoded = TypeVar("Encoded")

JOIN: Final = b"".join

LARGE: Final = 1 << 12
"""Parts with at least this many elements stay separate; smaller ones are cheaper to join."""

FALLBACK_ERRORS = (
    NeedsFallback,
    struct.error,
    AttributeError,
    BufferError,
    OverflowError,
    TypeError,
    ValueError,
)
"""Raised by the generated function if a message is not in the usual form."""


def generate_encoder(
    cls: Any,
    fallback: Callable[[Any], Encoded],
    finish: Callable[[Sequence[Any]], Encoded],
    family: MessageFamily = OWN,
) -> Callable[..., Encoded]:
    """Return the function that encodes messages of class `cls`.

    Args:
        cls: A message class.
        fallback: Encodes a message that is not in the usual form, or raises the error. It may call
            the function again with True as the second argument, which then raises what went wrong.
        finish: Creates the result from the parts, which are bytes and the message's own arrays:
            `JOIN` or `views`.
        family: The family of the messages it encodes.
    """
    return EncoderGenerator(cls, family).whole(fallback, finish)


def views(parts: Sequence[Any]) -> list[bytes | memoryview]:
    """Return `parts` with small ones joined, and large ones as read-only byte views."""
    chunks: list[bytes | memoryview] = []
    begin = 0
    for place in [number for number, part in enumerate(parts) if len(part) >= LARGE]:
        if begin < place:
            chunks.append(JOIN(parts[begin:place]))
        part = parts[place]
        chunks.append(part if part.__class__ is bytes else memoryview(part).cast("B").toreadonly())
        begin = place + 1
    if begin < len(parts):
        chunks.append(JOIN(parts[begin:]))
    return chunks


@cache
def element_encoder(cls: Any, family: MessageFamily) -> Callable[[list[bytes], int, Any], int]:
    """Return a function that encodes a nested message: it appends parts and returns `pos`."""
    return EncoderGenerator(cls, family).element()


class EncoderGenerator:
    """Generates the encoder of one message type.

    Adjacent values of fixed size are collected into a run, and each run is packed in one step; the
    runs, and the values of variable size between them, are the parts of the encoded message.
    `_offset` is the value of the variable `pos` after the parts so far, or None if that depends on
    the message. In both cases, that position is `_residue` modulo `_modulus`.
    """

    def __init__(self, cls: Any, family: MessageFamily) -> None:
        self._cls = cls
        self._family = family
        self._source = CodeBuilder()
        self._run: list[Item] = []
        """The current run."""
        self._text_size = ""
        """Expression of the size of the string in the current run, if it contains one."""
        self._parts: list[str] = []
        """Expressions of the parts that are not in the list `out` yet."""
        self._listed = False
        """Whether the generated function has a list `out` of parts."""
        self._ints: list[str] = []
        """Variables of integers whose class is not checked yet."""
        self._floats: list[str] = []
        """Variables of floats whose class is not checked yet."""
        self._offset: int | None = 0
        self._modulus, self._residue = PHASES, 0

    def whole(
        self, fallback: Callable[[Any], Encoded], finish: Callable[[Sequence[Any]], Encoded]
    ) -> Callable[..., Encoded]:
        """Return the function that encodes a whole message; only `fallback` passes `again`."""
        source = self._source
        fallback_name = source.constant("plain", fallback)
        misfits = source.constant("misfits", FALLBACK_ERRORS)
        join = source.constant("join", finish)
        with source.block("try:"):
            self._run.append(Item(f"{len(HEADER)}s", 1, source.constant("header", HEADER)))
            self._message(self._cls, "msg", after=1)
            self._flush()
            if self._listed:
                self._spill()
                source.line(f"return {join}(out)")
            elif len(self._parts) > 1 or finish is not JOIN:
                source.line(f"return {join}(({', '.join(self._parts)},))")
            else:
                source.line(f"return {self._parts[0]}")
        with source.block(f"except {misfits}:"):
            source.line("if again: raise")
        source.line(f"return {fallback_name}(msg)")
        return source.function("def encode(msg, again=False):", type_name(self._cls))

    def element(self) -> Callable[[list[bytes], int, Any], int]:
        """Return the function that appends an encoded message to a list of parts."""
        self._listed = True
        self._unknown()
        self._message(self._cls, "msg", after=1)
        self._flush()
        self._spill()
        self._source.line("return pos")
        return self._source.function("def write(out, pos, msg):", type_name(self._cls))

    def _message(self, cls: Any, owner: str, after: int) -> None:
        """Encode all fields; the value that follows is aligned to `after`."""
        class_ = self._source.constant("T", self._family.class_of(cls))
        self._source.require(f"{owner}.__class__ is {class_}")
        described = fields(cls)
        if not described:
            self._run.append(Item("x", 1))
        for number, field in enumerate(described, 1):
            following = described[number:]
            self._field(
                field.type,
                field.name,
                f"{owner}.{self._family.prefix}{field.name}",
                first_alignment(following[0].type) if following else after,
            )
        self._check_scalars()

    def _field(self, kind: FieldType, name: str, value: str, after: int) -> None:
        if kind.container == "single":
            if kind.nested is not None:
                self._nested(kind.nested, name, value, after)
            elif kind.kind in PRIMITIVES:
                self._scalar(kind.kind, name, value)
            else:
                self._text(kind, name, value)
            return
        local = self._source.local(name)
        self._source.line(f"{local} = {value}")
        if kind.nested is not None:
            self._messages(kind, kind.nested, local)
        elif kind.kind not in PRIMITIVES:
            self._strings(kind, local, after)
        elif kind.form == "bytes":
            self._octets(kind, local)
        else:
            self._numbers(kind, local)

    def _nested(self, cls: Any, name: str, value: str, after: int) -> None:
        local = self._source.local(name)
        self._source.line(f"{local} = {value}")
        if is_small(cls):
            self._message(cls, local, after)
        else:
            self._flush()
            self._spill()
            self._forget_offset()
            self._element(cls, local)

    def _scalar(self, kind: str, name: str, value: str) -> None:
        source = self._source
        local = source.local(name)
        source.line(f"{local} = {value}")
        # struct checks ranges, but accepts any object as a bool and anything convertible as a
        # number.
        if kind == "bool":
            source.require(f"{local} is True or {local} is False")
        elif kind.startswith("float"):
            self._floats.append(local)
        elif kind != "byte":
            self._ints.append(local)
        primitive = PRIMITIVES[kind]
        self._run.append(Item(primitive.code, primitive.size, local))

    def _check_scalars(self) -> None:
        """Check the classes of all numbers so far in a single statement."""
        for name, look in (("int", whole_numbers), ("float", real_numbers)):
            values = self._ints if name == "int" else self._floats
            if values:
                usual = " and ".join(f"{value}.__class__ is {name}" for value in values)
                closer = self._source.constant("check", look)
                self._source.line(f"if not ({usual}): {closer}({', '.join(values)})")
                values.clear()

    def _text(self, kind: FieldType, name: str, value: str) -> None:
        source = self._source
        local, size = source.local(name), source.local("n")
        if kind.string_bound is not None:
            source.line(f"{local} = {value}")
            source.require(f"len({local}) <= {kind.string_bound}")
            value = local
        if kind.kind == "wstring":
            source.line(f"{local} = {source.constant('wide', wide_bytes)}({value})")
            source.line(f"{size} = len({local})")
            self._run.append(Item("I", COUNT_SIZE, f"{size} >> 2"))
            self._variable(local, size, COUNT_SIZE)
        else:
            source.line(f"{local} = {source.constant('utf8', str.encode)}({value})")
            source.line(f"{size} = len({local})")
            self._run.append(Item("I", COUNT_SIZE, f"{size} + 1"))
            if self._offset is not None and all(item.code != TEXT for item in self._run):
                self._run.append(Item(TEXT, 1, local))
                self._text_size = size
            else:
                self._variable(local, size, 1)
            # The NUL at the end of the string belongs to the next run.
            self._run.append(Item("x", 1))

    def _strings(self, kind: FieldType, local: str, after: int) -> None:
        source = self._source
        source.require(f"{local}.__class__ is list")
        self._count(kind, f"len({local})")
        if kind.string_bound is not None:
            source.require(f"max(map(len, {local}), default=0) <= {kind.string_bound}")
        block = source.local("block")
        exact = kind.kind == "string" and after < COUNT_SIZE
        write = wide_strings if kind.kind == "wstring" else StringsWriter(exact=exact)
        source.line(f"{block} = {source.constant('texts', write)}({local})")
        self._variable(block, f"len({block})", 1 if exact else COUNT_SIZE)

    def _octets(self, kind: FieldType, local: str) -> None:
        source = self._source
        fallback = source.constant("octets", octets)
        if kind.container == "array":
            source.line(f"if {local}.__class__ is not bytes: {local} = bytes({fallback}({local}))")
            source.require(f"len({local}) == {kind.size}")
            self._run.append(Item(f"{kind.size}s", 1, local))
            return
        source.line(f"if {local}.__class__ is not bytes: {local} = {fallback}({local})")
        size = source.local("n")
        source.line(f"{size} = len({local})")
        self._count(kind, size)
        self._variable(local, size, 1)

    def _numbers(self, kind: FieldType, local: str) -> None:
        source = self._source
        primitive = PRIMITIVES[kind.kind]
        closer = source.constant("usual", array_coercer(primitive.dtype, primitive.code))
        if "numpy" in sys.modules:
            import numpy as np

            dtype = source.constant("dtype", np.dtype(f"<{primitive.dtype}"))
            array = source.constant("ndarray", np.ndarray)
            unusual = f"{local}.__class__ is not {array} or {local}.dtype is not {dtype}"
            source.line(f"if {unusual}: {local} = {closer}({local})")
        else:  # so far there are no arrays: a node whose types have none starts without numpy
            source.line(f"{local} = {closer}({local})")
        source.require(f"{local}.ndim == 1")
        if kind.container == "array":
            source.require(f"len({local}) == {kind.size}")
            size = kind.size * primitive.size
            self._run.append(Item(f"{size}s", primitive.size, f"{local}.tobytes()"))
            return
        count = source.local("n")
        source.line(f"{count} = len({local})")
        self._count(kind, count)
        self._align_elements(primitive.size, count)
        size_text = count if primitive.size == 1 else f"{primitive.size} * {count}"
        self._variable(local, size_text, primitive.size)

    def _messages(self, kind: FieldType, cls: Any, local: str) -> None:
        source = self._source
        source.require(f"{local}.__class__ is list")
        count = source.local("n")
        source.line(f"{count} = len({local})")
        self._count(kind, count)
        self._flush()
        alignment = uniform_alignment(cls)
        if alignment is not None and kind.container != "array":
            self._align_elements(alignment, count)
        self._spill()
        element = source.local("element")
        if alignment is not None and kind.container != "array":
            with source.loop(f"for {element} in {local}:"):
                self._message(cls, element, after=1)
                packed = struct.Struct(lay_out(self._run, len(HEADER)))
                values = ", ".join(item.value for item in self._run if item.value)
                source.line(f"out.append({self._packing(packed, values)})")
                self._run.clear()
            self._move(f"{packed.size} * {count}", alignment)
        else:
            self._forget_offset()
            with source.loop(f"for {element} in {local}:"):
                self._element(cls, element)

    def _element(self, cls: Any, local: str) -> None:
        """Encode a nested message with the function of its class."""
        source = self._source
        write = source.constant("write", element_encoder(cls, self._family))
        source.line(f"pos = {write}(out, pos, {local})")
        self._unknown()

    # Runs and positions

    def _unknown(self) -> None:
        """Record that nothing is known about `pos`."""
        self._offset = None
        self._modulus, self._residue = 1, 0

    def _forget_offset(self) -> None:
        """Store the known offset in the variable `pos`."""
        if self._offset is not None:
            self._source.line(f"pos = {self._offset}")
            self._offset = None

    def _count(self, kind: FieldType, count: str) -> None:
        """Add the number of elements to the run, or check it for arrays of fixed size."""
        if kind.container == "array":
            self._source.require(f"{count} == {kind.size}")
            self._run.append(Item("", first_alignment(kind)))
            return
        if kind.container == "bounded":
            self._source.require(f"{count} <= {kind.size}")
        self._run.append(Item("I", COUNT_SIZE, count))

    def _align_elements(self, alignment: int, count: str) -> None:
        """Add the padding between a count and larger elements; an empty sequence has none."""
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
        """Add a part whose size depends on the message."""
        self._flush()
        self._parts.append(part)
        self._move(size, alignment)

    def _move(self, size: str, alignment: int) -> None:
        """Move `pos` by `size` bytes, which is always a multiple of `alignment`."""
        if self._offset is None:
            self._source.position(f"pos += {size}")
        else:
            self._source.position(f"pos = {self._offset} + {size}")
            self._offset = None
        # The value was aligned at its start, as far as that is known.
        self._modulus = min(alignment, self._modulus)
        self._residue = len(HEADER) % self._modulus

    def _flush(self) -> None:
        """Pack the current run and start a new one."""
        if not self._run:
            return
        run, self._run = self._run, []
        values = ", ".join(item.value for item in run if item.value)
        if any(item.code == TEXT for item in run):
            self._pack_text(run, values)
            return
        structs = phase_structs(run, range(self._residue, PHASES, self._modulus))
        packer = structs[self._residue]
        if len({packer.format for packer in structs.values()}) == 1:
            if packer.size:
                self._parts.append(self._packing(packer, values))
            if self._offset is not None:
                self._offset += packer.size
            else:
                self._source.position(f"pos += {packer.size}")
        else:
            self._pack_by_phase(structs, values)
        self._ends({phase + packer.size for phase, packer in structs.items()})

    def _ends(self, places: set[int]) -> None:
        """Record the offsets, modulo `PHASES`, where a run may have ended."""
        self._modulus = modulus_of(places)
        self._residue = places.pop() % self._modulus

    def _packing(self, packed: struct.Struct, values: str) -> str:
        """Return the expression of a run whose padding does not depend on its start."""
        if not values:
            return self._source.constant("zeros", packed.pack())
        return f"{self._source.constant('pack', packed.pack)}({values})"

    def _pack_by_phase(self, structs: dict[int, struct.Struct], values: str) -> None:
        """Pack a run whose padding depends on its start."""
        source = self._source
        table = [structs.get(phase, struct.Struct("")) for phase in range(PHASES)]
        steps = source.constant("sizes", tuple(packer.size for packer in table))
        part, phase = source.local("run"), source.local("phase")
        source.line(f"{phase} = pos & {PHASES - 1}")
        if values:
            packs = source.constant("packs", tuple(packer.pack for packer in table))
            source.line(f"{part} = {packs}[{phase}]({values})")
        else:
            zeros = source.constant("zeros", tuple(bytes(packer.size) for packer in table))
            source.line(f"{part} = {zeros}[{phase}]")
        self._parts.append(part)
        source.position(f"pos += {steps}[{phase}]")

    def _pack_text(self, run: list[Item], values: str) -> None:
        """Pack a run that contains a string."""
        source = self._source
        assert self._offset is not None  # noqa: S101 - otherwise the string is a separate part
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
        """Move the parts so far into the list `out`, before a loop appends to it."""
        if not self._listed:
            self._source.line(f"out = [{', '.join(self._parts)}]")
            self._listed = True
        elif self._parts:
            self._source.line(f"out += ({', '.join(self._parts)},)")
        self._parts.clear()
