"""Writes, for one message type, the function that encodes its messages.

Single nested messages are unfolded, so that runs of values of fixed size, across nesting, are
packed by one `struct.Struct`. Where a run starts after something of variable length, there is one
Struct for each of the eight places, differing in alignment, that `pos` can have. The function takes
messages in their usual form (ndarrays of the field's dtype, lists of str); all others it leaves to
a slower one, which has the verdict too.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import TYPE_CHECKING, Any, Final, TypeVar

from aionode.message import fields, type_name
from aionode.wire.layout import (
    COUNT_SIZE,
    HEADER,
    PRIMITIVES,
    first_alignment,
    is_small,
    uniform_alignment,
)
from aionode.wire.packing import TEXT, Item, lay_out
from aionode.wire.source import Misfit
from aionode.wire.texts import TextsWriter, wide_bytes, wide_texts
from aionode.wire.usual import octets, real_numbers, usual_array, whole_numbers
from aionode.wire.writing import Writing

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.message import FieldType

__all__ = ["JOIN", "MISFITS", "generate_encoder", "views"]

Encoded = TypeVar("Encoded")

JOIN: Final = b"".join

LARGE: Final = 1 << 12
"""From so many elements on a part stands for itself; what is smaller costs less when joined."""

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


def generate_encoder(
    cls: Any,
    plain: Callable[[Any], Encoded],
    finish: Callable[[Sequence[Any]], Encoded],
) -> Callable[..., Encoded]:
    """Return the function that encodes messages of class `cls`.

    Args:
        cls: A message class.
        plain: Encodes a message that is not of the usual form, or raises its error. It may call
            the function again with True after the message, and then gets what went wrong.
        finish: Makes the result of the parts, which are bytes and the message's own arrays: `JOIN`
            or `views`.
    """
    return Encoding(cls).whole(plain, finish)


def views(parts: Sequence[Any]) -> list[bytes | memoryview]:
    """Return `parts` as bytes and as read-only views of their single bytes, small ones joined."""
    found: list[bytes | memoryview] = []
    begin = 0
    for place in [number for number, part in enumerate(parts) if len(part) >= LARGE]:
        if begin < place:
            found.append(JOIN(parts[begin:place]))
        part = parts[place]
        found.append(part if part.__class__ is bytes else memoryview(part).cast("B").toreadonly())
        begin = place + 1
    if begin < len(parts):
        found.append(JOIN(parts[begin:]))
    return found


@cache
def element_encoder(cls: Any) -> Callable[[list[bytes], int, Any], int]:
    """Return the function that appends one message to a list of parts, and gives the new `pos`."""
    return Encoding(cls).element()


class Encoding(Writing):
    """One encoder while it is being written: what a message consists of."""

    def __init__(self, cls: Any) -> None:
        super().__init__()
        self._cls = cls
        self._ints: list[str] = []
        self._floats: list[str] = []

    def whole(
        self, plain: Callable[[Any], Encoded], finish: Callable[[Sequence[Any]], Encoded]
    ) -> Callable[..., Encoded]:
        """Compile the function that encodes a message; `again` is for `plain`, not to be called."""
        source = self._source
        fallback = source.constant("plain", plain)
        misfits = source.constant("misfits", MISFITS)
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
        source.line(f"return {fallback}(msg)")
        return source.function("def encode(msg, again=False):", type_name(self._cls))

    def element(self) -> Callable[[list[bytes], int, Any], int]:
        """Compile the function that writes one message after others."""
        self._listed = True
        self._unknown()
        self._message(self._cls, "msg", after=1)
        self._flush()
        self._spill()
        self._source.line("return pos")
        return self._source.function("def write(out, pos, msg):", type_name(self._cls))

    def _message(self, cls: Any, owner: str, after: int) -> None:
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
            self._texts(kind, local, after)
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
        # What struct would take, though it does not fit: the truth of anything, and what has a
        # number's methods. Ranges it knows.
        if kind == "bool":
            source.require(f"{local} is True or {local} is False")
        elif kind.startswith("float"):
            self._floats.append(local)
        elif kind != "byte":
            self._ints.append(local)
        primitive = PRIMITIVES[kind]
        self._run.append(Item(primitive.code, primitive.size, local))

    def _check_scalars(self) -> None:
        """Write one statement for all numbers so far: most are of Python's own classes."""
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
            # The NUL that ends a string opens the next run.
            self._run.append(Item("x", 1))

    def _texts(self, kind: FieldType, local: str, after: int) -> None:
        source = self._source
        source.require(f"{local}.__class__ is list")
        self._count(kind, f"len({local})")
        if kind.string_bound is not None:
            source.require(f"max(map(len, {local}), default=0) <= {kind.string_bound}")
        block = source.local("block")
        exact = kind.kind == "string" and after < COUNT_SIZE
        write = wide_texts if kind.kind == "wstring" else TextsWriter(exact=exact)
        source.line(f"{block} = {source.constant('texts', write)}({local})")
        self._variable(block, f"len({block})", 1 if exact else COUNT_SIZE)

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
        closer = source.constant("usual", usual_array)
        unusual = f"{local}.__class__ is not {array} or {local}.dtype is not {dtype}"
        source.line(f"if {unusual}: {local} = {closer}({local}, {dtype}, {primitive.code!r})")
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
        """Write one message by the function of its class."""
        source = self._source
        write = source.constant("write", element_encoder(cls))
        source.line(f"pos = {write}(out, pos, {local})")
        self._unknown()
