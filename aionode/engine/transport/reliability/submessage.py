"""The submessages of the protocol, which are RTPS's, and their binary form.

Each is for one context. Its bytes are::

    version u8 | kind u8 | zero u16 | writer 16 bytes | reader 16 bytes | first i64 | last i64 |
    rest

A receiver ignores submessages of an unknown version or kind.
"""

from __future__ import annotations

import enum
import struct
from collections.abc import Sequence
from typing import Final

from msgspec import Struct

__all__ = [
    "MAX_RANGES",
    "VERSION",
    "Submessage",
    "SubmessageKind",
    "pack",
    "pack_ranges",
    "unpack",
]

VERSION: Final = 3
"""Contexts of different versions do not acknowledge each other's messages."""

MAX_RANGES: Final = 64
"""Maximum number of missing ranges that one ACKNACK lists."""

LARGEST: Final = 2**63 - 2**20
"""The largest number that is accepted: a reader counts on from it, and its answer must be able to
represent the result."""

HEADER: Final = struct.Struct("<BBH16s16sqq")
RANGE: Final = struct.Struct("<qq")


class SubmessageKind(enum.IntEnum):
    """The kind of a submessage, which determines the meaning of `first`, `last` and the rest."""

    HEARTBEAT = 1
    """The writer has sent messages up to `last`; those before `first` are not for this reader.

    The rest is the writer's participant, to which the reader sends an ACKNACK.
    """
    ACKNACK = 2
    """The reader has everything before `first`. The rest lists missing ranges."""
    GAP = 3
    """The messages from `first` to `last` will not be sent."""
    DATA = 4
    """Message `first` again; `last` is its source time (ns since 1970), the rest its payload."""


KINDS: Final = {int(kind): kind for kind in SubmessageKind}


class Submessage(Struct, frozen=True):
    """A received submessage."""

    kind: SubmessageKind
    writer: bytes
    reader: bytes
    first: int
    last: int
    rest: bytes

    def ranges(self) -> list[tuple[int, int]]:
        """Return the missing ranges of an ACKNACK, as pairs of first and last."""
        size = min(len(self.rest) // RANGE.size, MAX_RANGES) * RANGE.size
        return list(RANGE.iter_unpack(self.rest[:size]))


def pack(
    kind: SubmessageKind, writer: bytes, reader: bytes, first: int, last: int, rest: bytes = b""
) -> bytes:
    """Return a submessage."""
    return HEADER.pack(VERSION, kind, 0, writer, reader, first, last) + rest


def pack_ranges(ranges: Sequence[tuple[int, int]]) -> bytes:
    """Return the rest of an ACKNACK."""
    return b"".join(RANGE.pack(first, last) for first, last in ranges[:MAX_RANGES])


def unpack(data: bytes) -> Submessage | None:
    """Parse a submessage; return None if its format is unknown.

    Numbers beyond `LARGEST` are rejected as well.
    """
    if len(data) < HEADER.size:
        return None
    version, kind, _, writer, reader, first, last = HEADER.unpack_from(data)
    if version != VERSION or kind not in KINDS or max(abs(first), abs(last)) > LARGEST:
        return None
    return Submessage(KINDS[kind], writer, reader, first, last, data[HEADER.size :])
