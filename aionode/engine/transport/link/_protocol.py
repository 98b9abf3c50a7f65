"""The link protocol without a socket: frames on a byte stream.

Each frame is a header of 40 bytes, little endian, and a payload::

    size u32 | kind u8 | flags u8 | mark u16 | sequence i64 | source_ns i64 | gid 16 bytes | payload

A receiver stays in sync only while it understands every frame, so anything unknown raises
`FrameError` and ends the link; there is no way to find the start of the next frame. A large payload
is in shared memory: a flag is set, and a `BufferRef` follows the header instead. A second flag
indicates that the memory's file descriptor is sent along with the frame.

DATA, STOP, REQUEST and REPLY carry user payloads and stay a `Frame`. Every other kind is a control
frame: a class of its own, whose `pack` writes it and which `decode_control` parses.
"""

from __future__ import annotations

import enum
import struct
from collections.abc import Callable, Mapping
from typing import ClassVar, Final, Self

import msgspec

from aionode.errors import FrameError

__all__ = [
    "GID_SIZE",
    "HEADER_SIZE",
    "MAX_INLINE",
    "MESSAGE_HEADER",
    "MESSAGE_MARK",
    "SECRET_SIZE",
    "VERSION",
    "BufferRef",
    "Cancel",
    "Close",
    "Control",
    "Credit",
    "End",
    "Fail",
    "Forget",
    "Frame",
    "FrameParser",
    "Gone",
    "Handler",
    "Hello",
    "Kind",
    "Open",
    "Opened",
    "Release",
    "RetransmitDone",
    "Switched",
    "decode_control",
    "has_fd",
    "pack",
]

Handler = Callable[[bytes | bytearray | memoryview, int, int, int], None]
"""Handles a message of one publisher: its payload, number and time, and the `perf_ns` deadline for
running its callback inline.
"""

CallHandler = Callable[[int, int, int, bytes, bytes | memoryview, int], None]
"""Handles a REQUEST or REPLY: its kind, number and time, the gid of the client, the payload, and
the `perf_ns` deadline for running callbacks inline.
"""

VERSION: Final = 5
"""Version of this format; only contexts with equal versions can be linked."""

GID_SIZE: Final = 16

NO_GID: Final = bytes(GID_SIZE)

SECRET_SIZE: Final = 16

MAX_INLINE: Final = 1 << 26
"""The largest payload in the stream, in bytes; a larger size indicates a corrupt stream."""

HEADER: Final = struct.Struct("<IBBHqq16s")

HEADER_SIZE: Final = HEADER.size

MARK: Final = 0xA10E

MESSAGE_HEADER: Final = struct.Struct("<IIqq16s")  # with kind, flags and mark as one number

IN_SHM: Final = 1

HAS_FD: Final = 3

FLAGS: Final = (0, IN_SHM, HAS_FD)

FLAGS_AT: Final = 5

BUFFER_REF: Final = struct.Struct("<QQQ")


class Kind(enum.IntEnum):
    """The kinds of frames. Control frames are documented in the class named here."""

    HELLO = 1
    """`Hello`."""
    OPEN = 2
    """`Open`."""
    OPENED = 3
    """`Opened`."""
    SWITCHED = 4
    """`Switched`."""
    CLOSE = 5
    """`Close`."""
    GONE = 6
    """`Gone`."""
    CREDIT = 7
    """`Credit`."""
    DATA = 8
    """Message number `sequence` of publisher `gid`."""
    REQUEST = 9
    """Request number `sequence` of client `gid`; the payload starts with the server's gid."""
    REPLY = 10
    """The response to request `sequence` of client `gid`."""
    FAIL = 11
    """`Fail`."""
    END = 12
    """`End`."""
    CANCEL = 13
    """`Cancel`."""
    RELEASE = 14
    """`Release`."""
    FORGET = 15
    """`Forget`."""
    RETRANSMIT_DONE = 16
    """`RetransmitDone`."""
    STOP = 17
    """Like DATA, but outside the link: the stop of a lease, after which nothing older is
    accepted."""


LAST_KIND: Final = max(Kind).value

MESSAGE_MARK: Final = int(Kind.DATA) | MARK << 16  # for a message in the stream

CALLS: Final = {int(kind) | MARK << 16: int(kind) for kind in (Kind.REQUEST, Kind.REPLY)}
"""Requests and responses in the stream, by the same number of their headers."""


class Frame(msgspec.Struct, frozen=True, gc=False):
    """One received frame.

    Attributes:
        kind: One of `Kind`.
        sequence: The number of a message or request, from -2**63 to 2**63 - 1.
        source_ns: When it was sent, in nanoseconds since 1970 by the sender's clock.
        gid: 16 bytes that identify the publisher or client.
        payload: The bytes after the header.
        in_shm: Whether `payload` is the `BufferRef` of the actual payload.
        has_fd: Whether the memory's file descriptor is sent along.
    """

    kind: int
    sequence: int = 0
    source_ns: int = 0
    gid: bytes = NO_GID
    payload: bytes = b""
    in_shm: bool = False
    has_fd: bool = False


class BufferRef(msgspec.Struct, frozen=True):
    """The location of a large payload."""

    number: int
    """Identifies the shared buffer; the sender gets it back with `Release`."""
    start: int
    """Where the payload starts in the buffer, in bytes."""
    size: int
    """Size of the payload in bytes."""

    def pack(self) -> bytes:
        """Return the reference as the payload of a frame."""
        return BUFFER_REF.pack(self.number, self.start, self.size)

    @classmethod
    def unpack(cls, data: bytes) -> BufferRef:
        """Parse a reference written by `pack`.

        Raises:
            FrameError: `data` has the wrong size.
        """
        if len(data) != BUFFER_REF.size:
            raise FrameError(
                f"expected a buffer reference of {BUFFER_REF.size} bytes, got {len(data)} bytes"
            )
        return cls(*BUFFER_REF.unpack(data))


def pack(
    kind: int,
    sequence: int,
    source_ns: int,
    gid: bytes,
    payload: bytes = b"",
    *,
    in_shm: bool = False,
) -> bytes:
    """Return a frame as bytes.

    Raises:
        FrameError: the payload is larger than `MAX_INLINE`.
    """
    size = len(payload)
    if size > MAX_INLINE:
        raise FrameError(f"a payload of {size} bytes is too large for the stream ({MAX_INLINE})")
    return HEADER.pack(size, kind, in_shm, MARK, sequence, source_ns, gid) + payload


def has_fd(data: bytes) -> bytes:
    """Set the descriptor flag of a packed frame whose payload is in shared memory."""
    return data[:FLAGS_AT] + bytes([HAS_FD]) + data[FLAGS_AT + 1 :]


class FrameParser:
    """Splits the stream into frames, whatever the size of the chunks received.

    Attributes:
        missing: Minimum number of further bytes that the current frame needs; 1 or more.
        held: Number of bytes held of an incomplete frame.
    """

    __slots__ = ("_pieces", "held", "missing")

    def __init__(self) -> None:
        # Pieces of the current frame; emptied when the frame is complete.
        self._pieces: list[bytes] = []
        self.missing = HEADER_SIZE
        self.held = 0

    def take_messages(
        self,
        data: bytes,
        handlers: Mapping[bytes, Handler],
        handle_call: CallHandler,
        inline_deadline_ns: int,
    ) -> bytes:
        """Pass on the messages, requests and responses at the start of the data; return the rest.

        The rest starts with a frame of another kind, or an incomplete frame, and is for `feed`.
        Messages of publishers without a handler are skipped. No objects except payloads are
        created.

        Raises:
            FrameError: what `handle_call` raised.
        """
        if self._pieces:
            if len(data) < self.missing:
                return data
            data = b"".join((*self._pieces, data))
            self._pieces.clear()
            self.held = 0
            self.missing = HEADER_SIZE
        offset, end = 0, len(data)
        while end - offset >= HEADER_SIZE:
            size, mark, sequence, source_ns, gid = MESSAGE_HEADER.unpack_from(data, offset)
            begin = offset + HEADER_SIZE
            if end - begin < size:
                break
            if mark == MESSAGE_MARK:
                offset = begin + size
                handler = handlers.get(gid)
                if handler is not None:  # otherwise the subscription was just destroyed
                    handler(data[begin:offset], sequence, source_ns, inline_deadline_ns)
            elif mark in CALLS:
                offset = begin + size
                payload = data[begin:offset]
                handle_call(CALLS[mark], sequence, source_ns, gid, payload, inline_deadline_ns)
            else:
                break
        return data[offset:]

    def feed(self, data: bytes) -> list[Frame]:
        """Return the frames that `data` completes.

        Raises:
            FrameError: the stream is corrupt; the parser must not be used again.
        """
        if self._pieces:
            self._pieces.append(data)
            if len(data) < self.missing:
                self.missing -= len(data)
                self.held += len(data)
                return []  # join the pieces of a large payload only once, when it is complete
            data = b"".join(self._pieces)
            self._pieces.clear()
        frames: list[Frame] = []
        offset = 0
        end = len(data)
        need = HEADER_SIZE
        while end - offset >= HEADER_SIZE:
            size, kind, flags, mark, sequence, source_ns, gid = HEADER.unpack_from(data, offset)
            if mark != MARK or not 0 < kind <= LAST_KIND or flags not in FLAGS:
                raise FrameError(
                    f"expected a frame, got kind {kind}, flags {flags}, mark {mark:#06x}"
                )
            if size > MAX_INLINE:
                raise FrameError(
                    f"a payload of {size} bytes is too large for the stream ({MAX_INLINE})"
                )
            begin = offset + HEADER_SIZE
            if end - begin < size:
                need = HEADER_SIZE + size
                break
            offset = begin + size
            payload = data[begin:offset]
            if flags:
                frame = Frame(kind, sequence, source_ns, gid, payload, True, flags == HAS_FD)
            else:
                frame = Frame(kind, sequence, source_ns, gid, payload)
            frames.append(frame)
        if offset < end:
            self._pieces.append(data[offset:] if offset else data)
        self.held = end - offset
        self.missing = need - (end - offset)
        return frames


# Control frames


class Control(msgspec.Struct, frozen=True, gc=False):
    """A control frame, which the ends of a link exchange besides payloads."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        raise NotImplementedError

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Parse a frame written by `pack`.

        Raises:
            FrameError: the payload does not fit this kind.
        """
        raise NotImplementedError


class Hello(Control, frozen=True, gc=False):
    """The first frame in each direction: identifies this end."""

    participant: str
    """Id of the context: hexadecimal, without leading zeros."""
    version: int
    domain_id: int
    secret: bytes
    """The secret that authenticates frames continuing the link over Zenoh."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        gid = int(self.participant, 16).to_bytes(GID_SIZE, "big")
        return pack(Kind.HELLO, self.version, self.domain_id, gid, self.secret)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Parse a frame written by `pack`.

        Raises:
            FrameError: it does not contain a secret.
        """
        if len(frame.payload) != SECRET_SIZE:
            raise FrameError(
                f"expected HELLO with a secret of {SECRET_SIZE} bytes, got {len(frame.payload)}"
            )
        participant = f"{int.from_bytes(frame.gid, 'big'):x}"
        return cls(participant, frame.sequence, frame.source_ns, frame.payload)


class OfSubscription(Control, frozen=True, gc=False):
    """A control frame about a publisher and one subscription of the other process."""

    publisher: bytes
    subscription: bytes


class Open(OfSubscription, frozen=True, gc=False):
    """A subscription asks for the messages of a publisher."""

    window: int
    """Messages that the publisher may send before it gets credit; 0 for no limit."""
    confirms: bool
    """Whether the subscription confirms what it receives; otherwise it may lose messages."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.OPEN, self.window, self.confirms, self.publisher, self.subscription)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid, subscription_in(frame), frame.sequence, bool(frame.source_ns))


class Opened(OfSubscription, frozen=True, gc=False):
    """The publisher sends all messages after number `sequence` over the link."""

    sequence: int

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.OPENED, self.sequence, 0, self.publisher, self.subscription)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid, subscription_in(frame), frame.sequence)


class Switched(OfSubscription, frozen=True, gc=False):
    """The subscription accepts the publisher's messages only from the link now."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.SWITCHED, 0, 0, self.publisher, self.subscription)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid, subscription_in(frame))


class Close(OfSubscription, frozen=True, gc=False):
    """The subscription needs nothing from the publisher any more."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.CLOSE, 0, 0, self.publisher, self.subscription)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid, subscription_in(frame))


class Credit(OfSubscription, frozen=True, gc=False):
    """The subscription has used `used` more messages, and has everything up to `confirmed`."""

    used: int
    confirmed: int

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.CREDIT, self.used, self.confirmed, self.publisher, self.subscription)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid, subscription_in(frame), frame.sequence, frame.source_ns)


class Gone(Control, frozen=True, gc=False):
    """The publisher was destroyed; this is its last frame."""

    publisher: bytes

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.GONE, 0, 0, self.publisher)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid)


class OfRequest(Control, frozen=True, gc=False):
    """A control frame about request number `sequence` of a client."""

    client: bytes
    sequence: int


class Fail(OfRequest, frozen=True, gc=False):
    """A server's error instead of a response."""

    error_type: str
    error_text: str
    DECODER: ClassVar = msgspec.json.Decoder(tuple[str, str])

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        payload = msgspec.json.encode((self.error_type, self.error_text))
        return pack(Kind.FAIL, self.sequence, 0, self.client, payload)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote.

        Raises:
            FrameError: the payload is not a pair of texts.
        """
        try:
            error_type, error_text = cls.DECODER.decode(frame.payload)
        except msgspec.MsgspecError as error:
            raise FrameError(f"a FAIL frame that cannot be read: {error}") from error
        return cls(frame.gid, frame.sequence, error_type, error_text)


class End(OfRequest, frozen=True, gc=False):
    """The server will not answer the request."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.END, self.sequence, 0, self.client)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid, frame.sequence)


class Cancel(OfRequest, frozen=True, gc=False):
    """The client has cancelled the request."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.CANCEL, self.sequence, 0, self.client)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.gid, frame.sequence)


class Release(Control, frozen=True, gc=False):
    """The receiver no longer uses this shared buffer; the sender may fill it again."""

    buffer: int

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.RELEASE, self.buffer, 0, NO_GID)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.sequence)


class Forget(Control, frozen=True, gc=False):
    """The sender has closed this shared buffer; the receiver may unmap it."""

    buffer: int

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.FORGET, self.buffer, 0, NO_GID)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:
        """Return what `pack` wrote."""
        return cls(frame.sequence)


class RetransmitDone(Control, frozen=True, gc=False):
    """Everything that a broken link left unacknowledged has been sent again."""

    def pack(self) -> bytes:
        """Return the frame as bytes."""
        return pack(Kind.RETRANSMIT_DONE, 0, 0, NO_GID)

    @classmethod
    def from_frame(cls, frame: Frame) -> Self:  # noqa: ARG003  # it says nothing else
        """Return what `pack` wrote."""
        return cls()


CONTROLS: Final[dict[int, type[Control]]] = {
    Kind.HELLO: Hello,
    Kind.OPEN: Open,
    Kind.OPENED: Opened,
    Kind.SWITCHED: Switched,
    Kind.CLOSE: Close,
    Kind.GONE: Gone,
    Kind.CREDIT: Credit,
    Kind.FAIL: Fail,
    Kind.END: End,
    Kind.CANCEL: Cancel,
    Kind.RELEASE: Release,
    Kind.FORGET: Forget,
    Kind.RETRANSMIT_DONE: RetransmitDone,
}


def decode_control(frame: Frame) -> Control:
    """Parse a control frame.

    Raises:
        FrameError: it carries a user payload, or its own payload does not fit its kind.
    """
    control = CONTROLS.get(frame.kind)
    if control is None or frame.in_shm:
        raise FrameError(f"expected a control frame, got kind {frame.kind}")
    return control.from_frame(frame)


def subscription_in(frame: Frame) -> bytes:
    """Return the gid of the subscription in a control frame.

    Raises:
        FrameError: there is none.
    """
    if len(frame.payload) != GID_SIZE:
        raise FrameError(
            f"expected the gid of a subscription, got {len(frame.payload)} bytes "
            f"in a frame of kind {frame.kind}"
        )
    return frame.payload
