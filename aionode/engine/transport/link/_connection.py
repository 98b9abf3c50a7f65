"""One socket between two processes: reads frames, and writes frames without ever blocking."""

from __future__ import annotations

import array
import asyncio
import logging
import os
import socket
from collections import deque
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Final, Protocol

from aionode._process.concurrency import SLICE_NS, running_loop
from aionode.clock import perf_ns
from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._protocol import (
    HEADER_SIZE,
    SECRET_SIZE,
    BufferRef,
    Forget,
    FrameParser,
    Kind,
    Release,
    decode_control,
)
from aionode.engine.transport.link._receivers import ReceiverTable
from aionode.engine.transport.link._shared_memory import SHARED_FROM, BufferMappings
from aionode.errors import FrameError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.engine.transport.link._protocol import Control, Frame
    from aionode.engine.transport.link._shared_memory import BufferPool, SharedBuffer
    from aionode.engine.wire.cdr import Data

__all__ = ["Connection", "LinkOwner", "WriteWaiter", "flush"]

logger = logging.getLogger("aionode.transport.link")

READ_BYTES: Final = 1 << 15
"""Bytes to read before the rest of the loop runs: a few hundred small messages."""

READ_MAX: Final = 1 << 20
"""Bytes to read at once of a large payload."""

LAST_READS: Final = 10_000
"""Maximum number of consecutive reads from one socket: more than it can hold, so that a peer that
keeps writing does not block the loop.
"""

BATCH_BYTES: Final = 1 << 16
"""A batch of at least this size is sent without waiting for the loop's next iteration, in bytes."""

LENT_BYTES: Final = 96 << 20
LENT_PIECES: Final = 256
"""Limits of the shared memory lent to one process, in bytes and in buffers, each of which takes one
or two descriptors. A frozen process releases none, and its socket may hold hundreds of references;
beyond the limit, payloads go through the stream, where a full socket stops them.
"""

URGENT_BYTES: Final = 1 << 28
"""Maximum number of bytes that wait for a process that sends requests but reads no responses."""

MAX_HELD: Final = 1 << 20
"""Size from which an incomplete frame is reported to `LinkOwner.on_held`, in bytes."""

DESCRIPTORS: Final = 16
"""Maximum number of descriptors to receive at once."""

MAX_DESCRIPTORS: Final = 64
"""Maximum number of descriptors waiting for their frames: each comes with its frame's first
byte."""

STALLED_S: Final = 1.0
"""How long a process may leave pending data unread when a context closes, in seconds."""

BURST_NS: Final = 20_000
"""Frames sent within this time of the previous one wait for the loop's next iteration.

A system call costs more than everything else about a small message.
"""

NO_DESCRIPTOR: Final = "a descriptor could not be received: too many files are open"

# Plain numbers, as enumeration members are slower.
MSG_CMSG_CLOEXEC: Final = int(getattr(socket, "MSG_CMSG_CLOEXEC", 0))
MSG_CTRUNC: Final = int(getattr(socket, "MSG_CTRUNC", 0))
DATA: Final = int(Kind.DATA)
REQUEST: Final = int(Kind.REQUEST)
REPLY: Final = int(Kind.REPLY)


class WriteWaiter(Protocol):
    """A queue of frames that waits for the socket to become writable."""

    @property
    def name(self) -> str:
        """The topic, for log messages."""

    @property
    def unsent(self) -> int:
        """The number of messages not yet written to the socket, or only partly."""

    def on_writable(self) -> None:
        """Write until `Connection.write` refuses, and then call `when_writable` again."""


class LinkOwner(Protocol):
    """Handles the events of a connection."""

    def on_call(
        self,
        connection: Connection,
        kind: int,
        sequence: int,
        source_ns: int,
        client: bytes,
        payload: Data,
        inline_deadline_ns: int,
    ) -> None:
        """Handle a REQUEST or REPLY; callbacks may run within this call until the deadline.

        Raises:
            FrameError: it does not belong here; this ends the link.
        """

    def on_control(self, connection: Connection, control: Control) -> None:
        """Handle a control frame."""

    def on_held(self, connection: Connection) -> None:
        """Handle that the connection holds a large part of an incomplete frame."""

    def on_closed(self, connection: Connection) -> None:
        """Handle that the socket was closed by either end; called once."""


class Connection:
    """An open socket. Everything happens on the loop's thread.

    Args:
        loop: The running loop.
        sock: A connected, non-blocking socket; the connection closes it.
        pool: The buffers of this context.
        owner: Handles its events.

    Attributes:
        participant: The context at the other end; empty before its `Hello`.
        secret: Authenticates this end to the other one when Zenoh continues the link.
        pool: The buffers of this context.
        receivers: The subscriptions here that receive from publishers of the other process.
        lent: The buffers that the other process is reading, by number, until it releases them.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        sock: socket.socket,
        pool: BufferPool,
        owner: LinkOwner,
    ) -> None:
        self.participant = ""
        self.secret = os.urandom(SECRET_SIZE)
        self.pool = pool
        self.receivers = ReceiverTable()
        self._loop = loop
        self._sock: socket.socket | None = sock
        self._fd = sock.fileno()
        self._owner = owner
        self._on_call = partial(owner.on_call, self)
        self._parser = FrameParser()
        self._max_held = HEADER_SIZE + SECRET_SIZE - 1  # a Hello is a header and a secret
        # Descriptors received before the rest of their frames.
        self._descriptors: deque[int] = deque()
        self._ancillary = socket.CMSG_SPACE(DESCRIPTORS * array.array("i").itemsize)
        # Frames of a burst, to be sent together in the loop's next iteration.
        self._batch: list[bytes] = []
        self._batched = 0
        self._flush_planned = False
        self._sent_ns = 0
        # Whether the socket is full, and whether sending has failed for good.
        self._full = False
        self._failed = False
        # The rest of a frame or batch of which the socket accepted only a part.
        self._rest = memoryview(b"")
        # Frames that are never dropped, and precede the queues once the socket is writable.
        self._urgent: deque[tuple[bytes, SharedBuffer | None]] = deque()
        self._urgent_bytes = 0
        # Queues waiting for the socket, in turn; emptied whenever it is writable.
        self._queues: dict[WriteWaiter, None] = {}
        # Numbers of the buffers whose descriptors the other process has, until they are closed.
        self._known: set[int] = set()
        self.lent: dict[int, SharedBuffer] = {}
        self._lent_bytes = 0
        # The other process's buffers that are mapped here.
        self._mappings = BufferMappings()
        # Futures that `progress` has returned and that are not done yet.
        self._waiters: list[asyncio.Future[None]] = []
        pool.listeners.add(self._on_buffer_closed)
        loop.add_reader(self._fd, self._on_readable)

    def __repr__(self) -> str:
        state = "closed" if self.closed else "full" if self._full else "open"
        return f"<Connection {self.participant or 'unknown'} {state}>"

    @property
    def closed(self) -> bool:
        """Whether the socket is closed."""
        return self._sock is None

    # Sending

    def write(self, data: bytes, buffer: SharedBuffer | None = None) -> bool:
        """Write a frame; return False, without taking it, if the socket is full or closed.

        The frame's buffer is released once the other process has released it.
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
        try:  # `_send` inlined: one call less per message
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
        """Call `queue.on_writable` once the socket accepts more."""
        self._queues[queue] = None

    def send(self, control: Control) -> None:
        """Send a control frame, which is never dropped; does nothing if closed.

        It overtakes the queues waiting for the socket, but no other frame sent by this method.
        """
        self._send_now_or_later(control.pack(), None)

    def send_data(
        self, kind: int, sequence: int, source_ns: int, gid: bytes, parts: Sequence[Data]
    ) -> None:
        """Send a frame that is never dropped; a large payload goes through shared memory."""
        size = sum(map(len, parts))
        buffer = self.pool.filled(parts, size) if size >= SHARED_FROM else None
        if buffer is None:
            data = protocol.pack(kind, sequence, source_ns, gid, b"".join(parts))
            if self._urgent or not self.write(data):
                self._send_now_or_later(data, None)
        else:
            reference = BufferRef(buffer.number, buffer.start, size).pack()
            data = protocol.pack(kind, sequence, source_ns, gid, reference, in_shm=True)
            self._send_now_or_later(data, buffer)

    def _send_now_or_later(self, data: bytes, buffer: SharedBuffer | None) -> None:
        if not self._urgent and self.write(data, buffer):
            return
        if not self.closed:
            self._urgent.append((data, buffer))
            self._urgent_bytes += len(data)
            if self._urgent_bytes > URGENT_BYTES and not self._failed:
                self._send_failed(TimeoutError("it does not read the responses to its requests"))
        elif buffer is not None:
            self.pool.release(buffer)

    def _planned_flush(self) -> None:
        self._flush_planned = False
        self._flush()

    def _flush(self) -> None:
        """Send the batch."""
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
        """Send what the socket accepts, and keep the rest."""
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
        """Stop sending, read what the other process has left in the socket, and then close it.

        The process has ended, perhaps right after its last messages, which only this socket holds.
        They are not read here, because this may be called while a frame is being handled.
        """
        if not self._failed:
            self._failed = self._full = True  # keep unsent data for retransmission
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
        limit_reached = self._lent_bytes >= LENT_BYTES or len(self.lent) >= LENT_PIECES
        if limit_reached and buffer.size <= protocol.MAX_INLINE:
            if not self.write(whole(data, buffer)):
                return False
            self.pool.release(buffer)  # the other process does not read it
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
        self.lent[buffer.number] = buffer
        self._lent_bytes += buffer.size
        return True

    def _on_buffer_closed(self, number: int) -> None:
        if number in self._known:
            self._known.discard(number)
            self.send(Forget(number))

    def _on_writable(self) -> None:
        """Send the rest of a frame, then urgent frames, then the queues in turn."""
        if self._failed:
            return
        rest, self._rest = self._rest, memoryview(b"")
        if self._sock is not None and rest:
            self._send(self._sock, rest)
            if self._rest or self._failed:
                self.wake()  # a large frame takes many rounds, each of which is progress
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

    def send_rest(self) -> bool:
        """Send what is pending, as the event loop would next; return whether nothing is left."""
        if self._full:
            self._on_writable()
        else:
            self._flush()
        return self.idle or self._failed or self.closed

    @property
    def idle(self) -> bool:
        """Whether everything was passed to the operating system."""
        return not (self._batch or self._full)

    def unsent(self, gid: bytes) -> int:
        """Count a publisher's messages in the partly written batch that are not completely sent."""
        batch = bytes(self._rest.obj)  # all of it, as `_rest` is a view of its end
        left = len(self._rest)
        unsent = 0
        for frame in reversed(FrameParser().feed(batch) if left else ()):
            if left <= 0:
                break
            left -= HEADER_SIZE + len(frame.payload)
            unsent += frame.kind == DATA and frame.gid == gid
        return unsent

    @property
    def queues(self) -> list[WriteWaiter]:
        """The queues waiting for the socket to accept more."""
        return list(self._queues)

    def progress(self) -> asyncio.Future[None]:
        """Return a future that completes when data is sent, credit arrives, or it is closed."""
        waiter: asyncio.Future[None] = self._loop.create_future()
        if self._sock is None:
            waiter.set_result(None)
        else:
            self._waiters.append(waiter)
        return waiter

    def wake(self) -> None:
        """Complete all futures returned by `progress`."""
        if self._waiters:
            waiters, self._waiters = self._waiters, []
            for waiter in waiters:
                if not waiter.done():
                    waiter.set_result(None)

    # Receiving

    def read_until_eof(self) -> None:
        """Read everything up to the end of a socket that is known to be closed.

        uvloop may not report it: it only does so once, if the other end left data unread.
        """
        for _ in range(LAST_READS):
            if not self._on_readable():
                return

    def _on_readable(self) -> bool:  # noqa: C901  # one call for each message
        """Read once; return whether there was anything, as then there may be more."""
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
            deadline_ns = perf_ns() + SLICE_NS
            data = self._parser.take_messages(
                data, self.receivers.handlers, self._on_call, deadline_ns
            )
            if data:
                self._take_frames(self._parser.feed(data), deadline_ns)
        except FrameError as error:
            self.close(error if not flags & MSG_CTRUNC else FrameError(NO_DESCRIPTOR))
        else:
            if flags & MSG_CTRUNC:  # frames before the one that lacks its descriptor are complete
                self.close(FrameError(NO_DESCRIPTOR))
            elif data and self._parser.held > self._max_held:
                self._owner.on_held(self)
        return True

    def _take_frames(self, frames: list[Frame], inline_deadline_ns: int) -> None:
        handlers = self.receivers.handlers
        for frame in frames:
            kind = frame.kind
            if kind == DATA:
                payload: Data = self._map(frame) if frame.in_shm else frame.payload
                handler = handlers.get(frame.gid)
                if handler is not None:  # otherwise the subscription was just destroyed
                    handler(payload, frame.sequence, frame.source_ns, inline_deadline_ns)
            elif kind in (REPLY, REQUEST):
                payload = self._map(frame) if frame.in_shm else frame.payload
                self._on_call(
                    kind, frame.sequence, frame.source_ns, frame.gid, payload, inline_deadline_ns
                )
            else:
                self._take_control(decode_control(frame))

    def _take_control(self, control: Control) -> None:
        if isinstance(control, Release):
            self._on_release(control.buffer)
        elif isinstance(control, Forget):
            self._mappings.forget(control.buffer)
        else:
            self._owner.on_control(self, control)

    @property
    def held(self) -> int:
        """The number of bytes held of an incomplete frame."""
        return self._parser.held

    def accept_hello(self, participant: str) -> None:
        """Accept any frame from now on: the other end is the context `participant`."""
        self.participant = participant
        self._max_held = MAX_HELD

    def _take_descriptors(self, ancillary: list[tuple[int, int, bytes]]) -> None:
        for level, kind, data in ancillary:
            if level == socket.SOL_SOCKET and kind == socket.SCM_RIGHTS:
                descriptors = array.array("i")
                descriptors.frombytes(data[: len(data) - len(data) % descriptors.itemsize])
                self._descriptors.extend(descriptors)
        if len(self._descriptors) > MAX_DESCRIPTORS:
            raise FrameError(f"{len(self._descriptors)} descriptors without their frames")

    def _map(self, frame: Frame) -> memoryview:
        ref = BufferRef.unpack(frame.payload)
        fd = None
        if frame.has_fd:
            if not self._descriptors:
                raise FrameError(f"expected the descriptor of buffer {ref.number}, got none")
            fd = self._descriptors.popleft()
        return self._mappings.view(
            ref.number, ref.start, ref.size, fd, lambda: self._release_soon(ref.number)
        )

    def _release_soon(self, number: int) -> None:
        """Release a buffer of the other process; called on any thread, within any other call."""
        # A buffer that the garbage collector frees just before the loop sleeps is released once it
        # wakes up again, at the latest after a keep-alive; until then it is only kept for longer.
        call_soon = self._loop.call_soon_threadsafe
        with suppress(RuntimeError):  # in another thread
            if running_loop() is self._loop:
                call_soon = self._loop.call_soon  # without a system call to wake it
        with suppress(RuntimeError):  # the loop is closed, and so is the socket
            call_soon(self.send, Release(number))

    def _on_release(self, number: int) -> None:
        buffer = self.lent.pop(number, None)
        if buffer is not None:
            self._lent_bytes -= buffer.size
            self.pool.release(buffer)

    # Closing

    def abandon(self) -> None:
        """Close this process's descriptor of the socket, which another process keeps using."""
        sock, self._sock = self._sock, None
        if sock is not None:
            sock.close()

    def close(self, reason: Exception | None = None) -> None:
        """Close the socket, even with data pending; repeating it has no effect."""
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
        for buffer in self.lent.values():
            buffer.retired = True  # the other process may still be reading it
            self.pool.release(buffer)
        self.lent.clear()
        self._lent_bytes = self._urgent_bytes = 0
        self.pool.listeners.discard(self._on_buffer_closed)
        self._mappings.close()
        self.wake()
        self._owner.on_closed(self)


def whole(data: bytes, buffer: SharedBuffer) -> bytes:
    """Return a frame with its payload in the stream instead of in shared memory."""
    (frame,) = FrameParser().feed(data)
    payload = buffer.read(BufferRef.unpack(frame.payload).size)
    return protocol.pack(frame.kind, frame.sequence, frame.source_ns, frame.gid, payload)


async def flush(connection: Connection) -> None:
    """Wait until everything was passed to the operating system, or nothing is read for a while."""
    try:
        while not (connection.idle or connection.closed):
            async with asyncio.timeout(STALLED_S):
                await connection.progress()
    except TimeoutError:
        for queue in connection.queues:
            if unsent := queue.unsent:
                logger.warning(
                    "%s: dropped the last %d messages to process %s, which has read nothing "
                    "for %g s",
                    queue.name,
                    unsent,
                    connection.participant,
                    STALLED_S,
                )
