"""One socket between two processes: frames out of it, and frames into it without ever blocking."""

from __future__ import annotations

import array
import logging
import os
import socket
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Protocol

from aionode._concurrency import SLICE_NS
from aionode.clock import perf_ns
from aionode.errors import FrameError
from aionode.transport.ipc import _protocol as protocol
from aionode.transport.ipc._protocol import BufferRef, FrameParser, Kind
from aionode.transport.ipc._shared_memory import SHARED_FROM, BufferMappings

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from aionode.transport.ipc._protocol import Frame
    from aionode.transport.ipc._shared_memory import BufferPool, SharedBuffer
    from aionode.wire.cdr import Data

__all__ = ["Connection", "WriteWaiter"]

logger = logging.getLogger("aionode.transport.ipc")

READ_BYTES: Final = 1 << 15
"""How much is read before the rest of the loop has its turn: some hundred small messages."""

READ_MAX: Final = 1 << 20
LAST_READS: Final = 10_000
"""More than a socket holds; a peer that writes on and on does not keep the loop here."""

BATCH_BYTES: Final = 1 << 16

LENT_BYTES: Final = 1 << 29
LENT_PIECES: Final = 256
"""How much memory one process may have from this one, in bytes and in pieces, of which each takes
a descriptor or two. A process that is frozen gives none back, and a stopped one has hundreds of
places waiting in its socket; what is more goes through the stream, which a full socket stops.
"""

URGENT_BYTES: Final = 1 << 28
"""How much may wait for a process that asks on and on but reads no answer, in bytes."""

MAX_HELD: Final = 1 << 20
"""A frame that has not come to its end is reported to `on_held` from this size on, in bytes."""
DESCRIPTORS: Final = 16
MAX_DESCRIPTORS: Final = 64
"""How many may wait for the rest of their frames: each comes with the first byte of its own."""

BURST_NS: Final = 20_000
"""What is sent within this time after the last is collected until the loop's next turn.

A system call costs more than the rest of a small message's way.
"""

NOBODY: Final = bytes(protocol.GID_SIZE)
NO_DESCRIPTOR: Final = "a descriptor could not be taken: too many files are open"

# As plain numbers: those of an enumeration take their time.
MSG_CMSG_CLOEXEC: Final = int(getattr(socket, "MSG_CMSG_CLOEXEC", 0))
MSG_CTRUNC: Final = int(getattr(socket, "MSG_CTRUNC", 0))
DATA: Final = int(Kind.DATA)
RELEASE: Final = int(Kind.RELEASE)
FORGET: Final = int(Kind.FORGET)


class WriteWaiter(Protocol):
    """What waits, elsewhere, for the socket to take more."""

    @property
    def name(self) -> str:
        """What it belongs to, for people."""

    @property
    def waiting(self) -> int:
        """How many messages wait."""

    def on_writable(self) -> None:
        """Write until `Connection.write` refuses; then come again with `when_writable`."""


class Connection:
    """An open socket. Everything happens on the loop's thread.

    Args:
        loop: The running loop.
        sock: Connected and not blocking; closed with this.
        pool: Where memory that was sent comes from.
        handle: Called with each frame, its payload, and until when callbacks may run at once.
        on_closed: Called once when the socket is closed from either end.
        on_held: Called when much of a frame is here that has not come to its end.

    Attributes:
        participant: Who is at the other end; empty before it has said so.
        pool: Where memory that was sent comes from.
        handlers: Called in place of `handle` with the messages of a publisher, by its gid.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        sock: socket.socket,
        pool: BufferPool,
        handle: Callable[[Connection, Frame, Data, int], None],
        on_closed: Callable[[Connection], None],
        on_held: Callable[[Connection], None] = lambda _: None,
    ) -> None:
        self.participant = ""
        self.handlers: dict[bytes, Callable[[Data, Frame, int], None]] = {}
        self._loop = loop
        self._sock: socket.socket | None = sock
        self._fd = sock.fileno()
        self.pool = pool
        self._handle = handle
        self._on_closed = on_closed
        self._on_held = on_held
        self._parser = FrameParser()
        self._max_held = protocol.HEADER_SIZE - 1  # a greeting is a header
        self._descriptors: deque[int] = deque()
        self._ancillary = socket.CMSG_SPACE(DESCRIPTORS * array.array("i").itemsize)
        # Frames of a burst, which go out together.
        self._batch: list[bytes] = []
        self._batched = 0
        self._flush_planned = False
        self._sent_ns = 0
        # The socket took no more: what is left of the last frames, and what has to wait.
        self._full = False
        self._failed = False
        self._rest = memoryview(b"")
        self._urgent: deque[tuple[bytes, SharedBuffer | None]] = deque()
        self._urgent_bytes = 0
        self._queues: dict[WriteWaiter, None] = {}
        # Memory: the numbers that the other process knows, what it has now, and what came from it.
        self._known: set[int] = set()
        self._lent: dict[int, SharedBuffer] = {}
        self._lent_bytes = 0
        self._mappings = BufferMappings()
        self._waiters: list[asyncio.Future[None]] = []
        pool.listeners.add(self._on_buffer_closed)
        loop.add_reader(self._fd, self._on_readable)

    def __repr__(self) -> str:
        state = "closed" if self.closed else "full" if self._full else "open"
        return f"<Connection {self.participant or 'nobody'} {state}>"

    @property
    def closed(self) -> bool:
        """Whether nothing can be sent any more."""
        return self._sock is None

    # Out

    def write(self, data: bytes, buffer: SharedBuffer | None = None) -> bool:
        """Take a frame; False if the socket is full or closed, and then it was not taken.

        The frame's memory is released when the other process has done so.
        """
        sock = self._sock
        if self._full or sock is None:
            return False
        if buffer is not None:
            return self._write_with(sock, data, buffer)
        if self._batch or perf_ns() - self._sent_ns < BURST_NS:
            self._batch.append(data)
            self._batched += len(data)
            if self._batched >= BATCH_BYTES:
                self._flush()
            elif not self._flush_planned:
                self._flush_planned = True
                self._loop.call_soon(self._planned_flush)
            return True
        try:  # `_send` written out: a call less for each message
            sent = sock.send(data)
        except (BlockingIOError, InterruptedError):
            sent = 0
        except OSError as error:
            self._send_failed(error)
            return False
        if sent < len(data):
            self._rest = memoryview(data)[sent:]
            self._note_full()
        self._sent_ns = perf_ns()
        return True

    def when_writable(self, queue: WriteWaiter) -> None:
        """Let `queue` go on once `write` does not refuse any more."""
        self._queues[queue] = None

    def send(
        self, kind: Kind, sequence: int, gid: bytes, payload: bytes = b"", source_ns: int = 0
    ) -> None:
        """Send a frame that is never dropped; nothing happens when closed.

        It overtakes the queues that wait for the socket, but no other frame sent by this.
        """
        self._send_now_or_later(protocol.pack(kind, sequence, source_ns, gid, payload), None)

    def send_data(
        self, kind: int, sequence: int, source_ns: int, gid: bytes, payload: bytes
    ) -> None:
        """Do `send` with a payload that may be large: then it goes in memory."""
        buffer = self.pool.filled(payload) if len(payload) >= SHARED_FROM else None
        if buffer is None:
            data = protocol.pack(kind, sequence, source_ns, gid, payload)
            if self._urgent or not self.write(data):
                self._send_now_or_later(data, None)
        else:
            place = BufferRef(buffer.number, len(payload)).pack()
            data = protocol.pack(kind, sequence, source_ns, gid, place, in_shm=True)
            self._send_now_or_later(data, buffer)

    def _send_now_or_later(self, data: bytes, buffer: SharedBuffer | None) -> None:
        if not self._urgent and self.write(data, buffer):
            return
        if not self.closed:
            self._urgent.append((data, buffer))
            self._urgent_bytes += len(data)
            if self._urgent_bytes > URGENT_BYTES and not self._failed:
                self._send_failed(TimeoutError("it reads none of its answers"))
        elif buffer is not None:
            self.pool.release(buffer)

    def _planned_flush(self) -> None:
        self._flush_planned = False
        self._flush()

    def _flush(self) -> None:
        """Send what was batched."""
        batch, sock = self._batch, self._sock
        if not batch or sock is None:
            return
        data = batch[0] if len(batch) == 1 else b"".join(batch)
        batch.clear()
        self._batched = 0
        self._send(sock, data)
        self._sent_ns = perf_ns()
        if not self._full:
            self.wake()

    def _send(self, sock: socket.socket, data: bytes | memoryview) -> None:
        """Send what the socket takes, and keep the rest."""
        try:
            sent = sock.send(data)
        except (BlockingIOError, InterruptedError):
            sent = 0
        except OSError as error:
            self._send_failed(error)
            return
        if sent < len(data):
            self._rest = memoryview(data)[sent:]
            self._note_full()

    def _send_failed(self, error: OSError) -> None:
        """Send no more, read what the other process has left in the socket, and then close it.

        It has gone, perhaps right after its last messages: nobody but this socket has them. Not
        read here, because this may be called while a frame is being handled.
        """
        if not self._failed:
            self._failed = self._full = True  # what is to be sent waits, until it is known unsent
            self._batch.clear()
            self._loop.call_soon(self._read_out_and_close, error)

    def _read_out_and_close(self, error: OSError) -> None:
        self.read_until_eof()
        self.close(error)

    def _note_full(self) -> None:
        if not self._full:
            self._full = True
            self._loop.add_writer(self._fd, self._on_writable)

    def _write_with(self, sock: socket.socket, data: bytes, buffer: SharedBuffer) -> bool:
        much = self._lent_bytes >= LENT_BYTES or len(self._lent) >= LENT_PIECES
        if much and buffer.size <= protocol.MAX_INLINE:
            if not self.write(whole(data, buffer)):
                return False
            self.pool.release(buffer)  # the other process knows nothing of it
            return True
        if buffer.number in self._known:
            if not self.write(data):
                return False
        else:
            self._flush()
            if self._full or self.closed:
                return False
            data = protocol.has_fd(data)
            try:
                sent = socket.send_fds(sock, [data], [buffer.fd])
            except (BlockingIOError, InterruptedError):
                self._note_full()
                return False
            except OSError as error:
                self._send_failed(error)
                return False
            self._known.add(buffer.number)
            if sent < len(data):
                self._rest = memoryview(data)[sent:]
                self._note_full()
        self._lent[buffer.number] = buffer
        self._lent_bytes += buffer.size
        return True

    def _on_buffer_closed(self, number: int) -> None:
        if number in self._known:
            self._known.discard(number)
            self.send(Kind.FORGET, number, NOBODY)

    def _on_writable(self) -> None:
        """Send what has waited: the rest of a frame, what is urgent, then the queues in turn."""
        if self._failed:
            return
        rest, self._rest = self._rest, memoryview(b"")
        if self._sock is not None and rest:
            self._send(self._sock, rest)
            if self._rest or self._failed:
                return
        self._full = False
        self._loop.remove_writer(self._fd)
        while self._urgent and self.write(*self._urgent[0]):
            self._urgent_bytes -= len(self._urgent.popleft()[0])
        queues, self._queues = self._queues, {}
        for queue in queues:
            queue.on_writable()
        self._flush()
        self.wake()

    @property
    def idle(self) -> bool:
        """Whether everything was handed to the system."""
        return not (self._batch or self._full)

    @property
    def queues(self) -> list[WriteWaiter]:
        """Those that wait for the socket to take more."""
        return list(self._queues)

    def progress(self) -> asyncio.Future[None]:
        """Return what is done when the socket took something, credit comes, or it closes."""
        waiter: asyncio.Future[None] = self._loop.create_future()
        if self._sock is None:
            waiter.set_result(None)
        else:
            self._waiters.append(waiter)
        return waiter

    def wake(self) -> None:
        """End each `progress`."""
        if self._waiters:
            waiters, self._waiters = self._waiters, []
            for waiter in waiters:
                if not waiter.done():
                    waiter.set_result(None)

    # In

    def read_until_eof(self) -> None:
        """Read all that is there, and then its end: something else has told of it already.

        uvloop may not: of a socket whose other end was closed with data unread, it tells once.
        """
        for _ in range(LAST_READS):
            if not self._on_readable():
                return

    def _on_readable(self) -> bool:
        """Read once; return whether there was something, so that there may be more."""
        sock = self._sock
        if sock is None:
            return False
        try:
            missing = self._parser.missing
            data, ancillary, flags, _ = sock.recvmsg(
                READ_BYTES if missing < READ_BYTES else min(missing, READ_MAX),
                self._ancillary,
                MSG_CMSG_CLOEXEC,
            )
        except (BlockingIOError, InterruptedError):
            return False
        except OSError as error:
            self.close(error)
            return False
        if not data:
            self.close()
            return True
        try:
            if ancillary:
                self._take_descriptors(ancillary)
            self._take_frames(self._parser.feed(data))
        except FrameError as error:
            self.close(error if not flags & MSG_CTRUNC else FrameError(NO_DESCRIPTOR))
        else:
            if flags & MSG_CTRUNC:  # what came before the frame that lacks it was whole
                self.close(FrameError(NO_DESCRIPTOR))
            elif self._parser.held > self._max_held:
                self._on_held(self)
        return True

    def _take_frames(self, frames: list[Frame]) -> None:
        inline_deadline_ns = perf_ns() + SLICE_NS
        handlers = self.handlers
        for one in frames:
            payload: Data = self._map(one) if one.in_shm else one.payload
            if one.kind == DATA:
                take = handlers.get(one.gid)
                if take is not None:  # else it was closed meanwhile
                    take(payload, one, inline_deadline_ns)
            elif one.kind == RELEASE:
                self._on_release(one.sequence)
            elif one.kind == FORGET:
                self._mappings.forget(one.sequence)
            else:
                self._handle(self, one, payload, inline_deadline_ns)

    @property
    def held(self) -> int:
        """How much is here of a frame that has not come to its end, in bytes."""
        return self._parser.held

    def know(self, participant: str) -> None:
        """Note who is at the other end, which may send more than a greeting from now on."""
        self.participant = participant
        self._max_held = MAX_HELD

    def _take_descriptors(self, ancillary: list[tuple[int, int, bytes]]) -> None:
        for level, kind, data in ancillary:
            if level == socket.SOL_SOCKET and kind == socket.SCM_RIGHTS:
                found = array.array("i")
                found.frombytes(data[: len(data) - len(data) % found.itemsize])
                self._descriptors.extend(found)
        if len(self._descriptors) > MAX_DESCRIPTORS:
            raise FrameError(f"{len(self._descriptors)} descriptors without a frame")

    def _map(self, one: Frame) -> memoryview:
        number, size = BufferRef.unpack(one.payload)
        fd = None
        if one.has_fd:
            if not self._descriptors:
                raise FrameError("a place in memory without its descriptor")
            fd = self._descriptors.popleft()
        return self._mappings.view(number, size, fd, lambda: self._give_back(number))

    def _give_back(self, number: int) -> None:
        """Note, on any thread and perhaps within any other call, that nobody looks at a memory."""
        with suppress(RuntimeError):  # the loop is closed, and the socket as well
            self._loop.call_soon_threadsafe(self.send, Kind.RELEASE, number, NOBODY)

    def _on_release(self, number: int) -> None:
        buffer = self._lent.pop(number, None)
        if buffer is not None:
            self._lent_bytes -= buffer.size
            self.pool.release(buffer)

    # The end

    def abandon(self) -> None:
        """Close this process's descriptor of the socket, which another process goes on with."""
        sock, self._sock = self._sock, None
        if sock is not None:
            sock.close()

    def close(self, reason: Exception | None = None) -> None:
        """Close the socket, whatever waits; twice is the same as once."""
        sock, self._sock = self._sock, None
        if sock is None:
            return
        if reason is not None and not isinstance(reason, ConnectionResetError | BrokenPipeError):
            logger.warning(
                "the link to %s has ended: %s; Zenoh takes over",
                self.participant or "another process",
                reason,
            )
        self._loop.remove_reader(self._fd)
        if self._full:
            self._loop.remove_writer(self._fd)
        sock.close()
        while self._descriptors:
            os.close(self._descriptors.popleft())
        self._batch.clear()
        self._rest = memoryview(b"")
        self._queues.clear()
        for _, buffer in self._urgent:
            if buffer is not None:
                self.pool.release(buffer)
        self._urgent.clear()
        for buffer in self._lent.values():
            buffer.retired = True  # the other process may look at it as long as it likes
            self.pool.release(buffer)
        self._lent.clear()
        self._lent_bytes = self._urgent_bytes = 0
        self.pool.listeners.discard(self._on_buffer_closed)
        self._mappings.close()
        self.wake()
        self._on_closed(self)


def whole(data: bytes, buffer: SharedBuffer) -> bytes:
    """Return a frame that has its payload in itself instead of elsewhere."""
    (one,) = FrameParser().feed(data)
    payload = buffer.read(BufferRef.unpack(one.payload).size)
    return protocol.pack(one.kind, one.sequence, one.source_ns, one.gid, payload)
