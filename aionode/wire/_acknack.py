"""Acknowledgements between publishers and subscriptions of aionode, so that no message is lost.

The terms are those of RTPS. A submessage is one sample sent to one process; ROS nodes do not
receive it::

    version u8 | kind u8 | zero u16 | writer 16 bytes | reader 16 bytes | first i64 | last i64 |
    rest

A receiver ignores samples of an unknown version or kind.
"""

from __future__ import annotations

import enum
import struct
from collections.abc import Sequence
from typing import Final, NamedTuple

__all__ = ["MAX_RANGES", "VERSION", "Kind", "Submessage", "pack", "pack_ranges", "unpack"]

VERSION: Final = 1

MAX_RANGES: Final = 64
"""Largest number of ranges of missing messages in one ACKNACK."""

HEADER: Final = struct.Struct("<BBH16s16sqq")
RANGE: Final = struct.Struct("<qq")


class Kind(enum.IntEnum):
    """The kind of a submessage, which defines the meaning of `first`, `last` and `rest`."""

    HEARTBEAT = 1
    """The writer has sent messages up to `last`; those before `first` are not for this reader.

    `rest` is the writer's participant, to which the reader replies with an ACKNACK.
    """
    ACKNACK = 2
    """The reader has received all messages before `first`; `rest` has the ranges it is missing."""
    GAP = 3
    """The messages from `first` to `last` will not come."""
    DATA = 4
    """Message `first` again, sent at `last` (nanoseconds since 1970); `rest` is its payload."""


class Submessage(NamedTuple):
    """A received submessage."""

    kind: Kind
    writer: bytes
    reader: bytes
    first: int
    last: int
    rest: bytes

    def ranges(self) -> list[tuple[int, int]]:
        """Return the missing ranges of an ACKNACK as pairs of first and last sequence number."""
        size = min(len(self.rest) // RANGE.size, MAX_RANGES) * RANGE.size
        return list(RANGE.iter_unpack(self.rest[:size]))


def pack(
    kind: Kind, writer: bytes, reader: bytes, first: int, last: int, rest: bytes = b""
) -> bytes:
    """Return an encoded submessage."""
    return HEADER.pack(VERSION, kind, 0, writer, reader, first, last) + rest


def pack_ranges(ranges: Sequence[tuple[int, int]]) -> bytes:
    """Return the `rest` of an ACKNACK."""
    return b"".join(RANGE.pack(first, last) for first, last in ranges[:MAX_RANGES])


def unpack(data: bytes) -> Submessage | None:
    """Return the submessage in `data`, or None if its format is unknown."""
    if len(data) < HEADER.size:
        return None
    version, kind, _, writer, reader, first, last = HEADER.unpack_from(data)
    if version != VERSION or kind not in Kind.__members__.values():
        return None
    return Submessage(Kind(kind), writer, reader, first, last, data[HEADER.size :])
