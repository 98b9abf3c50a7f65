"""The links of one context: who is near, who is linked, and what becomes of each frame."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final

from aionode.clock import MachineTime
from aionode.errors import FrameError, TransportError
from aionode.graph import EndpointKind
from aionode.transport.link.connection import Connection
from aionode.transport.link.memory import Pool
from aionode.transport.link.services import server_of
from aionode.transport.link.topics import can_link
from aionode.wire.frame import GID_SIZE, VERSION, Kind

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable, Iterable

    from aionode.graph import EndpointInfo, Graph
    from aionode.transport.link.meeting import Beacon, Meeting
    from aionode.transport.link.services import LinkCall, LinkServer
    from aionode.transport.link.topics import Inlet, LinkReader, LinkWriter
    from aionode.wire.cdr import Data
    from aionode.wire.frame import Frame

__all__ = ["Hub"]

logger = logging.getLogger("aionode.transport.link")

AGAIN_S: Final = 1.0
"""How long after a link has ended, or no descriptor was left, it is tried again."""


class Hub:
    """The links of one context.

    Of two contexts the one with the smaller id dials, as soon as they have matching endpoints;
    both see the same graph, so that both know.

    Attributes:
        pool: Memory for large payloads.
        writers: Publishers that may use links, by gid.
        readers: Subscriptions, by gid.
        servers: Servers, by gid.
        calls: Requests under way over links, by the client's gid and number.
        inlets: What listens to a publisher over a connection.
        now_ns: The system time, in nanoseconds since 1970.
    """

    def __init__(self, participant: str, domain_id: int) -> None:
        self.participant = participant
        self.domain_id = domain_id
        self.pool = Pool()
        self.writers: dict[bytes, LinkWriter] = {}
        self.readers: dict[bytes, LinkReader] = {}
        self.servers: dict[bytes, LinkServer] = {}
        self.calls: dict[tuple[bytes, int], LinkCall] = {}
        self.inlets: dict[tuple[Connection, bytes], list[Inlet]] = {}
        self.now_ns = MachineTime().system_ns
        self._graph: Graph | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._meeting: Meeting | None = None
        self._near: set[str] = set()
        self._connected: set[str] = set()
        self._strangers: set[str] = set()
        self._links: dict[str, Connection] = {}
        self._opening: set[Connection] = set()
        self._barred: set[str] = set()
        self._timers: set[asyncio.TimerHandle] = set()

    # The whole

    def open(self, graph: Graph, meeting: Meeting) -> None:
        """Begin to accept links, and to dial."""
        self.pool = Pool()
        self._graph = graph
        self._loop = asyncio.get_running_loop()
        self._meeting = meeting
        self._loop.add_reader(meeting.listener.fileno(), self._accept)

    def close(self) -> None:
        """End all links."""
        meeting, self._meeting = self._meeting, None
        if meeting is not None and self._loop is not None:
            self._loop.remove_reader(meeting.listener.fileno())
            meeting.close()
        for timer in self._timers:
            timer.cancel()
        self._timers.clear()
        for connection in [*self._links.values(), *self._opening]:
            connection.close()
        for known in (self._near, self._connected, self._strangers, self._barred):
            known.clear()
        self.pool.close()
        self._graph = None

    async def flush(self) -> None:
        """Wait until what was written was handed to the system."""
        for connection in list(self._links.values()):
            while not connection.idle:
                await connection.progress()

    def later(self, delay_s: float, call: Callable[[], None]) -> None:
        """Call `call` in a while, unless closed before."""
        if self._loop is None or self._meeting is None:
            return

        def run() -> None:
            self._timers.discard(timer)
            call()

        timer = self._loop.call_later(delay_s, run)
        self._timers.add(timer)

    # Who is there

    @property
    def links(self) -> list[str]:
        """The contexts that are linked now."""
        return list(self._links)

    @property
    def has_strangers(self) -> bool:
        """Whether Zenoh is connected to somebody whose subscriptions nobody announces."""
        return bool(self._strangers)

    def linked(self, participant: str) -> Connection | None:
        """Return the link to a context, if there is one."""
        return self._links.get(participant)

    def remote(self, kind: EndpointKind, name: str) -> list[EndpointInfo]:
        """Return the endpoints of other contexts under a name."""
        if self._graph is None:
            return []
        return [
            endpoint
            for endpoint in self._graph.endpoints(kind, name=name)
            if endpoint.node.participant != self.participant
        ]

    def on_beacon(self, beacon: Beacon, present: bool) -> None:
        """Note that a context that can be linked has come or gone."""
        if not present:
            self._near.discard(beacon.participant)
            self._barred.discard(beacon.participant)
            return
        self._near.add(beacon.participant)
        self._strangers.discard(beacon.participant)
        self._consider(beacon.participant)

    def on_sessions(self, connected: Iterable[str]) -> None:
        """Note whom Zenoh is connected to."""
        self._connected = set(connected) - {self.participant}
        announced = set(self._near)
        if self._graph is not None:
            announced |= {node.participant for node in self._graph.nodes()}
        self._strangers = self._connected - announced
        for writer in self.writers.values():
            writer.update()

    def on_endpoint(self, endpoint: EndpointInfo) -> None:
        """Note a new endpoint, of this context or another."""
        if self._graph is None:
            return
        participant = endpoint.node.participant
        if participant != self.participant:
            self._strangers.discard(participant)
            if endpoint.kind is EndpointKind.SUBSCRIPTION:
                for writer in list(self.writers.values()):
                    if writer.endpoint.name == endpoint.name:
                        writer.update()
            self._consider(participant, endpoint)
            return
        for other in {
            e.node.participant for e in self.remote(endpoint.kind.opposite, endpoint.name)
        }:
            self._consider(other)

    def _consider(self, participant: str, endpoint: EndpointInfo | None = None) -> None:
        """Dial a context that has something for us, or meet what is new there."""
        if participant not in self._near:
            return
        connection = self._links.get(participant)
        if connection is not None:
            self._meet(connection, endpoint)
        elif (
            self.participant < participant
            and participant not in self._barred
            and self._has_matches(participant)
        ):
            self._dial(participant)

    def _has_matches(self, participant: str) -> bool:
        if self._graph is None:
            return False
        for theirs in self._graph.endpoints():
            if theirs.node.participant != participant:
                continue
            for ours in self._graph.endpoints(theirs.kind.opposite, name=theirs.name):
                if ours.node.participant != self.participant or not ours.matches(theirs):
                    continue
                publisher = ours if ours.kind is EndpointKind.PUBLISHER else theirs
                if publisher.kind is not EndpointKind.PUBLISHER or can_link(publisher):
                    return True
        return False

    def _meet(self, connection: Connection, endpoint: EndpointInfo | None = None) -> None:
        """Ask for what the publishers at the other end have for our subscriptions."""
        readers = [
            reader
            for reader in self.readers.values()
            if endpoint is None or reader.endpoint.name == endpoint.name
        ]
        for reader in readers:
            for publisher in self.remote(EndpointKind.PUBLISHER, reader.endpoint.name):
                if publisher.node.participant == connection.participant:
                    reader.meet(publisher, connection)

    # Links come and go

    def _dial(self, participant: str) -> None:
        self._barred.add(participant)  # until it answers, or for good if it cannot be reached
        try:
            sock = None if self._meeting is None else self._meeting.dial(participant)
        except TransportError as error:
            logger.warning("%s; Zenoh is used instead", error)
            return
        if sock is not None:
            self._begin(sock)

    def _accept(self) -> None:
        if self._meeting is None or self._loop is None:
            return
        try:
            sock = self._meeting.accept()
        except OSError as error:  # the listener stays readable, so look away for a while
            logger.warning("a link cannot be accepted: %s", error)
            self._loop.remove_reader(self._meeting.listener.fileno())
            self.later(AGAIN_S, self._accept_again)
            return
        if sock is not None:
            self._begin(sock)

    def _accept_again(self) -> None:
        if self._meeting is not None and self._loop is not None:
            self._loop.add_reader(self._meeting.listener.fileno(), self._accept)

    def _begin(self, sock: socket.socket) -> None:
        assert self._loop is not None  # noqa: S101  # set before anything is dialled or accepted
        connection = Connection(self._loop, sock, self.pool, self._on_frame, self._on_closed)
        self._opening.add(connection)
        gid = int(self.participant, 16).to_bytes(GID_SIZE, "big")
        connection.send(Kind.HELLO, VERSION, gid, source_ns=self.domain_id)

    def _on_hello(self, connection: Connection, one: Frame) -> None:
        participant = f"{int.from_bytes(one.gid, 'big'):x}"
        if one.sequence != VERSION or one.source_ns != self.domain_id or connection.participant:
            raise FrameError(f"a greeting of version {one.sequence}, domain {one.source_ns}")
        if participant in self._links or participant == self.participant:
            raise FrameError(f"a second link to {participant}")
        connection.participant = participant
        self._opening.discard(connection)
        self._barred.discard(participant)
        self._links[participant] = connection
        logger.debug("linked to %s", participant)
        self._near.add(participant)
        self._meet(connection)

    def _on_closed(self, connection: Connection) -> None:
        self._opening.discard(connection)
        participant = connection.participant
        if self._links.get(participant) is not connection:
            return
        del self._links[participant]
        for key in [key for key in self.inlets if key[0] is connection]:
            for inlet in self.inlets.pop(key):
                inlet.broken()
        for writer in list(self.writers.values()):
            writer.broken(connection)
        for server in self.servers.values():
            server.broken(connection)
        for call in list(self.calls.values()):
            if connection in call.ways:
                call.ended(connection)
        self._barred.add(participant)
        self.later(AGAIN_S, lambda: self._try_again(participant))

    def _try_again(self, participant: str) -> None:
        self._barred.discard(participant)
        self._consider(participant)

    def forget(self, inlet: Inlet) -> None:
        """Deliver to `inlet` no longer."""
        if inlet.connection is None:
            return
        key = (inlet.connection, inlet.publisher)
        beside = self.inlets.get(key, [])
        if inlet in beside:
            beside.remove(inlet)
            if not beside:
                del self.inlets[key]

    # Frames

    def _on_frame(self, connection: Connection, one: Frame, payload: Data) -> None:
        kind = one.kind
        if kind == Kind.DATA:
            for inlet in self.inlets.get((connection, one.gid), ()):
                inlet.from_link(payload, one)
        elif kind == Kind.HELLO:
            self._on_hello(connection, one)
        elif not connection.participant:
            raise FrameError("something else before the greeting")
        elif kind in (Kind.OPEN, Kind.SWITCHED, Kind.CLOSE, Kind.CREDIT):
            self._on_wish(connection, one)
        elif kind in (Kind.OPENED, Kind.GONE):
            self._on_publisher(connection, one)
        elif kind in (Kind.REQUEST, Kind.CANCEL):
            self._on_request(connection, one, payload)
        else:
            self._on_answer(connection, one, payload)

    def _on_wish(self, connection: Connection, one: Frame) -> None:
        writer = self.writers.get(one.gid)
        if writer is None:  # it has gone, and GONE is on its way
            return
        if one.kind == Kind.OPEN:
            writer.open(connection, one.payload, one.sequence)
        elif one.kind == Kind.SWITCHED:
            writer.switched(connection, one.payload)
        elif one.kind == Kind.CREDIT:
            writer.credit(connection, one.payload, one.sequence, one.source_ns)
        else:
            writer.leave(connection, one.payload)

    def _on_publisher(self, connection: Connection, one: Frame) -> None:
        key = (connection, one.gid)
        if one.kind == Kind.GONE:
            for inlet in self.inlets.pop(key, []):
                inlet.reader.inlets.pop(one.gid, None)
            return
        for inlet in list(self.inlets.get(key, ())):
            if inlet.gid == one.payload:
                inlet.opened(one.sequence)

    def _on_request(self, connection: Connection, one: Frame, payload: Data) -> None:
        if one.kind == Kind.CANCEL:
            for server in self.servers.values():
                server.cancel(one.gid, one.sequence)
            return
        gid, request = server_of(payload)
        asked = self.servers.get(gid)
        if asked is None:
            connection.send(Kind.END, one.sequence, one.gid)
        else:
            asked.take(connection, one, request)

    def _on_answer(self, connection: Connection, one: Frame, payload: Data) -> None:
        call = self.calls.get((one.gid, one.sequence))
        if call is None:  # it was cancelled meanwhile
            return
        if one.kind == Kind.REPLY:
            call.replied(one, payload)
        elif one.kind == Kind.FAIL:
            call.failed(payload)
        else:
            call.ended(connection)
