"""Writes, for one message type, the function that encodes its messages.

Single nested messages are unfolded, so that runs of values of fixed size, across nesting, are packed
by one `struct.Struct`. Where a run starts after something of variable length, there is one Struct
for each of the eight places that `pos` can have, all made ahead. The function takes messages in
their usual form (ndarrays of the field's dtype, lists of str); for anything else it leaves the
work, and the verdict, to the plain codec.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from aionode.message import fields, type_name
from aionode.wire.layout import (
    COUNT_SIZE,
    HEADER,
    PRIMITIVES,
    first_alignment,
    is_small,
    padding,
    uniform_alignment,
)
from aionode.wire.source import Misfit, Source
from aionode.wire.texts import padded_texts, wide_bytes, wide_texts

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.message import FieldType

__all__ = ["MISFITS", "generate_encoder"]

MISFITS = (
    Misfit,
    struct.error,
    AttributeError,
    BufferError,
    OverflowError,
    TypeError,
    ValueError,
)
"""What the generated function meets when a message is not of the usual form."""

PHASES = 8
"""Places that differ in alignment."""


@dataclass(frozen=True, slots=True)
class Item:
    """One value of a run: its code for `struct`, and the expression that is packed, if any."""

    code: str
    alignment: int
    value: str = ""


def octets(value: object) -> Any:
    """Return `value` if its bytes are what is sent."""
    if isinstance(value, bytes | bytearray):
        return value
    if isinstance(value, memoryview) and value.format == "B" and value.ndim == 1:
        return value
    raise Misfit


def base_array(value: object) -> Any:
    """Return an object of a subclass of ndarray, such as a memmap, as an ndarray."""
    import numpy as np  # noqa: PLC0415 - only where a type needs it

    if not isinstance(value, np.ndarray):
        raise Misfit
    return value.view(np.ndarray)


def generate_encoder(cls: type[Any], plain: Callable[[Any], bytes]) -> Callable[..., bytes]:
    """Return the function that encodes messages of class `cls`.

    Args:
        cls: A message class.
        plain: Encodes a message that is not of the usual form, or raises its error. It may call
            the function again with True after the message, and then gets what went wrong.
    """
    return Encoding(cls).whole(plain)


@cache
def element_encoder(cls: type[Any]) -> Callable[[list[bytes], int, Any], int]:
    """Return the function that appends one message to a list of parts, and gives the new `pos`."""
    return Encoding(cls).element()


class Encoding:
    """One encoder while it is being written.

    What is known of `pos` at the place reached: its value as `_offset`, or None where that depends
    on the message; in any case that it is `_residue` modulo `_modulus`.
    """

    def __init__(self, cls: type[Any]) -> None:
        self._cls = cls
        self._source = Source()
        self._run: list[Item] = []
        self._parts: list[str] = []
        self._listed = False
        self._offset: int | None = 0
        self._modulus, self._residue = PHASES, 0

    def whole(self, plain: Callable[[Any], bytes]) -> Callable[..., bytes]:
        """Compile the function that encodes a message; `again` is for `plain`, not to be called."""
        source = self._source
        fallback = source.constant("plain", plain)
        misfits = source.constant("misfits", MISFITS)
        join = source.constant("join", b"".join)
        with source.block("try:"):
            self._run.append(Item(f"{len(HEADER)}s", 1, source.constant("header", HEADER)))
            self._message(self._cls, "msg", after=1)
            self._flush()
            if self._listed:
                self._spill()
                result = "out"
            else:
                result = f"({', '.join(self._parts)},)"
            source.line(f"return {join}({result})")
        with source.block(f"except {misfits}:"):
            source.line("if again: raise")
        source.line(f"return {fallback}(msg)")
        return source.function("def encode(msg, again=False):", type_name(self._cls))

    def element(self) -> Callable[[list[bytes], int, Any], int]:
        """Compile the function that writes one message after others."""
        self._listed = True
        self._offset = None
        self._modulus, self._residue = 1, 0
        self._message(self._cls, "msg", after=1)
        self._flush()
        self._spill()
        self._source.reads_position()
        self._source.line("return pos")
        return self._source.function("def write(out, pos, msg):", type_name(self._cls))

    # What a message consists of.

    def _message(self, cls: type[Any], owner: str, after: int) -> None:
        """Write all fields; what follows them is aligned to `after`."""
        self._source.require(f"{owner}.__class__ is {self._source.constant('T', cls)}")
        described = fields(cls)
        if not described:
            self._run.append(Item("x", 1))
        for number, field in enumerate(described, 1):
            following = described[number:]
            self._field(
                field.type,
                field.name,
                f"{owner}.{field.name}",
                first_alignment(following[0].type) if following else after,
            )

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
            self._texts(kind, local, after)
        elif kind.form == "bytes":
            self._octets(kind, local)
        else:
            self._numbers(kind, local)

    def _nested(self, cls: type[Any], name: str, value: str, after: int) -> None:
        local = self._source.local(name)
        self._source.line(f"{local} = {value}")
        if is_small(cls):
            self._message(cls, local, after)
        else:
            self._flush()
            self._spill()
            self._element(cls, local)

    def _scalar(self, kind: str, name: str, value: str) -> None:
        if kind == "bool":
            # struct packs the truth of anything.
            local = self._source.local(name)
            self._source.line(f"{local} = {value}")
            self._source.require(f"{local} is True or {local} is False")
            value = local
        primitive = PRIMITIVES[kind]
        self._run.append(Item(primitive.code, primitive.size, value))

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
            self._variable(local, size, 1)
            # The NUL that ends a string opens the next run.
            self._run.append(Item("x", 1))

    def _texts(self, kind: FieldType, local: str, after: int) -> None:
        source = self._source
        source.require(f"{local}.__class__ is list")
        self._count(kind, f"len({local})")
        if kind.string_bound is not None:
            source.require(f"max(map(len, {local}), default=0) <= {kind.string_bound}")
        block = source.local("block")
        if kind.kind == "wstring":
            source.line(f"{block} = {source.constant('wide', wide_texts)}({local})")
        else:
            exact = after < COUNT_SIZE
            function = source.constant("texts", padded_texts)
            source.line(f"{block} = {function}({local}, {exact})")
        exact_text = kind.kind == "string" and after < COUNT_SIZE
        self._variable(block, f"len({block})", 1 if exact_text else COUNT_SIZE)

    def _octets(self, kind: FieldType, local: str) -> None:
        source = self._source
        plain = source.constant("octets", octets)
        if kind.container == "array":
            source.line(f"if {local}.__class__ is not bytes: {local} = bytes({plain}({local}))")
            source.require(f"len({local}) == {kind.size}")
            self._run.append(Item(f"{kind.size}s", 1, local))
            return
        source.line(f"if {local}.__class__ is not bytes: {local} = {plain}({local})")
        size = source.local("n")
        source.line(f"{size} = len({local})")
        self._count(kind, size)
        self._variable(local, size, 1)

    def _numbers(self, kind: FieldType, local: str) -> None:
        import numpy as np

        source = self._source
        primitive = PRIMITIVES[kind.kind]
        dtype = source.constant("dtype", np.dtype(f"<{primitive.dtype}"))
        array = source.constant("ndarray", np.ndarray)
        base = source.constant("base_array", base_array)
        source.line(f"if {local}.__class__ is not {array}: {local} = {base}({local})")
        source.require(f"{local}.dtype == {dtype} and {local}.ndim == 1")
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

    def _messages(self, kind: FieldType, cls: type[Any], local: str) -> None:
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
                values = [item.value for item in self._run if item.value]
                source.line(f"out.append({self._packing(packed, values)})")
                self._run.clear()
            self._move(f"{packed.size} * {count}", alignment)
        else:
            with source.loop(f"for {element} in {local}:"):
                self._element(cls, element)

    def _element(self, cls: type[Any], local: str) -> None:
        """Write one message by the function of its class."""
        source = self._source
        source.reads_position()
        pos = "pos" if self._offset is None else str(self._offset)
        write = source.constant("write", element_encoder(cls))
        source.line(f"pos = {write}(out, {pos}, {local})")
        self._offset = None
        self._modulus, self._residue = 1, 0

    # How it goes out.

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
            source.reads_position()
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
        known = min(alignment, self._modulus)
        while self._residue % known != len(HEADER) % known:
            known //= 2
        self._modulus, self._residue = known, len(HEADER) % known

    def _flush(self) -> None:
        """Pack the run collected so far."""
        if not self._run:
            return
        run, self._run = self._run, []
        phases = range(self._residue, PHASES, self._modulus)
        layouts = {phase: lay_out(run, phase) for phase in phases}
        sizes = {phase: struct.calcsize(layout) for phase, layout in layouts.items()}
        values = [item.value for item in run if item.value]
        if len(set(layouts.values())) == 1:
            layout = layouts[self._residue]
            size = sizes[self._residue]
            if size:
                packed = struct.Struct(layout)
                self._parts.append(self._packing(packed, values))
            if self._offset is not None:
                self._offset += size
            else:
                self._source.position(f"pos += {size}")
        else:
            self._flush_by_phase(layouts, sizes, values)
        ends = {(phase + sizes[phase]) % PHASES for phase in phases}
        self._modulus = PHASES
        while len({end % self._modulus for end in ends}) > 1:
            self._modulus //= 2
        self._residue = ends.pop() % self._modulus

    def _packing(self, packed: struct.Struct, values: list[str]) -> str:
        if not values:
            return self._source.constant("zeros", packed.pack())
        return f"{self._source.constant('pack', packed.pack)}({', '.join(values)})"

    def _flush_by_phase(
        self, layouts: dict[int, str], sizes: dict[int, int], values: list[str]
    ) -> None:
        source = self._source
        structs = [struct.Struct(layouts.get(phase, "<")) for phase in range(PHASES)]
        steps = source.constant("sizes", tuple(sizes.get(phase, 0) for phase in range(PHASES)))
        part, phase = source.local("run"), source.local("phase")
        source.reads_position()
        source.line(f"{phase} = pos & {PHASES - 1}")
        if values:
            packs = source.constant("packs", tuple(one.pack for one in structs))
            source.line(f"{part} = {packs}[{phase}]({', '.join(values)})")
        else:
            zeros = source.constant("zeros", tuple(one.pack() for one in structs))
            source.line(f"{part} = {zeros}[{phase}]")
        self._parts.append(part)
        source.position(f"pos += {steps}[{phase}]")

    def _spill(self) -> None:
        """Move the parts named so far into the list `out`, before a loop adds to it."""
        if not self._listed:
            self._source.line(f"out = [{', '.join(self._parts)}]")
            self._listed = True
        elif self._parts:
            self._source.line(f"out += ({', '.join(self._parts)},)")
        self._parts.clear()


def lay_out(run: list[Item], phase: int) -> str:
    """Return the Struct format of a run that starts at `phase`, padding written out."""
    layout = "<"
    for item in run:
        gap = padding(phase + struct.calcsize(layout), item.alignment)
        layout += f"{gap}x{item.code}" if gap else item.code
    return layout
