"""The stop of a lease, over links and Zenoh."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from aionode.engine.transport.base import StopSender
from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._protocol import BufferRef, Kind
from aionode.engine.transport.link._send_queue import DATA
from aionode.engine.transport.link._shared_memory import SHARED_FROM

if TYPE_CHECKING:
    from aionode.engine.transport.base import Writer
    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._registry import LinkRegistry
    from aionode.engine.transport.link._send_queue import LinkSendQueue

__all__ = ["LinkStop"]


class StoppableWriter(Protocol):
    """The members of a `LinkWriter` used by the stop of a lease."""

    _registry: LinkRegistry
    _gid: bytes
    _zenoh: Writer
    _send_queues: dict[Connection, LinkSendQueue]
    _sequence: int
    _needs_zenoh: bool

    def update(self) -> bool: ...


class LinkStop(StopSender):
    """Sends the stop of a lease over each route that a subscription needs.

    Only the loop may write to a link's socket, which may hold a partial frame. While the loop is
    blocked, the stop goes over Zenoh to each linked context, as a frame marked as such, after which
    the subscriptions there accept nothing older from the link.

    Args:
        writer: The publisher.
        payload: The message.
        zenoh: Sends it over Zenoh.
    """

    def __init__(self, writer: StoppableWriter, payload: bytes, zenoh: StopSender) -> None:
        self._writer = writer
        self._zenoh = zenoh
        self._payload = payload
        self._frame = b""  # for other contexts, once it was sent while the loop was blocked

    def send(self, sequence: int, source_ns: int) -> None:
        """Send it."""
        writer = self._writer
        payload, pool = self._payload, writer._registry.pool
        buffer = None
        if writer._send_queues and len(payload) >= SHARED_FROM:
            buffer = pool.filled(payload)
        if buffer is not None:
            payload = BufferRef(buffer.number, len(payload)).pack()
        data = protocol.pack(
            DATA, sequence, source_ns, writer._gid, payload, in_shm=buffer is not None
        )
        for send_queue in tuple(writer._send_queues.values()):
            send_queue.send_stop(sequence, data, buffer)
            if send_queue.waits:  # the socket is full, with messages of other topics ahead
                self._post(send_queue.connection, sequence, source_ns)
        if buffer is not None:
            pool.release(buffer)
        writer._sequence = sequence
        if writer._needs_zenoh and writer.update():
            self._zenoh.send(sequence, source_ns)

    def send_past_loop(self, sequence: int, source_ns: int) -> None:
        """Send it only over Zenoh."""
        for connection in list(self._writer._send_queues):
            self._post(connection, sequence, source_ns)
        if self._writer._needs_zenoh:
            self._zenoh.send_past_loop(sequence, source_ns)

    def repeat(self) -> None:
        """Send it over Zenoh once more."""
        if self._frame:
            for connection in list(self._writer._send_queues):
                self._writer._registry.post(connection, self._frame)
        if self._writer._needs_zenoh:
            self._zenoh.repeat()

    def _post(self, connection: Connection, sequence: int, source_ns: int) -> None:
        self._frame = protocol.pack(
            Kind.STOP, sequence, source_ns, self._writer._gid, self._payload
        )
        self._writer._registry.post(connection, self._frame)
