"""Decodes any message field by field: slower than the generated functions, but more lenient.

It accepts both byte orders and the output of writers that are less strict than ROS, and its errors
name the field and the offset. Invalid Unicode is only decoded here, with U+FFFD for the invalid
parts, as in rclpy. Lengths are checked against the remaining bytes before anything is allocated, so
a corrupt length cannot make the result much larger than the data.
"""

from __future__ import annotations

import struct
from array import array
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NoReturn

from aionode.engine.wire._replaced_texts import REPLACED_TEXTS
from aionode.engine.wire.cdr._constants import COUNT_SIZE, HEADER, NOTHING
from aionode.engine.wire.cdr._family import OWN, MessageFamily
from aionode.engine.wire.cdr._layout import PRIMITIVES, Primitive, minimum_size, padding
from aionode.engine.wire.cdr._strings import repaired_wide_string, wide_string
from aionode.errors import DecodeError
from aionode.message import fields, type_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.message import FieldType, Message

__all__ = ["decode_slowly"]

ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<"}
"""Byte order by the first two bytes; later encodings, which ROS 2 does not use, have others."""


def decode_slowly(cls: type[Message], data: memoryview, family: MessageFamily = OWN) -> Any:
    """Return the message in `data`, an object of `family`.

    Raises:
        DecodeError: the data does not hold a message of this class.
    """
    return FallbackDecoder(cls, data, family).whole()


class FallbackDecoder:
    """Decodes one message."""

    def __init__(self, cls: type[Message], data: memoryview, family: MessageFamily) -> None:
        self._cls = cls
        self._family = family
        self._data = data
        self._pos = 0
        self._path = ""
        self._order = "<"
        self._replaced: tuple[str, bytes] | None = None
        """Location and bytes of the first text with invalid Unicode."""

    def whole(self) -> Any:
        """Decode the header and the message after it."""
        start = bytes(self._take(len(HEADER), "the encapsulation header")[:2])
        if start not in ORDERS:
            self._pos = 0
            self._fail(
                f"starts with {start.hex(' ')}, expected 00 01 (CDR, little endian) or 00 00"
            )
        self._order = ORDERS[start]
        message = self._message(self._cls)
        if self._replaced is not None:
            REPLACED_TEXTS.note(type_name(self._cls), *self._replaced)
        return message

    def _message(self, cls: type[Message]) -> Any:
        described = fields(cls)
        if not described:
            self._take(1, "the single byte of a message without fields")
        values = []
        for field in described:
            with self._inside(f".{field.name}"):
                values.append(self._field(field.type))
        return self._family.constructor(cls)(*values)

    def _field(self, kind: FieldType) -> Any:
        if kind.container == "single":
            return self._element(kind)
        count = kind.size if kind.container == "array" else self._count("elements")
        if kind.container == "bounded" and count > kind.size:
            self._fail(f"{count} elements, at most {kind.size} are allowed")
        if kind.form == "bytes":
            data = self._take(count, f"{count} elements")
            # As in the generated functions: arrays are copied, sequences are views.
            return bytes(data) if kind.container == "array" else data
        if kind.form == "ndarray":
            return self._array(kind, count)
        least = minimum_size(kind.nested) if kind.nested is not None else COUNT_SIZE
        self._need(count * least, f"{count} elements")
        elements = []
        for index in range(count):
            with self._inside(f"[{index}]"):
                elements.append(self._element(kind))
        return elements

    def _element(self, kind: FieldType) -> Any:
        if kind.nested is not None:
            return self._message(kind.nested)
        if kind.kind in PRIMITIVES:
            primitive = PRIMITIVES[kind.kind]
            self._align(primitive.size)
            data = self._take(primitive.size, f"{primitive.size} bytes")
            return struct.unpack(self._order + primitive.code, data)[0]
        text = self._wide_text() if kind.kind == "wstring" else self._text()
        if kind.string_bound is not None and len(text) > kind.string_bound:
            self._fail(f"{len(text)} characters, at most {kind.string_bound} are allowed")
        return text

    def _text(self) -> str:
        size = self._count("bytes of text")
        data = bytes(self._take(size, f"{size} bytes of text"))
        # Some writers omit the NUL, or write a length of 0 for an empty string.
        data = data.removesuffix(b"\0")
        try:
            return data.decode()
        except UnicodeDecodeError:
            self._replaced = self._replaced or (self._path, data)
            return data.decode(errors="replace")

    def _wide_text(self) -> str:
        count = self._count("characters")
        data = self._take(4 * count, f"{count} characters of 4 bytes")
        try:
            return wide_string(data, self._order)
        except UnicodeDecodeError:
            self._replaced = self._replaced or (self._path, bytes(data))
            return repaired_wide_string(data, self._order)

    def _array(self, kind: FieldType, count: int) -> Any:
        primitive = PRIMITIVES[kind.kind]
        if count:
            self._align(primitive.size)
        data = self._take(primitive.size * count, f"{count} elements of {primitive.size} bytes")
        if not self._family.has_arrays and kind.container != "array":
            return self._numbers(data, primitive)
        import numpy as np

        if kind.kind == "bool":
            array = np.frombuffer(data, np.uint8) != 0
        else:
            array = np.frombuffer(data, f"{self._order}{primitive.dtype}")
            # Subscribers get arrays in native byte order.
            array = array.astype(array.dtype.newbyteorder("="), copy=False)
        array.flags.writeable = False
        return array

    def _numbers(self, data: memoryview, primitive: Primitive) -> memoryview:
        """Return a memoryview of numbers in native byte order."""
        if not data:
            return NOTHING
        if primitive.size == 1 or self._order == "<":
            return data.cast(primitive.code)  # type: ignore[call-overload, no-any-return]  # as `_coerce` does
        numbers = array(primitive.code, bytes(data))
        numbers.byteswap()
        return memoryview(numbers)

    def _count(self, what: str) -> int:
        self._align(COUNT_SIZE)
        data = self._take(COUNT_SIZE, f"the number of {what}")
        count: int = struct.unpack(f"{self._order}I", data)[0]
        return count

    def _align(self, alignment: int) -> None:
        self._pos += padding(self._pos, alignment)

    def _take(self, size: int, what: str) -> memoryview:
        self._need(size, what)
        self._pos += size
        return self._data[self._pos - size : self._pos]

    def _need(self, size: int, what: str) -> None:
        left = max(0, len(self._data) - self._pos)
        if size > left:
            self._fail(f"{what} needed, {left} bytes left")

    @contextmanager
    def _inside(self, step: str) -> Iterator[None]:
        """Add `step` to the path shown in errors."""
        before = self._path
        self._path += step
        yield
        self._path = before

    def _fail(self, problem: str) -> NoReturn:
        raise DecodeError(type_name(self._cls), self._path.removeprefix("."), self._pos, problem)
