"""One socket between two processes: frames out of it, and frames into it without ever blocking."""

from __future__ import annotations

import array
import logging
import os
import socket
from collections import deque
from typing import TYPE_CHECKING, Final, NamedTuple

from aionode.clock import perf_ns
from aionode.errors import FrameError
from aionode.transport.link.memory import mapped
from aionode.wire import frame
from aionode.wire.frame import FrameParser, Kind, Place

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from aionode.transport.link.memory import Memory, Pool
    from aionode.wire.cdr import Data
    from aionode.wire.frame import Frame

__all__ = ["Connection", "Packet", "Stream"]

logger = logging.getLogger("aionode.transport.link")

READ_BYTES: Final = 1 << 15
"""How much is read before the rest of the loop has its turn: some hundred small messages."""

READ_MAX: Final = 1 << 20
BATCH_BYTES: Final = 1 << 16
DESCRIPTORS: Final = 16
BURST_NS: Final = 20_000
"""What is sent within this time after the last is collected until the loop's next turn.

A system call costs more than the rest of a small message's way.
"""

NOBODY: Final = bytes(frame.GID_SIZE)


class Packet(NamedTuple):
    """A frame on its way out, and the memory that goes with it."""

    data: bytes
    memory: Memory | None = None


class Stream:
    """What one publisher has not sent yet to one other process.

    Attributes:
        waiting: Its packets, the oldest first.
        depth: How many of them there are at most, unless it keeps all.
        dropped: How many were dropped because there was one more.
    """

    __slots__ = ("depth", "dropped", "keep_all", "waiting")

    def __init__(self, depth: int, *, keep_all: bool) -> None:
        self.waiting: deque[Packet] = deque()
        self.depth = depth
        self.keep_all = keep_all
        self.dropped = 0


class Connection:
    """An open socket. Everything happens on the loop's thread.

    Args:
        loop: The running loop.
        sock: Connected and not blocking; closed with this.
        pool: Where memory that was sent comes from.
        handle: Called with each frame and its payload.
        on_closed: Called once when the socket is closed from either end.

    Attributes:
        participant: Who is at the other end; empty before it has said so.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        sock: socket.socket,
        pool: Pool,
        handle: Callable[[Connection, Frame, Data], None],
        on_closed: Callable[[Connection], None],
    ) -> None:
        self.participant = ""
        self._loop = loop
        self._sock: socket.socket | None = sock
        self._fd = sock.fileno()
        self._pool = pool
        self._handle = handle
        self._on_closed = on_closed
        self._parser = FrameParser()
        self._descriptors: deque[int] = deque()
        self._ancillary = socket.CMSG_SPACE(DESCRIPTORS * array.array("i").itemsize)
        # In order; a stream stands here once for each of its packets, so that one that drops its
        # oldest does not lose its place among the others.
        self._queue: deque[Packet | Stream] = deque()
        self._rest: memoryview | None = None
        self._blocked = False
        self._flush_planned = False
        self._sent_ns = 0
        self._lent: dict[int, Memory] = {}
        self._returned: deque[int] = deque()
        self._waiters: list[asyncio.Future[None]] = []
        loop.add_reader(self._fd, self._on_readable)

    def __repr__(self) -> str:
        state = "closed" if self._sock is None else "blocked" if self._blocked else "open"
        return f"<Connection {self.participant or 'nobody'} {state} queued={len(self._queue)}>"

    @property
    def closed(self) -> bool:
        """Whether nothing can be sent any more."""
        return self._sock is None

    # Out

    def send(
        self, kind: Kind, sequence: int, gid: bytes, payload: bytes = b"", source_ns: int = 0
    ) -> None:
        """Send a frame that is never dropped; nothing happens when closed."""
        self.put(Packet(frame.pack(kind, sequence, source_ns, gid, payload)), None)

    def send_large(
        self, kind: Kind, sequence: int, gid: bytes, payload: bytes, source_ns: int, limit: int
    ) -> None:
        """Send a frame that is never dropped, its payload by descriptor from `limit` bytes on."""
        memory = self._pool.filled(payload) if len(payload) >= limit else None
        if memory is None:
            self.send(kind, sequence, gid, payload, source_ns)
            return
        place = Place(memory.number, len(payload)).pack()
        data = frame.pack(kind, sequence, source_ns, gid, place, elsewhere=True)
        self.put(Packet(data, memory), None)

    def put(self, packet: Packet, stream: Stream | None) -> None:
        """Send a packet after those before it; a full stream that may drops its oldest.

        The packet's memory is released when the other process has done so.
        """
        if self._sock is None:
            self.give_back(packet)
            return
        now_ns = perf_ns()
        if not self._queue and self._rest is None and now_ns - self._sent_ns > BURST_NS:
            self._queue.append(packet)
            self._flush()
            self._sent_ns = perf_ns()
            return
        if stream is not None:
            if len(stream.waiting) >= stream.depth:
                self._flush()
            if not stream.keep_all and len(stream.waiting) >= stream.depth:
                stream.dropped += 1
                self.give_back(stream.waiting.popleft())
                stream.waiting.append(packet)
                return
            stream.waiting.append(packet)
            self._queue.append(stream)
        else:
            self._queue.append(packet)
        if not self._blocked and not self._flush_planned:
            self._flush_planned = True
            self._loop.call_soon(self._planned_flush)

    def _planned_flush(self) -> None:
        self._flush_planned = False
        self._flush()

    def _flush(self) -> None:
        """Send until the queue is empty or the socket is full."""
        sock = self._sock
        if sock is None:
            return
        try:
            while self._queue or self._rest is not None:
                if self._rest is not None:
                    sent = sock.send(self._rest)
                    self._rest = self._rest[sent:] if sent < len(self._rest) else None
                else:
                    self._send_next(sock)
        except (BlockingIOError, InterruptedError):
            if not self._blocked:
                self._blocked = True
                self._loop.add_writer(self._fd, self._flush)
            return
        except OSError as error:
            self.close(error)
            return
        if self._blocked:
            self._blocked = False
            self._loop.remove_writer(self._fd)
        self.wake()

    def _send_next(self, sock: socket.socket) -> None:
        """Send the oldest packet, and with it those after it that are small."""
        packet = self._take()
        if packet.memory is not None:
            self._send_with_memory(sock, packet, packet.memory)
            return
        batch = [packet.data]
        size = len(packet.data)
        while self._queue and size < BATCH_BYTES:
            packet = self._take()
            if packet.memory is not None:
                self._queue.appendleft(packet)
                break
            batch.append(packet.data)
            size += len(packet.data)
        data = b"".join(batch) if len(batch) > 1 else batch[0]
        self._rest = memoryview(data)
        sent = sock.send(data)
        self._rest = self._rest[sent:] if sent < size else None

    def _send_with_memory(self, sock: socket.socket, packet: Packet, memory: Memory) -> None:
        self._queue.appendleft(packet)  # its place, should the socket be full
        sent = socket.send_fds(sock, [packet.data], [memory.fd])
        self._queue.popleft()
        self._lent[memory.number] = memory
        if sent < len(packet.data):
            self._rest = memoryview(packet.data)[sent:]

    def _take(self) -> Packet:
        first = self._queue.popleft()
        return first.waiting.popleft() if isinstance(first, Stream) else first

    def give_back(self, packet: Packet) -> None:
        """Release the memory of a packet that is not sent."""
        if packet.memory is not None:
            self._pool.release(packet.memory)

    @property
    def idle(self) -> bool:
        """Whether everything was handed to the system."""
        return self._rest is None and not self._queue

    def progress(self) -> asyncio.Future[None]:
        """Return what is done when the queue gets empty, credit comes, or the socket closes."""
        waiter: asyncio.Future[None] = self._loop.create_future()
        if self._sock is None:
            waiter.set_result(None)
        else:
            self._waiters.append(waiter)
        return waiter

    def wake(self) -> None:
        """End each `progress`."""
        waiters, self._waiters = self._waiters, []
        for waiter in waiters:
            if not waiter.done():
                waiter.set_result(None)

    # In

    def _on_readable(self) -> None:
        sock = self._sock
        if sock is None:
            return
        try:
            data, ancillary, flags, _ = sock.recvmsg(
                max(READ_BYTES, min(self._parser.missing, READ_MAX)),
                self._ancillary,
                socket.MSG_CMSG_CLOEXEC,
            )
            if ancillary:
                self._take_descriptors(ancillary)
            if flags & socket.MSG_CTRUNC:
                raise FrameError("a descriptor that could not be taken: too many are open")
            if not data:
                self.close()
                return
            for one in self._parser.feed(data):
                payload: Data = one.payload
                if one.elsewhere:
                    payload = self._map(one)
                if one.kind == Kind.RELEASE:
                    self._on_release(one.sequence)
                else:
                    self._handle(self, one, payload)
        except (BlockingIOError, InterruptedError):
            return
        except OSError as error:  # a FrameError is one as well
            self.close(error)

    def _take_descriptors(self, ancillary: list[tuple[int, int, bytes]]) -> None:
        for level, kind, data in ancillary:
            if level == socket.SOL_SOCKET and kind == socket.SCM_RIGHTS:
                found = array.array("i")
                found.frombytes(data[: len(data) - len(data) % found.itemsize])
                self._descriptors.extend(found)

    def _map(self, one: Frame) -> memoryview:
        while self._returned:  # noted by whatever thread saw the last user go
            self.send(Kind.RELEASE, self._returned.popleft(), NOBODY)
        number, size = Place.unpack(one.payload)
        if not self._descriptors:
            raise FrameError("a place in memory without its descriptor")
        returned = self._returned
        return mapped(self._descriptors.popleft(), size, lambda: returned.append(number))

    def _on_release(self, number: int) -> None:
        memory = self._lent.pop(number, None)
        if memory is not None:
            self._pool.release(memory)

    # The end

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
        if self._blocked:
            self._loop.remove_writer(self._fd)
        sock.close()
        while self._descriptors:
            os.close(self._descriptors.popleft())
        while self._queue:
            self.give_back(self._take())
        for memory in self._lent.values():
            memory.spoiled = True  # the other process may look at it as long as it likes
            self._pool.release(memory)
        self._lent.clear()
        self._rest = None
        self.wake()
        self._on_closed(self)
