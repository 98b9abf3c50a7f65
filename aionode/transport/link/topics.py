"""Publishers and subscriptions, each with two ways to the other end."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import DecodeError
from aionode.graph import EndpointKind
from aionode.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from aionode.transport.base import Announcement, Origin, Writer
from aionode.transport.link.connection import Packet, Stream
from aionode.transport.link.handover import Handover, Way
from aionode.transport.link.memory import SHARED_FROM
from aionode.wire import cdr, frame
from aionode.wire.frame import Kind, Place

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile
    from aionode.transport.base import Reader
    from aionode.transport.link.connection import Connection
    from aionode.transport.link.hub import Hub
    from aionode.wire.cdr import Data

__all__ = ["Inlet", "LinkReader", "LinkWriter", "Tap", "can_link"]

KEEP_ALL_DEPTH: Final = 10_000
WINDOW: Final = 1_000
"""How many messages a KEEP_ALL reader lets a publisher send ahead of what it has used."""

CONFIRM_EACH: Final = 64
"""After how many messages a reader says what it has, if none was large."""

MAX_UNCONFIRMED: Final = 4_096
"""How many messages more than its depth a publisher keeps for the case that a link breaks."""

DATA: Final = int(Kind.DATA)

ZENOH_LATE_S: Final = 0.1
"""How long a reader that holds messages waits for Zenoh to say anything more."""


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


# Sending


class RemoteReader:
    """A subscription at the other end of a link, as its publisher sees it."""

    __slots__ = ("confirmed", "switched", "used", "window")

    def __init__(self, window: int, used: int) -> None:
        self.window = window
        self.used = used
        self.confirmed = 0
        self.switched = False


class Route:
    """The way from one publisher to the subscriptions of one other process.

    What KEEP_ALL subscriptions there have no window for is parked here, and counts as waiting.
    """

    __slots__ = ("_parked", "_sent", "connection", "readers", "stream", "unconfirmed")

    def __init__(self, connection: Connection, depth: int, *, keep_all: bool) -> None:
        self.connection = connection
        self.stream = Stream(depth, keep_all=keep_all)
        self.readers: dict[bytes, RemoteReader] = {}
        # Messages that went nowhere else, by number and time, until their readers have them.
        self.unconfirmed: deque[tuple[int, int, bytes]] = deque(maxlen=depth + MAX_UNCONFIRMED)
        self._parked: deque[Packet] = deque()
        self._sent = 0

    def credit(self, reader: bytes, used: int, confirmed: int) -> None:
        """Note that `reader` has used so many more messages, and has those up to a number."""
        remote = self.readers.get(reader)
        if remote is None:
            return
        remote.used += used
        remote.confirmed = confirmed
        everybody = min(each.confirmed for each in self.readers.values())
        while self.unconfirmed and self.unconfirmed[0][0] <= everybody:
            self.unconfirmed.popleft()
        self.go_on()

    def add(self, reader: bytes, window: int) -> None:
        """Send to `reader` from now on; a window of 0 is without limit."""
        self.readers[reader] = RemoteReader(window, self._sent)

    def send(self, packet: Packet) -> None:
        """Send a packet when everybody has a window for it."""
        if self._parked or not self._has_window():
            self._parked.append(packet)
        else:
            self._sent += 1
            self.connection.put(packet, self.stream)

    def go_on(self) -> None:
        """Send what was parked, as far as there are windows now."""
        while self._parked and self._has_window():
            self._sent += 1
            self.connection.put(self._parked.popleft(), self.stream)
        self.connection.wake()

    def drop(self) -> None:
        """Forget what was parked."""
        while self._parked:
            self.connection.give_back(self._parked.popleft())

    def end(self) -> None:
        """Send what was parked, whoever has room for it."""
        while self._parked:
            self.connection.put(self._parked.popleft(), self.stream)

    def _has_window(self) -> bool:
        for reader in self.readers.values():
            if reader.window and self._sent - reader.used >= reader.window:
                return False
        return True

    def has_room(self) -> bool:
        """Whether one more can wait."""
        return len(self.stream.waiting) + len(self._parked) < self.stream.depth

    def is_done(self) -> bool:
        """Whether nothing waits here."""
        return not self._parked and self.connection.idle


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
        self._zenoh = zenoh
        self._msg_type = msg_type
        self._reliable = endpoint.qos.resolved().reliability is ReliabilityPolicy.RELIABLE
        self._routes: dict[Connection, Route] = {}
        self._sequence = 0
        self._encode: Callable[[Any], bytes] = self._first_encode
        # Whether Zenoh has to carry messages too: somebody is matched who has not switched.
        self._needs_zenoh = True
        hub.writers[endpoint.gid] = self

    def _first_encode(self, msg: Any) -> bytes:
        """Make the codec when it is needed: most publishers of a node are never heard."""
        self._encode = cdr.encoder(self._msg_type)
        return self._encode(msg)

    @property
    def active(self) -> bool:  # type: ignore[override]  # asked for each message, and so computed
        """Whether a message written now would be used."""
        return bool(self._routes) or self._zenoh.active

    @property
    def dropped(self) -> int:
        """How many messages were dropped because a link was slow."""
        return sum(route.stream.dropped for route in self._routes.values())

    @property
    def linked(self) -> int:
        """How many subscriptions get their messages over a link only."""
        return sum(
            reader.switched for route in self._routes.values() for reader in route.readers.values()
        )

    def write(self, msg: Any, origin: Origin) -> None:
        """Send `msg` each way that somebody needs."""
        # Asked again each time, as somebody may have gone.
        both = self._needs_zenoh and self.update()
        if self._routes:
            payload = self._encode(msg)
            sequence = origin.sequence
            if not both and self._reliable:
                for route in self._routes.values():
                    route.unconfirmed.append((sequence, origin.source_ns, payload))
            if len(payload) < SHARED_FROM:
                gid = self.endpoint.gid
                packet = Packet(frame.pack(DATA, sequence, origin.source_ns, gid, payload))
                for route in tuple(self._routes.values()):
                    route.send(packet)
            else:
                self._write_large(payload, origin)
        if both and self._zenoh.active:
            self._zenoh.write(msg, origin)
        self._sequence = origin.sequence

    def _write_large(self, payload: bytes, origin: Origin) -> None:
        """Send one piece of memory to all; its bytes where there is no memory."""
        pool = self._hub.pool
        gid = self.endpoint.gid
        memory = pool.filled(payload)
        if memory is not None:
            place = Place(memory.number, len(payload)).pack()
            data = frame.pack(DATA, origin.sequence, origin.source_ns, gid, place, elsewhere=True)
        else:
            data = frame.pack(DATA, origin.sequence, origin.source_ns, gid, payload)
        for route in tuple(self._routes.values()):
            if memory is not None:
                memory.users += 1
            route.send(Packet(data, memory))
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
        self._hub.writers.pop(self.endpoint.gid, None)
        self._zenoh.close()
        for connection, route in self._routes.items():
            route.end()
            connection.send(Kind.GONE, 0, self.endpoint.gid)
        self._routes.clear()

    # What readers at the other end of a link want

    def open(self, connection: Connection, reader: bytes, window: int) -> None:
        """Send to `reader` from the next message on."""
        route = self._routes.get(connection)
        if route is None:
            route = Route(connection, depth_of(self.endpoint.qos), keep_all=self.bounded)
            self._routes[connection] = route
        if not self.bounded:
            window = 0  # who drops its oldest waits for nobody
        route.add(reader, window)
        connection.send(Kind.OPENED, self._sequence, self.endpoint.gid, reader)
        self.update()

    def switched(self, connection: Connection, reader: bytes) -> None:
        """Note that `reader` needs Zenoh no longer."""
        route = self._routes.get(connection)
        if route is not None and reader in route.readers:
            route.readers[reader].switched = True
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
        route.readers.pop(reader, None)
        route.go_on()
        if not route.readers:
            del self._routes[connection]
        self.update()

    def broken(self, connection: Connection) -> None:
        """Send over Zenoh again: `connection` is closed; first what may not have come through.

        Its readers leave out what they have. Nobody else was there when it was published, or it
        would have been sent over Zenoh as well.
        """
        route = self._routes.pop(connection, None)
        if route is None:
            return
        route.drop()
        if self._zenoh.active:
            for sequence, source_ns, payload in route.unconfirmed:
                msg = cdr.decode(self._msg_type, payload)
                self._zenoh.write(msg, Origin(self.endpoint.gid, sequence, source_ns))
        self.update()

    def update(self) -> bool:
        """Find out whether somebody needs Zenoh: with a token, or a stranger without."""
        if not self._routes or self._hub.has_strangers:
            self._needs_zenoh = True
            return True
        switched = {
            gid
            for route in self._routes.values()
            for gid, reader in route.readers.items()
            if reader.switched
        }
        self._needs_zenoh = any(
            other.gid not in switched
            for other in self._hub.remote(EndpointKind.SUBSCRIPTION, self.endpoint.name)
            if self.endpoint.matches(other)
        )
        return self._needs_zenoh


# Receiving


class Tap:
    """What Zenoh delivers to in place of the subscription: it leaves out what the link brings."""

    def __init__(self, reader: Reader) -> None:
        self.endpoint = reader.endpoint
        self.raw = reader.raw
        self.reject = reader.reject
        self.has_room = reader.has_room
        self.wait_for_room = reader.wait_for_room
        self.when_room = reader.when_room
        self.inlets: dict[bytes, Inlet] = {}
        self._deliver = reader.deliver

    def deliver(self, msg: Any, origin: Origin) -> None:
        """Take a message that came over Zenoh."""
        inlet = self.inlets.get(origin.gid)
        if inlet is None:
            self._deliver(msg, origin)
        else:
            inlet.from_zenoh(msg, origin)


class Inlet:
    """One subscription and one publisher of another process."""

    def __init__(self, hub: Hub, reader: LinkReader, publisher: bytes) -> None:
        self.reader = reader
        self.publisher = publisher
        self.connection: Connection | None = None
        self.handover = Handover(self._deliver)
        self._hub = hub
        self._decode = reader.decoder()
        self._window = WINDOW if keeps_all(reader.endpoint.qos) else 0
        self._used = 0
        self._number = 0
        # What a KEEP_ALL reader has no room for yet.
        self._full: deque[tuple[Any, Origin]] | None = deque() if self._window else None
        self._waiting_for_room = False
        self._zenoh_spoke = False

    @property
    def gid(self) -> bytes:
        """Of the subscription."""
        return self.reader.gid

    def open(self, connection: Connection) -> None:
        """Ask for the publisher's messages over `connection`."""
        self.connection = connection
        self._used = 0
        connection.send(Kind.OPEN, self._window, self.publisher, self.gid)

    def opened(self, sequence: int) -> None:
        """Note from where on they come."""
        self._tell(self.handover.opened(sequence))

    def from_zenoh(self, msg: Any, origin: Origin) -> None:
        """Take a message that came over Zenoh."""
        self._zenoh_spoke = True
        self._tell(self.handover.from_zenoh(msg, origin))

    def from_link(self, payload: Data, one: frame.Frame) -> None:
        """Take a message that came over the link."""
        try:
            msg = self._decode(payload)
        except DecodeError as error:
            self.reader.reject(error)
            return
        origin = Origin(one.gid, one.sequence, one.source_ns, True)
        handover = self.handover
        self._used += 1
        self._number = one.sequence
        waited = handover.waits
        self._tell(handover.from_link(msg, origin))
        if handover.waits and not waited:
            self._zenoh_spoke = False
            self._hub.later(ZENOH_LATE_S, self._look_for_zenoh)
        if self._used >= CONFIRM_EACH or one.elsewhere:
            self._confirm()

    def _look_for_zenoh(self) -> None:
        """Wait for Zenoh no longer if it has said nothing all the while."""
        if self.handover.way is not Way.BOTH:
            return
        if self._zenoh_spoke:
            self._zenoh_spoke = False
            self._hub.later(ZENOH_LATE_S, self._look_for_zenoh)
        else:
            self._tell(self.handover.switch())

    def _tell(self, switched: bool) -> None:
        if switched and self.connection is not None:
            self.connection.send(Kind.SWITCHED, 0, self.publisher, self.gid)
            self._confirm()

    def _deliver(self, msg: Any, origin: Origin) -> None:
        full = self._full
        if full is None:
            self.reader.deliver(msg, origin)
            return
        full.append((msg, origin))
        self._empty()

    def _empty(self) -> None:
        """Give a KEEP_ALL reader what it has room for; look again soon for the rest."""
        full = self._full
        assert full is not None  # noqa: S101  # only such readers get here
        while full and (self.reader.has_room() or len(full) > 2 * self._window):
            self.reader.deliver(*full.popleft())
        if full and not self._waiting_for_room:
            self._waiting_for_room = True
            self.reader.when_room(self._look_for_room)

    def _look_for_room(self) -> None:
        self._waiting_for_room = False
        self._empty()
        self._confirm()

    def _confirm(self) -> None:
        """Say what is here, unless a KEEP_ALL reader has no room for it or waits for Zenoh."""
        if self._window and self.handover.waits:
            return
        if self._used and self.connection is not None and not self._full:
            used, self._used = self._used, 0
            self.connection.send(Kind.CREDIT, used, self.publisher, self.gid, self._number)

    def broken(self) -> None:
        """Take Zenoh again."""
        self.connection = None
        self.handover.broken()


class LinkReader(Announcement):
    """A subscription with its inlets, one for each publisher that it hears over a link.

    Args:
        hub: The links of this context.
        msg_type: Its messages.
        reader: Where they go.
        tap: What Zenoh delivers to.
        zenoh: Its other way.
    """

    def __init__(
        self, hub: Hub, msg_type: type[Any], reader: Reader, tap: Tap, zenoh: Announcement
    ) -> None:
        self.endpoint = reader.endpoint
        self.deliver = reader.deliver
        self.reject = reader.reject
        self.has_room = reader.has_room
        self.when_room = reader.when_room
        self._raw = reader.raw
        self._msg_type = msg_type
        self._hub = hub
        self._tap = tap
        self._zenoh = zenoh
        # Others know it by its token, which may say more than the graph does (`CPU_BACKEND`).
        self.gid: bytes = getattr(zenoh, "gid", self.endpoint.gid)
        hub.readers[self.gid] = self

    def decoder(self) -> Callable[[Data], Any]:
        """Return what makes its messages of bytes."""
        return bytes if self._raw else cdr.decoder(self._msg_type)

    @property
    def inlets(self) -> dict[bytes, Inlet]:
        """By the publisher's gid."""
        return self._tap.inlets

    def meet(self, publisher: EndpointInfo, connection: Connection) -> None:
        """Ask for the messages of `publisher`, if that was not done yet."""
        if not can_link(publisher) or not self.endpoint.matches(publisher):
            return
        inlet = self.inlets.get(publisher.gid)
        if inlet is None:
            inlet = self.inlets[publisher.gid] = Inlet(self._hub, self, publisher.gid)
        if inlet.connection is None:
            self._hub.inlets.setdefault((connection, publisher.gid), []).append(inlet)
            inlet.open(connection)

    def close(self) -> None:
        """Withdraw the subscription."""
        self._hub.readers.pop(self.gid, None)
        self._zenoh.close()
        for inlet in self.inlets.values():
            if inlet.connection is not None:
                inlet.connection.send(Kind.CLOSE, 0, inlet.publisher, inlet.gid)
            self._hub.forget(inlet)
        self.inlets.clear()
