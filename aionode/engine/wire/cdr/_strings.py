"""Encoded strings: UTF-8 with a length and a NUL; wide strings with four bytes per character."""

from __future__ import annotations

import struct
from typing import Any

from aionode.engine.wire.cdr._codegen import NeedsFallback
from aionode.engine.wire.cdr._constants import COUNT_SIZE

__all__ = [
    "StringsReader",
    "StringsWriter",
    "read_wide_strings",
    "repaired_wide_string",
    "wide_bytes",
    "wide_string",
    "wide_strings",
]

COUNT = struct.Struct("<I")

MAX_KEPT = 4096
"""Maximum size of a block of strings that is cached, in bytes; longer ones rarely repeat."""


def gap_after(size: int) -> int:
    """Return the padding between a string of `size` bytes and the length of the next one."""
    return -size % COUNT_SIZE


PACKS = [struct.Struct(f"<I{size}s{gap_after(size)}x").pack for size in range(64)]
"""Functions that pack a short string with length, NUL and padding, by size with the NUL."""


class StringsWriter:
    """Encodes the strings of one field, and caches those of the last message.

    A robot's joints keep their names, so a single comparison usually saves encoding all strings.
    """

    def __init__(self, *, exact: bool) -> None:
        self._exact = exact
        self._last: tuple[list[str], bytes] = ([], b"")

    def __call__(self, strings: list[str]) -> bytes:
        """Return the encoded strings, each padded to the alignment of the next.

        The first one starts aligned. The last one has no padding if `exact` was given.
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
        if len(block) <= MAX_KEPT:
            self._last = strings.copy(), block
        return block


class StringsReader:
    """Decodes the strings of one field, and caches those of the last message."""

    def __init__(self) -> None:
        self._last: tuple[int, bytes, list[str]] = (0, b"", [])

    def __call__(self, data: Any, pos: int, count: int) -> tuple[list[str], int]:
        """Decode `count` strings from the aligned offset `pos`; also return their end offset."""
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
        if end - pos <= MAX_KEPT:
            self._last = count, bytes(data[pos:end]), strings.copy()
        return strings, end


def wide_bytes(text: str) -> bytes:
    """Encode a wide string.

    ROS holds it as UTF-16 and encodes each half of a surrogate pair as a separate character.
    """
    data = str.encode(text, "utf-16-le")
    units = len(data) // 2
    if units == len(text):
        return text.encode("utf-32-le")
    return struct.pack(f"<{units}I", *struct.unpack(f"<{units}H", data))


def wide_strings(strings: list[str]) -> bytes:
    """Encode a sequence of wide strings."""
    encoded = map(wide_bytes, strings)
    return b"".join([COUNT.pack(len(data) // 4) + data for data in encoded])


def wide_string(data: Any, order: str = "<") -> str:
    """Decode a wide string, whether written as UTF-16 units or as UTF-32.

    Raises:
        ValueError: a character is invalid, or half of a surrogate pair is missing.
    """
    units = struct.unpack(f"{order}{len(data) // 4}I", data)
    if not any(0xD800 <= unit < 0xE000 for unit in units):
        return str(data, "utf-32-le" if order == "<" else "utf-32-be")
    if max(units) >= 0x10000:
        raise UnicodeDecodeError(
            "utf-16", bytes(data), 0, len(data), "surrogate pairs mixed with UTF-32"
        )
    return struct.pack(f"<{len(units)}H", *units).decode("utf-16-le")


def repaired_wide_string(data: Any, order: str) -> str:
    """Decode a wide string, with U+FFFD for whatever is neither UTF-16 nor UTF-32."""
    units = struct.unpack(f"{order}{len(data) // 4}I", data)
    octets = b"".join(
        struct.pack("<H", unit)
        if unit < 0x10000
        else chr(unit if unit < 0x110000 else 0xFFFD).encode("utf-16-le")
        for unit in units
    )
    return octets.decode("utf-16-le", "replace")


def read_wide_strings(data: Any, pos: int, count: int) -> tuple[list[str], int]:
    """Decode `count` wide strings from the aligned offset `pos`; also return their end offset."""
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
