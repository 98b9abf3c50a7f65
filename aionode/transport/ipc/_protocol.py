"""The ipc protocol without a socket: frames on a byte stream, and the hand-over between routes.

What two processes say to each other over a link: frames on a stream of bytes.

Each frame is a header of 40 bytes, little endian, and a payload::

    size u32 | kind u8 | flags u8 | mark u16 | sequence i64 | source_ns i64 | gid 16 bytes | payload

The stream stays in step only while every frame is understood, so that anything unknown ends it with
a `FrameError`; there is no way to find the next frame. A large payload is in memory that both sides
know: then a flag is set, and what follows the header is a `BufferRef`. A second flag says that the
descriptor of that memory comes beside the frame.

From one way to another in the middle of a stream, without losing, doubling or swapping messages.

A reader hears a publisher of another process over Zenoh first. When the two processes are linked:

1. The reader asks for the publisher (`OPEN`).
2. The publisher answers with the number of its last message (`OPENED`), and from the next one on
   writes to both ways.
3. The reader goes on with what comes over Zenoh, and holds what comes over the link, until Zenoh
   has brought that number or a later one: nothing older is under way then. If Zenoh stays silent,
   it has lost the message, or the two were not matched when it was sent: waiting ends as well.
4. The reader takes the link and says so (`SWITCHED`), and the publisher stops writing to Zenoh if
   nobody else listens there. A copy that Zenoh brings ahead of the link is held until then.

When the link ends, the publisher goes on over Zenoh, and sends what the reader has not confirmed
to the reader's process alone (its post), where nobody else can hear it twice; then it says that
this was all (`RETRANSMIT_DONE`). Meanwhile the reader mends the stream: it takes the next number
whatever brings it, also a new link, and holds what is further ahead.
"""

from __future__ import annotations

import enum
import struct
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import msgspec

from aionode.errors import FrameError
from aionode.graph import EndpointInfo
from aionode.qos import DurabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.transport.base import SampleInfo

__all__ = [
    "GID_SIZE",
    "HEADER_SIZE",
    "MAX_INLINE",
    "VERSION",
    "BufferRef",
    "Frame",
    "FrameParser",
    "Handover",
    "Kind",
    "Route",
    "can_link",
    "has_fd",
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

IN_SHM: Final = 1

HAS_FD: Final = 3

FLAGS: Final = (0, IN_SHM, HAS_FD)

FLAGS_AT: Final = 5

BUFFER_REF: Final = struct.Struct("<QQ")


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
    RETRANSMIT_DONE = 16
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
        in_shm: Whether that is the `BufferRef` of the payload proper.
        has_fd: Whether the descriptor of that memory comes with it.
    """

    kind: int
    sequence: int = 0
    source_ns: int = 0
    gid: bytes = bytes(GID_SIZE)
    payload: bytes = b""
    in_shm: bool = False
    has_fd: bool = False


class BufferRef(NamedTuple):
    """Where a large payload is."""

    number: int
    """Of the memory; whoever sent it wants it back with `Kind.RELEASE`."""
    size: int
    """Of the payload, in bytes, from the beginning of the memory."""

    def pack(self) -> bytes:
        """Return it as bytes."""
        return BUFFER_REF.pack(self.number, self.size)

    @classmethod
    def unpack(cls, data: bytes) -> BufferRef:
        """Return what `pack` made `data` of.

        Raises:
            FrameError: it is none.
        """
        if len(data) != BUFFER_REF.size:
            raise FrameError(f"a place of {len(data)} bytes; {BUFFER_REF.size} fit")
        return cls._make(BUFFER_REF.unpack(data))


def pack(
    kind: int,
    sequence: int,
    source_ns: int,
    gid: bytes,
    payload: bytes = b"",
    *,
    in_shm: bool = False,
) -> bytes:
    """Return a frame.

    Raises:
        FrameError: the payload is too large.
    """
    size = len(payload)
    if size > MAX_INLINE:
        raise FrameError(f"a payload of {size} bytes in the stream; at most {MAX_INLINE} fit")
    return HEADER.pack(size, kind, in_shm, MARK, sequence, source_ns, gid) + payload


def has_fd(data: bytes) -> bytes:
    """Return a frame whose payload is elsewhere as one that comes with the descriptor."""
    return data[:FLAGS_AT] + bytes([HAS_FD]) + data[FLAGS_AT + 1 :]


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
                one = Frame(kind, sequence, source_ns, gid, payload, True, flags == HAS_FD)
            else:
                one = Frame(kind, sequence, source_ns, gid, payload)
            frames.append(one)
        if offset < end:
            self._pieces.append(data[offset:] if offset else data)
        self.held = end - offset
        self.missing = need - (end - offset)
        return frames


MAX_HELD: Final = 2_000
"""How many messages are held at most; with one more the reader waits for Zenoh no longer.

More than the window of a KEEP_ALL reader, which therefore always waits.
"""

MAX_MENDING: Final = 50_000
"""How many are held at most while what a broken link left unsaid is awaited."""


class Route(enum.Enum):
    """Where a reader takes a publisher's messages from."""

    ZENOH = "zenoh"
    BOTH = "both"
    """From Zenoh still; what the link brings is held."""
    IPC = "link"
    """From the link; what Zenoh brings ahead of it is held."""
    RECOVERING = "mending"
    """The next number from anywhere; what is further ahead is held."""


class Handover:
    """One reader and one publisher.

    Args:
        deliver: Takes the messages, each once and in order, with the time until when a callback
            may run at once.

    Attributes:
        route: Where they come from now.
        last: The number of the last one that was delivered.
        steady: Whether all that comes over the link from now on can be delivered if it is newer
            than `last`, which is then to be set: what `from_link` does, without the call.
    """

    __slots__ = ("_base", "_deliver", "_held", "_linked", "_owed", "last", "route", "steady")

    def __init__(self, deliver: Callable[[Any, SampleInfo, int], None]) -> None:
        self.route = Route.ZENOH
        self.last = 0
        self.steady = False
        self._deliver = deliver
        self._base = 0
        self._linked = False
        self._owed = 0  # links that have ended, and whose publisher has not caught up
        self._held: dict[int, tuple[Any, SampleInfo]] = {}

    @property
    def waits(self) -> bool:
        """Whether messages are held until others have come."""
        return bool(self._held) and self.route in (Route.BOTH, Route.RECOVERING)

    def opened(self, sequence: int) -> None:
        """Note that what follows number `sequence` comes over the link."""
        self._base = sequence
        self._linked = True
        if self.route is Route.RECOVERING:
            self._recover()
            return
        self.route = Route.BOTH
        if self.last >= sequence:
            self.switch()

    def from_zenoh(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int = 0) -> None:
        """Take a message that came over Zenoh."""
        number = sample_info.sequence
        if number <= self.last:
            return
        if self.route is Route.IPC or self.route is Route.RECOVERING:
            self._hold(msg, sample_info)
            self._recover()
            return
        self._next(msg, sample_info, inline_deadline_ns)
        if self.route is Route.BOTH and number >= self._base:
            self.switch()

    def from_link(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int = 0) -> None:
        """Take a message that came over the link; before `opened` it is for another reader."""
        if self.route is Route.BOTH:
            self._hold(msg, sample_info)
            if len(self._held) >= MAX_HELD:
                self.switch()
        elif self.route is Route.IPC and sample_info.sequence > self.last:
            self._next(msg, sample_info, inline_deadline_ns)
            held = self._held
            while held and (oldest := next(iter(held))) <= self.last:
                del held[oldest]
            self.steady = not held
        elif self.route is Route.RECOVERING and self._linked and sample_info.sequence > self.last:
            self._hold(msg, sample_info)
            self._recover()

    def from_retransmit(self, msg: Any, sample_info: SampleInfo) -> None:
        """Take a message that a broken link has left unsaid."""
        if sample_info.sequence <= self.last:
            return
        if self.route is Route.ZENOH:  # it was never opened here: what is older was sent over Zenoh
            self.route = Route.RECOVERING
            self._base = sample_info.sequence - 1
            self._owed = max(self._owed, 1)
        self._hold(msg, sample_info)
        self._recover()

    def switch(self) -> None:
        """Take the link from now on, and what it brought so far first."""
        if self.route is Route.BOTH:
            self._release()
            self.route = Route.IPC
            self.steady = True

    def broken(self) -> None:
        """Take Zenoh again, as soon as nothing is missing: the link has ended."""
        self._owed += 1
        self._linked = False
        self.steady = False
        if self.route is not Route.ZENOH:
            self.route = Route.RECOVERING
            self._recover()

    def retransmit_done(self) -> None:
        """Note that all that a broken link left unsaid has been said."""
        self._owed = max(self._owed - 1, 0)
        self._recover()

    def finish(self) -> None:
        """Mend no longer: what has not come by now was lost."""
        if self.route is Route.RECOVERING:
            self._owed = 0
            self._release()
            self.route = Route.IPC if self._linked else Route.ZENOH
            self.steady = self._linked

    def _next(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int = 0) -> None:
        self.last = sample_info.sequence
        self._deliver(msg, sample_info, inline_deadline_ns)

    def _hold(self, msg: Any, sample_info: SampleInfo) -> None:
        self._held[sample_info.sequence] = (msg, sample_info)
        self.steady = False
        if self.route is Route.IPC and len(self._held) > MAX_HELD:
            del self._held[next(iter(self._held))]  # a copy: it comes over the link, or by post
        elif len(self._held) > MAX_MENDING:
            self.finish()

    def _recover(self) -> None:
        if self.route is not Route.RECOVERING:
            return
        while self.last + 1 in self._held:
            self._next(*self._held.pop(self.last + 1))
        if not self._owed and self.last >= self._base:
            if self._linked:  # what is held came over Zenoh, ahead of the link
                self.route = Route.IPC
                self.steady = not self._held
            else:
                self.finish()

    def _release(self) -> None:
        """Deliver all that is held."""
        held, self._held = self._held, {}
        for number in sorted(held):
            if number > self.last:
                self._next(*held[number])


def can_link(publisher: EndpointInfo) -> bool:
    """Whether a publisher's messages may go over a link.

    Those that are kept for late readers are kept by Zenoh, which has to know them all.
    """
    return publisher.qos.resolved().durability is not DurabilityPolicy.TRANSIENT_LOCAL
