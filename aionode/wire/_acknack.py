"""What publishers and subscriptions of aionode say to each other so that Zenoh loses nothing.

The words are those of RTPS. Each is one sample for one process, of which ROS nodes hear nothing::

    version u8 | kind u8 | zero u16 | writer 16 bytes | reader 16 bytes | first i64 | last i64 |
    rest

Whoever does not know the version or the kind leaves the sample out.
"""

from __future__ import annotations

import enum
import struct
from collections.abc import Sequence
from typing import Final, NamedTuple

__all__ = ["MAX_RANGES", "VERSION", "Kind", "Submessage", "pack", "pack_ranges", "unpack"]

VERSION: Final = 1

MAX_RANGES: Final = 64
"""How many ranges of missing messages are named at once."""

HEADER: Final = struct.Struct("<BBH16s16sqq")
RANGE: Final = struct.Struct("<qq")


class Kind(enum.IntEnum):
    """What a submessage says; `first` and `last` stand for what is noted here."""

    HEARTBEAT = 1
    """The writer has sent messages up to `last`; what is before `first` is not for this reader.

    The rest is the writer's participant, to which the reader answers with an ACKNACK.
    """
    ACKNACK = 2
    """The reader has taken all messages before `first`. The rest are ranges that it lacks."""
    GAP = 3
    """The messages from `first` to `last` will not come."""
    DATA = 4
    """Message `first` once more, sent at `last` (nanoseconds since 1970); the rest is its payload.
    """


class Submessage(NamedTuple):
    """One of them as it came."""

    kind: Kind
    writer: bytes
    reader: bytes
    first: int
    last: int
    rest: bytes

    def ranges(self) -> list[tuple[int, int]]:
        """Return what an ACKNACK lacks, first and last of each range."""
        size = min(len(self.rest) // RANGE.size, MAX_RANGES) * RANGE.size
        return list(RANGE.iter_unpack(self.rest[:size]))


def pack(
    kind: Kind, writer: bytes, reader: bytes, first: int, last: int, rest: bytes = b""
) -> bytes:
    """Return a submessage."""
    return HEADER.pack(VERSION, kind, 0, writer, reader, first, last) + rest


def pack_ranges(ranges: Sequence[tuple[int, int]]) -> bytes:
    """Return the rest of an ACKNACK."""
    return b"".join(RANGE.pack(first, last) for first, last in ranges[:MAX_RANGES])


def unpack(data: bytes) -> Submessage | None:
    """Return what `data` says, or None if it is in no known form."""
    if len(data) < HEADER.size:
        return None
    version, kind, _, writer, reader, first, last = HEADER.unpack_from(data)
    if version != VERSION or kind not in Kind.__members__.values():
        return None
    return Submessage(Kind(kind), writer, reader, first, last, data[HEADER.size :])
