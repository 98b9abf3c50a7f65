"""Publishers that send each message over links, over Zenoh, or both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.transport.base import Writer
from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._protocol import (
    MESSAGE_HEADER,
    MESSAGE_MARK,
    BufferRef,
    Gone,
    Opened,
)
from aionode.engine.transport.link._routes import LinkRoutes
from aionode.engine.transport.link._send_queue import DATA, LinkSendQueue, RemoteSubscription
from aionode.engine.transport.link._shared_memory import SHARED_FROM
from aionode.engine.transport.link._stop import LinkStop
from aionode.engine.wire import cdr
from aionode.engine.wire.cdr._layout import has_views
from aionode.qos import ReliabilityPolicy, depth_of, keeps_all

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from aionode.engine.transport.base import StopSender
    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._protocol import Credit, Open
    from aionode.engine.transport.link._registry import LinkRegistry
    from aionode.engine.wire.cdr import Data
    from aionode.graph import EndpointInfo

__all__ = ["LinkWriter"]


class LinkWriter(Writer):
    """A publisher that chooses the route of each message.

    Args:
        registry: The links of this context.
        endpoint: The publisher.
        msg_type: The type of its messages.
        zenoh: Its registration with Zenoh.

    Attributes:
        routes: The routes of its messages.
    """

    def __init__(
        self, registry: LinkRegistry, endpoint: EndpointInfo, msg_type: type[Any], zenoh: Writer
    ) -> None:
        self.endpoint = endpoint
        self.bounded = keeps_all(endpoint.qos)
        self._registry = registry
        self._gid = endpoint.gid
        self._zenoh = zenoh
        self._msg_type = msg_type
        self._reliable = endpoint.qos.resolved().reliability is ReliabilityPolicy.RELIABLE
        self.routes = LinkRoutes(registry, endpoint)
        # Their send queues, for `write`: a broken one may be removed during iteration.
        self._targets: tuple[LinkSendQueue, ...] = ()
        # Encodes messages in one piece; None if there is no link, or if `_write_views` has to
        # handle them.
        self._encode: Callable[[Any], bytes] | None = None
        # Messages dropped by send queues that were removed.
        self._dropped = 0

    @property
    def active(self) -> bool:  # type: ignore[override]  # asked for each message, and so computed
        """Whether a message written now would be used."""
        return bool(self._targets) or self._zenoh.active

    @property
    def dropped(self) -> int:
        """The number of messages dropped because a link or Zenoh was slow."""
        linked = sum(send_queue.dropped for send_queue in self.routes.send_queues.values())
        return self._dropped + linked + self._zenoh.dropped

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return ``link``, ``zenoh``, or both while another subscription still needs Zenoh."""
        if not any(
            reader.gid in send_queue.readers for send_queue in self.routes.send_queues.values()
        ):
            return self._zenoh.route_of(reader)
        return "link and zenoh" if self.routes.update() else "link"

    @property
    def linked(self) -> int:
        """The number of subscriptions that receive only over a link."""
        return sum(
            reader.switched
            for send_queue in self.routes.send_queues.values()
            for reader in send_queue.readers.values()
        )

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg` over each route that a subscription needs."""
        encode, routes = self._encode, self.routes
        if encode is not None:
            payload = encode(msg)
            size = len(payload)
            if size < SHARED_FROM:
                # `protocol.pack` inlined: one call less per message.
                data = MESSAGE_HEADER.pack(size, MESSAGE_MARK, sequence, source_ns, self._gid)
                data += payload
                for send_queue in self._targets:
                    send_queue.send(sequence, data)
            else:
                self._write_parts([payload], sequence, source_ns)
            routes.sequence = sequence
        elif self._targets:
            self._write_views(msg, sequence, source_ns)
            routes.sequence = sequence
        if routes.needs_zenoh and routes.update():
            if self._zenoh.active:
                self._zenoh.write(msg, sequence, source_ns)
            routes.sequence = sequence

    def _write_views(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send a message whose type may contain arrays over links, without copying them."""
        parts = cdr.parts_encoder(self._msg_type)(msg)
        self._write_parts(parts, sequence, source_ns)

    def _targets_changed(self) -> None:
        """Decide how to send from the next message on."""
        self._targets = tuple(self.routes.send_queues.values())
        self._encode = None
        if self._targets and not has_views(self._msg_type):
            self._encode = cdr.encoder(self._msg_type)

    def _write_parts(self, parts: Sequence[Data], sequence: int, source_ns: int) -> None:
        """Send a payload that may be large: if so, through one shared buffer for all links."""
        pool = self._registry.pool
        size = sum(map(len, parts))
        buffer = pool.filled(parts, size) if size >= SHARED_FROM else None
        in_shm = buffer is not None
        payload = (
            b"".join(parts)
            if buffer is None
            else BufferRef(buffer.number, buffer.start, size).pack()
        )
        data = protocol.pack(DATA, sequence, source_ns, self._gid, payload, in_shm=in_shm)
        for send_queue in self._targets:
            send_queue.send(sequence, data, buffer)
        if buffer is not None:
            pool.release(buffer)

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:
        """Return an object that sends the stop of a lease."""
        payload = cdr.encoder(self._msg_type)(stop)
        return LinkStop(self.routes, self._gid, payload, self._zenoh.prepare_stop(stop, is_last))

    def assert_liveliness(self) -> None:
        """Tell the subscriptions of other contexts over Zenoh, which reaches all of them."""
        self._zenoh.assert_liveliness()

    def has_room(self) -> bool:
        """Whether another message could be sent without dropping any."""
        return all(send_queue.has_room() for send_queue in self.routes.send_queues.values()) and (
            not (self.routes.needs_zenoh and self.routes.update()) or self._zenoh.has_room()
        )

    async def drain(self) -> None:
        """Wait until everything was passed to the operating system, or to Zenoh."""
        while slow := self._slow():
            await slow[0].connection.progress()
        await self._zenoh.drain()

    def is_drained(self) -> bool:
        """Return whether `drain` would not have to wait."""
        return not self._slow() and self._zenoh.is_drained()

    def _slow(self) -> list[LinkSendQueue]:
        """Send what can be sent now, and return the queues that have more."""
        send_queues = self.routes.send_queues
        for connection in list(send_queues):
            connection.send_rest()
        return [each for each in send_queues.values() if not each.is_done()]

    def close(self) -> None:
        """Withdraw the publisher."""
        self._registry.remove(self._gid)
        self._zenoh.close()
        gone = Gone(self._gid).pack()
        for send_queue in self.routes.send_queues.values():
            send_queue.end(gone)
            self._registry.keep(self._gid, send_queue)
        self.routes.send_queues.clear()
        self._targets_changed()

    # Control frames of subscriptions at the other end of a link

    def open(self, connection: Connection, asked: Open) -> None:
        """Send to a subscription from the next message on."""
        send_queue = self.routes.send_queues.get(connection)
        if send_queue is None:
            send_queue = LinkSendQueue(
                self._gid,
                self.endpoint.name,
                connection,
                depth_of(self.endpoint.qos),
                keep_all=self.bounded,
            )
            self.routes.send_queues[connection] = send_queue
        send_queue.add(
            asked.subscription,
            RemoteSubscription(
                asked.window
                if self.bounded
                else 0,  # KEEP_LAST drops its oldest instead of waiting
                0,
                self.routes.sequence,
                confirms=asked.confirms and self._reliable,
            ),
        )
        self._targets_changed()
        connection.send(Opened(self._gid, asked.subscription, self.routes.sequence))
        self.routes.reconsider()

    def switched(self, connection: Connection, reader: bytes) -> None:
        """Stop sending to `reader` over Zenoh."""
        send_queue = self.routes.send_queues.get(connection)
        if send_queue is not None and reader in send_queue.readers:
            send_queue.readers[reader].switched = True
            self.routes.reconsider()

    def credit(self, connection: Connection, credit: Credit) -> None:
        """Handle credit from a subscription."""
        send_queue = self.routes.send_queues.get(connection)
        if send_queue is not None:
            send_queue.credit(credit)

    def leave(self, connection: Connection, reader: bytes) -> None:
        """Stop sending to `reader`."""
        send_queue = self.routes.send_queues.get(connection)
        if send_queue is None:
            return
        send_queue.remove(reader)
        if not send_queue.readers:
            self._forget(connection)
        self.routes.reconsider()

    def broken(self, connection: Connection) -> Iterator[bytes]:
        """Stop using a closed `connection`; yield the frames that may not have arrived."""
        send_queue = self._forget(connection)
        self.routes.reconsider()
        return iter(()) if send_queue is None else send_queue.unacked()

    def _forget(self, connection: Connection) -> LinkSendQueue | None:
        send_queue = self.routes.send_queues.pop(connection, None)
        if send_queue is not None:
            self._dropped += send_queue.dropped
            self._targets_changed()
        return send_queue
