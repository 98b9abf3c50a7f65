"""Strings on the wire: UTF-8 with a length and a NUL, and wide ones, four bytes per character."""

from __future__ import annotations

import struct
from typing import Any

from aionode.wire.cdr._codegen import NeedsFallback
from aionode.wire.cdr._layout import COUNT_SIZE

__all__ = [
    "StringsReader",
    "StringsWriter",
    "read_wide_strings",
    "wide_bytes",
    "wide_string",
    "wide_strings",
]

COUNT = struct.Struct("<I")

LARGEST_KEPT = 4096
"""Bytes of strings that are kept for the next message; longer ones do not repeat."""


def gap_after(size: int) -> int:
    """Return the padding between a string of `size` bytes and the next one's length."""
    return -size % COUNT_SIZE


PACKS = [struct.Struct(f"<I{size}s{gap_after(size)}x").pack for size in range(64)]
"""What packs a short string with its length, NUL and padding, by its size, NUL included."""


class StringsWriter:
    """Writes the strings of one field. Those of the last message are known when they come again.

    A robot's joints keep their names, so one comparison mostly saves encoding all strings.
    """

    def __init__(self, *, exact: bool) -> None:
        self._exact = exact
        self._last: tuple[list[str], bytes] = ([], b"")

    def __call__(self, strings: list[str]) -> bytes:
        """Return the strings as they are from an aligned place, each padded for the next.

        The last one has no padding if the writer is to be exact.
        """
        known, block = self._last
        if strings == known:
            return block
        parts: list[bytes] = []
        size = COUNT_SIZE
        for data in map(str.encode, strings):
            size = len(data) + 1
            if size < len(PACKS):
                parts.append(PACKS[size](size, data))
            else:
                parts.append(COUNT.pack(size) + data + bytes(1 + gap_after(size)))
        block = b"".join(parts)
        if self._exact:
            block = block[: len(block) - gap_after(size)]
        if len(block) <= LARGEST_KEPT:
            self._last = strings.copy(), block
        return block


class StringsReader:
    """Reads the strings of one field; knows those of the last message, as `StringsWriter` does."""

    def __init__(self) -> None:
        self._last: tuple[int, bytes, list[str]] = (0, b"", [])

    def __call__(self, data: Any, pos: int, count: int) -> tuple[list[str], int]:
        """Return `count` strings from `pos` (aligned), and where they end."""
        known_count, block, known = self._last
        if count == known_count and data[pos : pos + len(block)] == block:
            return known.copy(), pos + len(block)
        if COUNT_SIZE * count > len(data) - pos:
            raise NeedsFallback
        strings = []
        end = pos
        of_bytes = data.__class__ is bytes
        for _ in range(count):
            start = (end + 3 & -4) + COUNT_SIZE
            (size,) = COUNT.unpack_from(data, start - COUNT_SIZE)
            end = start + size
            if data[end - 1]:
                raise NeedsFallback
            text = data[start : end - 1]
            strings.append(text.decode() if of_bytes else str(text, "utf-8"))
        if end - pos <= LARGEST_KEPT:
            self._last = count, bytes(data[pos:end]), strings.copy()
        return strings, end


def wide_bytes(text: str) -> bytes:
    """Return the characters of a wide string.

    ROS holds it as UTF-16, and writes each half of a surrogate pair as a character of its own.
    """
    data = str.encode(text, "utf-16-le")
    units = len(data) // 2
    if units == len(text):
        return text.encode("utf-32-le")
    return struct.pack(f"<{units}I", *struct.unpack(f"<{units}H", data))


def wide_strings(strings: list[str]) -> bytes:
    """Return the wide strings of a sequence."""
    encoded = map(wide_bytes, strings)
    return b"".join([COUNT.pack(len(data) // 4) + data for data in encoded])


def wide_string(data: Any, order: str = "<") -> str:
    """Return the wide string of these bytes, whether its writer used pairs or whole characters.

    Raises:
        ValueError: A character does not exist, or half of a pair is missing.
    """
    units = struct.unpack(f"{order}{len(data) // 4}I", data)
    if not any(0xD800 <= unit < 0xE000 for unit in units):
        return str(data, "utf-32-le" if order == "<" else "utf-32-be")
    if max(units) >= 0x10000:
        raise UnicodeDecodeError("utf-16", bytes(data), 0, len(data), "pairs and whole characters")
    return struct.pack(f"<{len(units)}H", *units).decode("utf-16-le")


def read_wide_strings(data: Any, pos: int, count: int) -> tuple[list[str], int]:
    """Return `count` wide strings from `pos` (aligned), and where they end."""
    if COUNT_SIZE * count > len(data) - pos:
        raise NeedsFallback
    strings = []
    for _ in range(count):
        (units,) = COUNT.unpack_from(data, pos)
        start = pos + COUNT_SIZE
        pos = start + 4 * units
        if pos > len(data):
            raise NeedsFallback
        strings.append(wide_string(data[start:pos]))
    return strings, pos
