"""What two processes say to each other over a link: frames on a stream of bytes.

Each frame is a header of 40 bytes, little endian, and a payload::

    size u32 | kind u8 | flags u8 | mark u16 | sequence i64 | source_ns i64 | gid 16 bytes | payload

The stream stays in step only while every frame is understood, so that anything unknown ends it with
a `FrameError`; there is no way to find the next frame. A large payload is in memory that both sides
know: then a flag is set, and what follows the header is a `Place`. A second flag says that the
descriptor of that memory comes beside the frame.
"""

from __future__ import annotations

import enum
import struct
from typing import Final, NamedTuple

import msgspec

from aionode.errors import FrameError

__all__ = [
    "GID_SIZE",
    "HEADER_SIZE",
    "MAX_INLINE",
    "VERSION",
    "Frame",
    "FrameParser",
    "Kind",
    "Place",
    "attached",
    "pack",
]

VERSION: Final = 1
"""Of this format; links open between equal versions only."""

GID_SIZE: Final = 16

MAX_INLINE: Final = 1 << 26
"""How large a payload in the stream may be, in bytes; a larger size is a sign of garbage."""

HEADER: Final = struct.Struct("<IBBHqq16s")
HEADER_SIZE: Final = HEADER.size
MARK: Final = 0xA10E
ELSEWHERE: Final = 1
ATTACHED: Final = 3
FLAGS: Final = (0, ELSEWHERE, ATTACHED)
FLAGS_AT: Final = 5
PLACE: Final = struct.Struct("<QQ")


class Kind(enum.IntEnum):
    """What a frame says. `gid` and `sequence` stand for what is noted here."""

    HELLO = 1
    """Who I am: gid is the participant, sequence the `VERSION`, source_ns the domain."""
    OPEN = 2
    """I want what publisher gid publishes: the payload is the reader, sequence its window.

    source_ns is 1 if it confirms what it has, 0 if it may lose messages.
    """
    OPENED = 3
    """It comes from here on, after number sequence; the payload is the reader's gid."""
    SWITCHED = 4
    """This reader (the payload) needs publisher gid's messages from nowhere else now."""
    CLOSE = 5
    """This reader (the payload) needs nothing of publisher gid any more."""
    GONE = 6
    """Publisher gid sends nothing any more."""
    CREDIT = 7
    """This reader (the payload) has used sequence more messages, the last with number source_ns."""
    DATA = 8
    """Message number sequence of publisher gid."""
    REQUEST = 9
    """Request number sequence of client gid; the payload begins with the server's gid."""
    REPLY = 10
    """The response to it; the payload begins with the server's gid."""
    FAIL = 11
    """A server's error in place of a response."""
    END = 12
    """The server will not answer."""
    CANCEL = 13
    """The client has given the request up."""
    RELEASE = 14
    """The memory number sequence is not in use any more."""
    FORGET = 15
    """The memory number sequence will not be used any more."""
    CAUGHT_UP = 16
    """All that a broken link left unsaid has been said."""


LAST_KIND: Final = max(Kind).value


class Frame(msgspec.Struct, frozen=True, gc=False):
    """One frame as it came.

    Attributes:
        kind: What it says; one of `Kind`.
        sequence: A number, from -2**63 to 2**63 - 1.
        source_ns: When a message was sent, or another number.
        gid: 16 bytes that name an endpoint.
        payload: What follows.
        elsewhere: Whether that is the `Place` of the payload proper.
        attached: Whether the descriptor of that memory comes with it.
    """

    kind: int
    sequence: int = 0
    source_ns: int = 0
    gid: bytes = bytes(GID_SIZE)
    payload: bytes = b""
    elsewhere: bool = False
    attached: bool = False


class Place(NamedTuple):
    """Where a large payload is."""

    number: int
    """Of the memory; whoever sent it wants it back with `Kind.RELEASE`."""
    size: int
    """Of the payload, in bytes, from the beginning of the memory."""

    def pack(self) -> bytes:
        """Return it as bytes."""
        return PLACE.pack(self.number, self.size)

    @classmethod
    def unpack(cls, data: bytes) -> Place:
        """Return what `pack` made `data` of.

        Raises:
            FrameError: it is none.
        """
        if len(data) != PLACE.size:
            raise FrameError(f"a place of {len(data)} bytes; {PLACE.size} fit")
        return cls._make(PLACE.unpack(data))


def pack(
    kind: int,
    sequence: int,
    source_ns: int,
    gid: bytes,
    payload: bytes = b"",
    *,
    elsewhere: bool = False,
) -> bytes:
    """Return a frame.

    Raises:
        FrameError: the payload is too large.
    """
    size = len(payload)
    if size > MAX_INLINE:
        raise FrameError(f"a payload of {size} bytes in the stream; at most {MAX_INLINE} fit")
    return HEADER.pack(size, kind, elsewhere, MARK, sequence, source_ns, gid) + payload


def attached(data: bytes) -> bytes:
    """Return a frame whose payload is elsewhere as one that comes with the descriptor."""
    return data[:FLAGS_AT] + bytes([ATTACHED]) + data[FLAGS_AT + 1 :]


class FrameParser:
    """Takes the stream apart, in whatever pieces it comes.

    Attributes:
        missing: How many bytes the frame that has begun needs at least; 1 or more.
        held: How many bytes are here of a frame that has begun and not come to its end.
    """

    __slots__ = ("_pieces", "held", "missing")

    def __init__(self) -> None:
        self._pieces: list[bytes] = []
        self.missing = HEADER_SIZE
        self.held = 0

    def feed(self, data: bytes) -> list[Frame]:
        """Return the frames that `data` completes.

        Raises:
            FrameError: this is no stream of frames; the parser is of no more use.
        """
        if self._pieces:
            self._pieces.append(data)
            if len(data) < self.missing:
                self.missing -= len(data)
                self.held += len(data)
                return []  # pieces of a large payload are joined once, at its end
            data = b"".join(self._pieces)
            self._pieces.clear()
        frames: list[Frame] = []
        offset = 0
        end = len(data)
        need = HEADER_SIZE
        while end - offset >= HEADER_SIZE:
            size, kind, flags, mark, sequence, source_ns, gid = HEADER.unpack_from(data, offset)
            if mark != MARK or not 0 < kind <= LAST_KIND or flags not in FLAGS:
                raise FrameError(f"something that is no frame (kind {kind}, mark {mark:#06x})")
            if size > MAX_INLINE:
                raise FrameError(f"a payload of {size} bytes in the stream; {MAX_INLINE} fit")
            begin = offset + HEADER_SIZE
            if end - begin < size:
                need = HEADER_SIZE + size
                break
            offset = begin + size
            payload = data[begin:offset]
            if flags:
                one = Frame(kind, sequence, source_ns, gid, payload, True, flags == ATTACHED)
            else:
                one = Frame(kind, sequence, source_ns, gid, payload)
            frames.append(one)
        if offset < end:
            self._pieces.append(data[offset:] if offset else data)
        self.held = end - offset
        self.missing = need - (end - offset)
        return frames
