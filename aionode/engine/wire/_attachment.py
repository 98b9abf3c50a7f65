"""The 33-byte attachment of every publication, request and reply.

It is Zenoh's serialization of (int64 sequence number, int64 source time, sequence of 16 bytes),
with the length of the sequence as one LEB128 byte. ROS nodes drop samples without an attachment and
may crash on a malformed one, so it is always written; parsing is lenient.
"""

from __future__ import annotations

import struct
from typing import Final

from msgspec import Struct

__all__ = ["GID_SIZE", "Attachment", "pack", "unpack", "unpack_fields"]

GID_SIZE: Final = 16

LAYOUT = struct.Struct("<qqB16s")

# The first releases for Jazzy (0.2.0 to 0.2.3) write the name of each field before its value.
NAMED_LAYOUT = struct.Struct("<16sq17sq11sB16s")
SEQUENCE_LABEL = b"\x0fsequence_number"
TIME_LABEL = b"\x10source_timestamp"
GID_LABEL = b"\x0asource_gid"


class Attachment(Struct, frozen=True):
    """The sender of a sample, its sequence number and its time."""

    sequence: int
    """Sequence number, counted from 1 for each publisher and client."""
    source_ns: int
    """System time of the sender, in nanoseconds since 1970."""
    gid: bytes
    """The 16 bytes that identify the publisher, or the client of a request or reply."""


def pack(sequence: int, source_ns: int, gid: bytes) -> bytes:
    """Return the attachment of one sample.

    Raises:
        ValueError: `gid` is not 16 bytes long.
    """
    if len(gid) != GID_SIZE:
        raise ValueError(f"gid: {len(gid)} bytes, needs {GID_SIZE}")
    return LAYOUT.pack(sequence, source_ns, GID_SIZE, gid)


def unpack(data: bytes) -> Attachment | None:
    """Parse an attachment; return None if its format is unknown.

    Additional bytes, which future releases may append, are ignored.
    """
    fields = unpack_fields(data)
    return None if fields is None else Attachment(*fields)


def unpack_fields(data: bytes) -> tuple[int, int, bytes] | None:
    """Return the same as `unpack`, but as a plain tuple, which takes half the time."""
    if len(data) == LAYOUT.size:
        sequence, source_ns, length, gid = LAYOUT.unpack(data)
        return (sequence, source_ns, gid) if length == GID_SIZE else None
    if len(data) == NAMED_LAYOUT.size and data.startswith(SEQUENCE_LABEL):
        _, sequence, label, source_ns, gid_label, length, gid = NAMED_LAYOUT.unpack(data)
        if label != TIME_LABEL or gid_label != GID_LABEL:
            return None
    elif len(data) >= LAYOUT.size:
        sequence, source_ns, length, gid = LAYOUT.unpack_from(data)
    else:
        return None
    return (sequence, source_ns, gid) if length == GID_SIZE else None
