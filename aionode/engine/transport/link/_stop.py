"""The stop of a lease, over links and Zenoh."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.transport.base import StopSender
from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._protocol import BufferRef, Kind
from aionode.engine.transport.link._send_queue import DATA
from aionode.engine.transport.link._shared_memory import SHARED_FROM

if TYPE_CHECKING:
    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._routes import LinkRoutes

__all__ = ["LinkStop"]


class LinkStop(StopSender):
    """Sends the stop of a lease over each route that a subscription needs.

    Only the loop may write to a link's socket, which may hold a partial frame. While the loop is
    blocked, the stop goes over Zenoh to each linked context, as a frame marked as such, after which
    the subscriptions there accept nothing older from the link.

    Args:
        routes: The routes of the publisher's messages.
        gid: Identifies the publisher.
        payload: The message.
        zenoh: Sends it over Zenoh.
    """

    def __init__(self, routes: LinkRoutes, gid: bytes, payload: bytes, zenoh: StopSender) -> None:
        self._routes = routes
        self._gid = gid
        self._zenoh = zenoh
        self._payload = payload
        self._frame = b""  # for other contexts, once it was sent while the loop was blocked

    def send(self, sequence: int, source_ns: int) -> None:
        """Send the stop."""
        routes = self._routes
        payload, pool = self._payload, routes.registry.pool
        buffer = None
        if routes.send_queues and len(payload) >= SHARED_FROM:
            buffer = pool.filled(payload)
        if buffer is not None:
            payload = BufferRef(buffer.number, buffer.start, len(payload)).pack()
        data = protocol.pack(
            DATA, sequence, source_ns, self._gid, payload, in_shm=buffer is not None
        )
        for send_queue in tuple(routes.send_queues.values()):
            send_queue.send_stop(sequence, data, buffer)
            if send_queue.waits:  # the socket is full, with messages of other topics ahead
                self._post(send_queue.connection, sequence, source_ns)
        if buffer is not None:
            pool.release(buffer)
        routes.sequence = sequence
        if routes.needs_zenoh and routes.update():
            self._zenoh.send(sequence, source_ns)

    def send_past_loop(self, sequence: int, source_ns: int) -> None:
        """Send the stop over Zenoh only."""
        for connection in list(self._routes.send_queues):
            self._post(connection, sequence, source_ns)
        if self._routes.needs_zenoh:
            self._zenoh.send_past_loop(sequence, source_ns)

    def repeat(self) -> None:
        """Send the stop over Zenoh once more."""
        if self._frame:
            for connection in list(self._routes.send_queues):
                self._routes.registry.post(connection, self._frame)
        if self._routes.needs_zenoh:
            self._zenoh.repeat()

    def _post(self, connection: Connection, sequence: int, source_ns: int) -> None:
        self._frame = protocol.pack(Kind.STOP, sequence, source_ns, self._gid, self._payload)
        self._routes.registry.post(connection, self._frame)
