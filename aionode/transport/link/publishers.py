"""Publishers with two ways to each subscription: here it is decided which one a message takes."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import FrameError
from aionode.graph import EndpointKind
from aionode.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from aionode.transport.base import Writer
from aionode.transport.link.connection import whole
from aionode.transport.link.memory import SHARED_FROM
from aionode.wire import cdr, frame
from aionode.wire.frame import Kind, Place
from aionode.wire.layout import has_views

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile
    from aionode.transport.base import Origin
    from aionode.transport.link.connection import Connection
    from aionode.transport.link.hub import Hub
    from aionode.transport.link.memory import Memory
    from aionode.wire.cdr import Data

__all__ = ["LinkWriter", "can_link", "depth_of", "keeps_all"]

KEEP_ALL_DEPTH: Final = 10_000

MAX_READERS: Final = 1_000
"""How many subscriptions to one topic a process may have."""

MAX_UNCONFIRMED: Final = 20_000
"""How many messages are kept until they are confirmed; more than any reader has that confirms."""

DATA: Final = int(Kind.DATA)


def depth_of(qos: QoSProfile) -> int:
    """Return how many messages an endpoint keeps."""
    resolved = qos.resolved()
    keeps_all = resolved.history is HistoryPolicy.KEEP_ALL
    return max(resolved.depth, KEEP_ALL_DEPTH) if keeps_all else resolved.depth


def keeps_all(qos: QoSProfile) -> bool:
    """Whether nothing may be dropped."""
    resolved = qos.resolved()
    return (
        resolved.history is HistoryPolicy.KEEP_ALL
        and resolved.reliability is ReliabilityPolicy.RELIABLE
    )


def can_link(publisher: EndpointInfo) -> bool:
    """Whether a publisher's messages may go over a link.

    Those that are kept for late readers are kept by Zenoh, which has to know them all.
    """
    return publisher.qos.resolved().durability is not DurabilityPolicy.TRANSIENT_LOCAL


class RemoteReader:
    """A subscription at the other end of a link, as its publisher sees it."""

    __slots__ = ("confirmed", "confirms", "switched", "used", "window")

    def __init__(self, window: int, used: int, confirmed: int, *, confirms: bool) -> None:
        self.window = window
        self.used = used
        self.confirms = confirms
        self.confirmed = confirmed
        self.switched = False


class Route:
    """The way from one publisher to the subscriptions of one other process.

    A message waits here while the socket is full, or a KEEP_ALL subscription has no window for it;
    the oldest is dropped if that may be. What was sent is kept until it is confirmed.

    Attributes:
        name: The topic.
        connection: The link.
        readers: The subscriptions, by gid.
        dropped: How many messages were dropped because others waited.
    """

    __slots__ = (
        "_depth",
        "_keep_all",
        "_limited",
        "_sent",
        "_unconfirmed",
        "_waiting",
        "confirmed",
        "connection",
        "dropped",
        "name",
        "readers",
    )

    def __init__(self, name: str, connection: Connection, depth: int, *, keep_all: bool) -> None:
        self.name = name
        self.connection = connection
        self.readers: dict[bytes, RemoteReader] = {}
        self.dropped = 0
        self.confirmed = False
        self._depth = depth
        self._keep_all = keep_all
        self._limited = False
        self._sent = 0
        # By number: the frame, and the memory that holds its payload.
        self._waiting: deque[tuple[int, bytes, Memory | None]] = deque()
        self._unconfirmed: deque[tuple[int, bytes, Memory | None]] = deque()

    # Who listens

    def add(self, gid: bytes, reader: RemoteReader) -> None:
        """Send to a reader from now on.

        Raises:
            FrameError: there are more of them than can be.
        """
        if len(self.readers) >= MAX_READERS:
            raise FrameError(f"more than {MAX_READERS} subscriptions of one process to {self.name}")
        reader.used = self._sent
        self.readers[gid] = reader
        self._note_readers()

    def remove(self, gid: bytes) -> None:
        """Send to a reader no longer."""
        self.readers.pop(gid, None)
        self._note_readers()
        self._confirm()
        self.go_on()

    def _note_readers(self) -> None:
        self.confirmed = any(reader.confirms for reader in self.readers.values())
        self._limited = any(reader.window for reader in self.readers.values())

    def credit(self, gid: bytes, used: int, confirmed: int) -> None:
        """Note that a reader has used so many more messages, and has those up to a number."""
        reader = self.readers.get(gid)
        if reader is None:
            return
        reader.used += used
        reader.confirmed = confirmed
        self._confirm()
        if self._waiting:
            self.go_on()
        self.connection.wake()

    def _confirm(self) -> None:
        """Forget what everybody has."""
        everybody = min(
            (reader.confirmed for reader in self.readers.values() if reader.confirms),
            default=1 << 63,
        )
        unconfirmed = self._unconfirmed
        while unconfirmed and unconfirmed[0][0] <= everybody:
            self._let_go(unconfirmed.popleft()[2])

    # What is sent

    def send(self, sequence: int, data: bytes, memory: Memory | None = None) -> None:
        """Send a frame in its turn; without waiting where that is possible."""
        if not (self._limited or self._waiting or memory):  # `_pass` in fewer calls
            if self.confirmed:
                self._unconfirmed.append((sequence, data, None))
            if self.connection.write(data):
                self._sent += 1
                if len(self._unconfirmed) > MAX_UNCONFIRMED:
                    self._let_go(self._unconfirmed.popleft()[2])
                return
            if self.confirmed:
                self._unconfirmed.pop()
        if self._waiting or not self._pass(sequence, data, memory):
            waiting = self._waiting
            if not self._keep_all and len(waiting) >= self._depth:
                self.dropped += 1
                self._let_go(waiting.popleft()[2])
            if memory is not None:
                memory.users += 1
            waiting.append((sequence, data, memory))
            self.connection.when_writable(self)

    def _pass(self, sequence: int, data: bytes, memory: Memory | None) -> bool:
        """Give a frame to the connection, if that and all readers can take it."""
        if self._limited and not self._has_window():
            return False
        if memory is not None:
            memory.users += 1  # of the receiver
        if self.confirmed:
            if memory is not None:
                memory.users += 1
            # First, as the link may turn out to be broken.
            self._unconfirmed.append((sequence, data, memory))
        if not self.connection.write(data, memory):
            self._let_go(memory)
            if self.connection.closed:  # it has taken what is unconfirmed along
                return True
            if self.confirmed:
                self._unconfirmed.pop()
                self._let_go(memory)
            return False
        self._sent += 1
        if len(self._unconfirmed) > MAX_UNCONFIRMED:
            self._let_go(self._unconfirmed.popleft()[2])
        return True

    def _let_go(self, memory: Memory | None) -> None:
        if memory is not None:
            self.connection.pool.release(memory)

    def go_on(self) -> None:
        """Send what waits, as far as the socket and the readers take it."""
        waiting = self._waiting
        while waiting and self._pass(*waiting[0]):
            self._let_go(waiting.popleft()[2])
        if waiting:
            self.connection.when_writable(self)

    def _has_window(self) -> bool:
        return all(
            not reader.window or self._sent - reader.used < reader.window
            for reader in self.readers.values()
        )

    def has_room(self) -> bool:
        """Whether one more can wait."""
        return len(self._waiting) < self._depth

    def is_done(self) -> bool:
        """Whether nothing waits here, nor in the connection."""
        return not self._waiting and self.connection.idle

    def end(self, last: bytes) -> None:
        """Send what waits, whoever has a window for it, and then one last frame."""
        self._limited = False
        self._keep_all = True
        self.send(0, last)
        self.go_on()  # nothing else would: a window may have been waited for, and no credit comes

    @property
    def waiting(self) -> int:
        """How many messages wait."""
        return sum(sequence > 0 for sequence, _, _ in self._waiting)

    @property
    def settled(self) -> bool:
        """Whether nothing waits, and nothing has to be sent again if the link breaks."""
        return not (self._waiting or self._unconfirmed)

    def drop(self) -> None:
        """Give up what is not known to have arrived."""
        for entries in (self._unconfirmed, self._waiting):
            for _, _, memory in entries:
                self._let_go(memory)
            entries.clear()

    def unsaid(self) -> Iterator[bytes]:
        """Yield, as frames with everything in them, what is not known to have arrived."""
        for entries in (self._unconfirmed, self._waiting):
            for _, data, memory in entries:
                yield data if memory is None else whole(data, memory)
                self._let_go(memory)
            entries.clear()


class LinkWriter(Writer):
    """A publisher. Here it is decided which way each message takes.

    Args:
        hub: The links of this context.
        endpoint: The publisher.
        msg_type: Its messages.
        zenoh: Its other way.
    """

    def __init__(
        self, hub: Hub, endpoint: EndpointInfo, msg_type: type[Any], zenoh: Writer
    ) -> None:
        self.endpoint = endpoint
        self.bounded = keeps_all(endpoint.qos)
        self._hub = hub
        self._gid = endpoint.gid
        self._zenoh = zenoh
        self._msg_type = msg_type
        self._reliable = endpoint.qos.resolved().reliability is ReliabilityPolicy.RELIABLE
        self._routes: dict[Connection, Route] = {}
        self._sequence = 0
        # Made when it is needed: most publishers of a node are never heard.
        self._encode: Callable[[Any], bytes] | None = None
        self._shares = False
        # Whether Zenoh has to carry messages too: somebody is matched who has not switched.
        self._needs_zenoh = True
        self._asked_at = -1
        self._dropped = 0
        hub.writers[endpoint.gid] = self

    @property
    def active(self) -> bool:  # type: ignore[override]  # asked for each message, and so computed
        """Whether a message written now would be used."""
        return bool(self._routes) or self._zenoh.active

    @property
    def dropped(self) -> int:
        """How many messages were dropped because a link was slow, or Zenoh."""
        linked = sum(route.dropped for route in self._routes.values())
        return self._dropped + linked + self._zenoh.dropped

    def way_of(self, reader: EndpointInfo) -> str | None:
        """Return ``link``, ``zenoh``, or both while somebody else still needs Zenoh."""
        if not any(reader.gid in route.readers for route in self._routes.values()):
            return self._zenoh.way_of(reader)
        return "link and zenoh" if self.update() else "link"

    @property
    def linked(self) -> int:
        """How many subscriptions get their messages over a link only."""
        return sum(
            reader.switched for route in self._routes.values() for reader in route.readers.values()
        )

    def write(self, msg: Any, origin: Origin) -> None:
        """Send `msg` each way that somebody needs."""
        routes = self._routes
        if routes:
            encode = self._encode
            if encode is None:
                encode = self._encode = cdr.encoder(self._msg_type)
                self._shares = has_views(self._msg_type)
            sequence = origin.sequence
            if self._shares:
                self._write_parts(cdr.parts_encoder(self._msg_type)(msg), origin)
            elif len(payload := encode(msg)) >= SHARED_FROM:
                self._write_parts([payload], origin)
            else:
                # `frame.pack` written out: a call less for each message.
                head = frame.HEADER.pack(
                    len(payload), DATA, 0, frame.MARK, sequence, origin.source_ns, self._gid
                )
                data = head + payload
                for route in tuple(routes.values()):  # one may turn out to be broken
                    route.send(sequence, data)
            self._sequence = sequence
        if self._needs_zenoh and self.update():
            if self._zenoh.active:
                self._zenoh.write(msg, origin)
            self._sequence = origin.sequence

    def _write_parts(self, parts: Sequence[Data], origin: Origin) -> None:
        """Send what may be large: in memory, once for all routes, if it is and there is some."""
        pool = self._hub.pool
        size = sum(map(len, parts))
        memory = pool.filled(parts, size) if size >= SHARED_FROM else None
        payload = b"".join(parts) if memory is None else Place(memory.number, size).pack()
        elsewhere = memory is not None
        data = frame.pack(
            DATA, origin.sequence, origin.source_ns, self._gid, payload, elsewhere=elsewhere
        )
        for route in tuple(self._routes.values()):
            route.send(origin.sequence, data, memory)
        if memory is not None:
            pool.release(memory)

    def has_room(self) -> bool:
        """Whether nobody would lose one more message."""
        return all(route.has_room() for route in self._routes.values()) and (
            not self._needs_zenoh or self._zenoh.has_room()
        )

    async def drain(self) -> None:
        """Wait until `has_room`, and what was written has been handed on."""
        while slow := [route for route in self._routes.values() if not route.is_done()]:
            await slow[0].connection.progress()
        await self._zenoh.drain()

    def close(self) -> None:
        """Withdraw the publisher."""
        self._hub.writers.pop(self._gid, None)
        self._zenoh.close()
        gone = frame.pack(Kind.GONE, 0, 0, self._gid)
        for route in self._routes.values():
            route.end(gone)
            self._hub.keep(self._gid, route)
        self._routes.clear()

    # What readers at the other end of a link want

    def open(self, connection: Connection, reader: bytes, window: int, *, confirms: bool) -> None:
        """Send to `reader` from the next message on."""
        route = self._routes.get(connection)
        if route is None:
            route = Route(
                self.endpoint.name,
                connection,
                depth_of(self.endpoint.qos),
                keep_all=self.bounded,
            )
            self._routes[connection] = route
        route.add(
            reader,
            RemoteReader(
                window if self.bounded else 0,  # who drops its oldest waits for nobody
                0,
                self._sequence,
                confirms=confirms and self._reliable,
            ),
        )
        connection.send(Kind.OPENED, self._sequence, self._gid, reader)
        self.update()

    def switched(self, connection: Connection, reader: bytes) -> None:
        """Note that `reader` needs Zenoh no longer."""
        route = self._routes.get(connection)
        if route is not None and reader in route.readers:
            route.readers[reader].switched = True
            self._asked_at = -1
            self.update()

    def credit(self, connection: Connection, reader: bytes, used: int, confirmed: int) -> None:
        """Note that `reader` has used `used` more messages, and has those up to a number."""
        route = self._routes.get(connection)
        if route is not None:
            route.credit(reader, used, confirmed)

    def leave(self, connection: Connection, reader: bytes) -> None:
        """Send to `reader` no longer."""
        route = self._routes.get(connection)
        if route is None:
            return
        route.remove(reader)
        if not route.readers:
            self._forget(connection)
        self.update()

    def broken(self, connection: Connection) -> Iterator[bytes]:
        """Use `connection` no longer: it is closed; yield the frames that may not have arrived."""
        route = self._forget(connection)
        self.update()
        return iter(()) if route is None else route.unsaid()

    def _forget(self, connection: Connection) -> Route | None:
        route = self._routes.pop(connection, None)
        if route is not None:
            self._dropped += route.dropped
        self._asked_at = -1
        return route

    def update(self) -> bool:
        """Find out whether somebody needs Zenoh: with a token, or a stranger without."""
        hub = self._hub
        if not self._routes or hub.strangers:
            self._needs_zenoh = True
        elif self._asked_at != hub.changes:
            self._asked_at = hub.changes
            switched = {
                gid
                for route in self._routes.values()
                for gid, reader in route.readers.items()
                if reader.switched
            }
            self._needs_zenoh = any(
                other.gid not in switched
                for other in hub.remote(EndpointKind.SUBSCRIPTION, self.endpoint.name)
                if self.endpoint.matches(other)
            )
        return self._needs_zenoh
