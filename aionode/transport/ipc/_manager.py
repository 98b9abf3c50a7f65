"""The links of one context: who is near, who is linked, and what becomes of each frame."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final, Protocol

from aionode.clock import MachineTime
from aionode.errors import FrameError, TransportError
from aionode.graph import EndpointKind
from aionode.transport.ipc import _protocol as protocol
from aionode.transport.ipc._connection import Connection
from aionode.transport.ipc._protocol import GID_SIZE, VERSION, Frame, FrameParser, Kind, can_link
from aionode.transport.ipc._service import REPLY, REQUEST, server_of
from aionode.transport.ipc._shared_memory import BufferPool

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable

    from aionode.graph import EndpointInfo, Graph
    from aionode.transport.ipc._listener import Advertisement, Listener
    from aionode.transport.ipc._publisher import IpcWriter
    from aionode.transport.ipc._send_queue import IpcSendQueue
    from aionode.transport.ipc._service import IpcCall, IpcServer
    from aionode.transport.ipc._subscription import IpcReader, RemotePublisher
    from aionode.wire.cdr import Data

__all__ = ["LinkManager", "PeerDirectory"]

logger = logging.getLogger("aionode.transport.ipc")

AGAIN_S: Final = 1.0
"""How long after a link has ended, or no descriptor was left, it is tried again.

Twice as long after each try that has failed, up to `LAST_AGAIN_S`.
"""

LAST_AGAIN_S: Final = 30.0

HELLO_S: Final = 5.0
"""How long the other end of a socket may take to say who it is."""

MAX_OPENING: Final = 64
"""How many may be silent at once; with one more the oldest is refused."""

MAX_HELD: Final = 1 << 27
"""How much of frames that have not come to their end is held for all links together, in bytes."""

MAX_ENDING: Final = 1_000
"""How many publishers that have gone are remembered until their readers have confirmed."""

STALLED_S: Final = 1.0
"""How long, at the end, a process may take nothing of what waits for it."""

SUBSCRIBER_CONTROL: Final = frozenset(map(int, (Kind.OPEN, Kind.SWITCHED, Kind.CLOSE, Kind.CREDIT)))

RETRANSMIT_BYTES: Final = 1 << 20
"""How much is posted at once, or one frame more."""


class PeerDirectory(Protocol):
    """What the other transport knows of who is there, apart from the graph.

    Attributes:
        advertisement: What it announces of this context; None for nothing.
        on_advertisement: Called with what another context announces, and whether it is there.
        has_unannounced_peers: Whether somebody may listen whose subscriptions nobody announces.
        on_unannounced_peers: Called when that has changed.
        on_retransmit: Called with what another context has posted to this one.
    """

    advertisement: str | None
    on_advertisement: Callable[[str, bool], None]
    has_unannounced_peers: bool
    on_unannounced_peers: Callable[[bool], None]
    on_retransmit: Callable[[bytes], None]

    def retransmit(self, participant: str, data: bytes) -> None:
        """Send bytes to one other context, in order."""

    def announce_link(self, participant: str, on: bool) -> None:
        """Tell whoever asks that there is a link to another context, or no longer."""


class LinkManager:
    """The links of one context.

    Of two contexts the one with the smaller id dials, as soon as they have matching endpoints;
    both see the same graph, so that both know.

    Args:
        participant: Id of the context.
        domain_id: The ROS domain.
        peer_directory: Who else is there.

    Attributes:
        gid: The id of the context as bytes.
        pool: Memory for large payloads.
        writers: Publishers that may use links, by gid.
        readers: Subscriptions, by gid.
        servers: Servers, by gid.
        calls: Requests under way over links, by the client's gid and number.
        now_ns: The system time, in nanoseconds since 1970.
    """

    def __init__(self, participant: str, domain_id: int, peer_directory: PeerDirectory) -> None:
        self.participant = participant
        self.pool = BufferPool()
        self.writers: dict[bytes, IpcWriter] = {}
        self.readers: dict[bytes, IpcReader] = {}
        self.servers: dict[bytes, IpcServer] = {}
        self.calls: dict[tuple[bytes, int], IpcCall] = {}
        self.now_ns = MachineTime().system_ns
        self._peer_directory = peer_directory
        self.gid = int(participant, 16).to_bytes(GID_SIZE, "big")
        self._hello = protocol.pack(Kind.HELLO, VERSION, domain_id, self.gid)
        self._domain_id = domain_id
        self._graph: Graph | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._listener: Listener | None = None
        self._near: set[str] = set()
        self._links: dict[str, Connection] = {}
        self._remote_publishers: dict[tuple[Connection, bytes], list[RemotePublisher]] = {}
        # Those that have not said who they are, the oldest first, and whom they should be.
        self._opening: dict[Connection, str | None] = {}
        # Whom not to dial now, and how often that has failed.
        self._backoff: set[str] = set()
        self._failures: dict[str, int] = {}
        # What publishers that have gone left to be sent or confirmed.
        self._ending: dict[tuple[Connection, bytes], IpcSendQueue] = {}
        self._timers: set[asyncio.TimerHandle] = set()
        self._link_changes = 0
        self._junk = 0  # what came by post and is not understood

    # The whole

    def open(self, graph: Graph, listener: Listener | None) -> None:
        """Begin to accept links, and to dial; without a place to meet there are none."""
        self.pool = BufferPool()
        self._graph = graph
        self._loop = asyncio.get_running_loop()
        self._listener = listener
        if listener is not None:
            self._peer_directory.on_retransmit = self._on_retransmit
            self._peer_directory.on_unannounced_peers = self._on_unannounced_peers
            self._loop.add_reader(listener.sock.fileno(), self._accept)

    def close(self) -> None:
        """End all links."""
        listener, self._listener = self._listener, None
        if listener is not None and self._loop is not None:
            self._loop.remove_reader(listener.sock.fileno())
            listener.close()
        for timer in self._timers:
            timer.cancel()
        self._timers.clear()
        for route in self._ending.values():  # given up, as `flush` has said
            route.drop()
        self._ending.clear()
        for connection in [*self._links.values(), *self._opening]:
            connection.close()
        self._near.clear()
        self._backoff.clear()
        self._failures.clear()
        self.pool.close()
        self._graph = None

    def abandon(self) -> None:
        """Let go of the sockets, in a forked child.

        The parent's links would not end with the parent while the child has them. Nothing is said
        on them, and the name of the parent's socket stays.
        """
        if self._listener is not None:
            self._listener.sock.close()
        for connection in [*self._links.values(), *self._opening]:
            connection.abandon()

    async def flush(self) -> None:
        """Wait until what was written was handed to the system.

        A process that takes nothing for `STALLED_S` is given up, and a warning says what was.
        """
        async with asyncio.TaskGroup() as tasks:  # so that the frozen do not add up
            for connection in list(self._links.values()):
                tasks.create_task(flush(connection))

    def keep(self, gid: bytes, route: IpcSendQueue) -> None:
        """Remember what a publisher that has gone left to be sent, or to be confirmed."""
        if not route.settled:
            self._ending[route.connection, gid] = route
        while len(self._ending) > MAX_ENDING:
            self._ending.pop(next(iter(self._ending))).drop()

    def later(self, delay_s: float, call: Callable[[], None]) -> None:
        """Call `call` in a while, unless closed before."""
        if self._loop is None or self._listener is None:
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
    def has_unannounced_peers(self) -> bool:
        """Whether somebody may listen whose subscriptions nobody announces."""
        return self._peer_directory.has_unannounced_peers

    @property
    def changes(self) -> int:
        """Is another number when endpoints or links have come or gone meanwhile."""
        return self._link_changes + (0 if self._graph is None else self._graph.changes)

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

    def on_advertisement(self, advertisement: Advertisement, present: bool) -> None:
        """Note that a context that can be linked has come or gone."""
        if not present:
            self._near.discard(advertisement.participant)
            self._backoff.discard(advertisement.participant)
            self._failures.pop(advertisement.participant, None)
            self._read_until_eof(advertisement.participant)
            return
        self._near.add(advertisement.participant)
        self._consider(advertisement.participant)

    def _read_until_eof(self, participant: str) -> None:
        """See the end of a link of which something else has told."""
        connection = self._links.get(participant)
        if connection is not None:
            connection.read_until_eof()

    def _on_unannounced_peers(self, _: bool) -> None:
        for writer in self.writers.values():
            writer.update()

    def on_endpoint(self, endpoint: EndpointInfo) -> None:
        """Note a new endpoint, of this context or another."""
        if self._graph is None:
            return
        participant = endpoint.node.participant
        if participant != self.participant:
            if endpoint.kind is EndpointKind.SUBSCRIPTION:
                for writer in list(self.writers.values()):
                    if writer.endpoint.name == endpoint.name:
                        writer.update()
            self._consider(participant, endpoint)
            return
        theirs = self.remote(endpoint.kind.opposite, endpoint.name)
        for one in {each.node.participant: each for each in theirs}.values():
            self._consider(one.node.participant, one)

    def _consider(self, participant: str, endpoint: EndpointInfo | None = None) -> None:
        """Dial a context that has something for us, or meet what is new there."""
        if participant not in self._near:
            return
        connection = self._links.get(participant)
        if connection is not None:
            self._meet(connection, endpoint)
        elif (
            self.participant < participant
            and participant not in self._backoff
            and self._has_matches(participant, endpoint)
        ):
            self._dial(participant)

    def _has_matches(self, participant: str, endpoint: EndpointInfo | None) -> bool:
        """Whether a context, or what is new there, has something for us."""
        if self._graph is None:
            return False
        # Of each new one only itself is looked at: all of them each time is a square.
        for theirs in self._graph.endpoints() if endpoint is None else (endpoint,):
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
        self._backoff.add(participant)  # until it answers, or it is time to try again
        try:
            sock = None if self._listener is None else self._listener.dial(participant)
        except TransportError as error:
            logger.warning("%s; Zenoh is used instead for now", error)
            sock = None
        if sock is None:
            self._try_later(participant)
        else:
            self._begin(sock, participant)

    def _try_later(self, participant: str) -> None:
        """Dial again in a while, which grows: the other may be busy, or restarting."""
        self._backoff.add(participant)
        failures = self._failures.get(participant, 0)
        self._failures[participant] = failures + 1
        self.later(
            min(AGAIN_S * 2 ** min(failures, 10), LAST_AGAIN_S),
            lambda: self._try_again(participant),
        )

    def _accept(self) -> None:
        if self._listener is None or self._loop is None:
            return
        try:
            sock = self._listener.accept()
        except OSError as error:  # the listener stays readable, so look away for a while
            logger.warning("a link cannot be accepted: %s", error)
            self._loop.remove_reader(self._listener.sock.fileno())
            self.later(AGAIN_S, self._accept_again)
            return
        if sock is not None:
            self._begin(sock)

    def _accept_again(self) -> None:
        if self._listener is not None and self._loop is not None:
            self._loop.add_reader(self._listener.sock.fileno(), self._accept)

    def _begin(self, sock: socket.socket, participant: str | None = None) -> None:
        assert self._loop is not None  # noqa: S101  # set before anything is dialled or accepted
        connection = Connection(
            self._loop, sock, self.pool, self._on_frame, self._on_closed, self._on_held
        )
        self._opening[connection] = participant
        while len(self._opening) > MAX_OPENING:
            next(iter(self._opening)).close()
        self.later(HELLO_S, lambda: self._refuse_if_silent(connection))
        connection.write(self._hello)

    def _refuse_if_silent(self, connection: Connection) -> None:
        if connection in self._opening:
            connection.close()

    def _on_held(self, connection: Connection) -> None:
        """Hold no more than so much: end the link that has most."""
        if not connection.participant:
            connection.close(FrameError("something else in place of the greeting"))
        connections = [*self._links.values(), *self._opening]
        if sum(connection.held for connection in connections) > MAX_HELD:
            largest = max(connections, key=lambda connection: connection.held)
            largest.close(FrameError(f"more than {MAX_HELD} bytes in frames without an end"))

    def _on_hello(self, connection: Connection, one: Frame) -> None:
        if one.kind != Kind.HELLO:
            raise FrameError("something else before the greeting")
        participant = participant_of(one)
        if one.sequence != VERSION or one.source_ns != self._domain_id:
            raise FrameError(f"a greeting of version {one.sequence}, domain {one.source_ns}")
        if participant in self._links or participant == self.participant:
            raise FrameError(f"a second link to {participant}")
        connection.know(participant)
        self._opening.pop(connection, None)
        self._backoff.discard(participant)
        self._failures.pop(participant, None)
        self._links[participant] = connection
        self._link_changes += 1
        logger.debug("linked to %s", participant)
        self._near.add(participant)
        self._peer_directory.announce_link(participant, True)
        self._meet(connection)

    def _on_closed(self, connection: Connection) -> None:
        dialled = self._opening.pop(connection, None)
        if dialled is not None:
            self._try_later(dialled)
        participant = connection.participant
        if self._links.get(participant) is not connection:
            return
        del self._links[participant]
        self._link_changes += 1
        self._peer_directory.announce_link(participant, False)
        for key in [key for key in self._remote_publishers if key[0] is connection]:
            for remote_publisher in self._remote_publishers.pop(key):
                remote_publisher.broken()
        self._retransmit_unacked(connection)
        for server in self.servers.values():
            server.broken(connection)
        for call in list(self.calls.values()):
            if connection in call.routes:
                call.ended(connection)
        self._backoff.add(participant)
        self.later(AGAIN_S, lambda: self._try_again(participant))

    def _retransmit_unacked(self, connection: Connection) -> None:
        """Send what may not have arrived to the process that it was for, and to nobody else."""
        unacked = [
            data for writer in list(self.writers.values()) for data in writer.broken(connection)
        ]
        for key in [key for key in self._ending if key[0] is connection]:
            unacked += self._ending.pop(key).unacked()
        unacked.append(protocol.pack(Kind.RETRANSMIT_DONE, 0, 0, self.gid))
        batch = [self._hello]
        size = 0
        for data in unacked:
            batch.append(data)
            size += len(data)
            if size >= RETRANSMIT_BYTES or data is unacked[-1]:
                self._peer_directory.retransmit(connection.participant, b"".join(batch))
                batch = [self._hello]
                size = 0

    def _on_retransmit(self, data: bytes) -> None:
        """Take what another context could not say over its link."""
        try:
            frames = FrameParser().feed(data)
        except FrameError as error:
            self._junk += 1
            if self._junk == 1:
                logger.warning(
                    "something came by post that is not understood: %s; it was left out, and more "
                    "of it is only counted",
                    error,
                )
            return
        sender = participant_of(frames[0]) if frames else ""
        self._read_until_eof(sender)
        for one in frames[1:]:
            for reader in list(self.readers.values()):
                for remote_publisher in list(reader.remote_publishers.values()):
                    if remote_publisher.participant != sender:
                        continue
                    if one.kind == Kind.RETRANSMIT_DONE:
                        remote_publisher.retransmit_done()
                    elif one.kind == Kind.DATA and remote_publisher.publisher == one.gid:
                        remote_publisher.from_retransmit(one.payload, one)

    def _try_again(self, participant: str) -> None:
        self._backoff.discard(participant)
        self._consider(participant)

    def listen(self, remote_publisher: RemotePublisher, connection: Connection) -> None:
        """Deliver what comes from the inlet's publisher to it."""
        remote_publishers = self._remote_publishers.setdefault(
            (connection, remote_publisher.publisher), []
        )
        remote_publishers.append(remote_publisher)
        connection.handlers[remote_publisher.publisher] = handler_for(remote_publishers)

    def forget(self, remote_publisher: RemotePublisher) -> None:
        """Deliver to `remote_publisher` no longer."""
        connection = remote_publisher.connection
        if connection is None:
            return
        remote_publishers = self._remote_publishers.get(
            (connection, remote_publisher.publisher), []
        )
        if remote_publisher in remote_publishers:
            remote_publishers.remove(remote_publisher)
        if remote_publishers:
            connection.handlers[remote_publisher.publisher] = handler_for(remote_publishers)
        else:
            self._remote_publishers.pop((connection, remote_publisher.publisher), None)
            connection.handlers.pop(remote_publisher.publisher, None)

    # Frames

    def _on_frame(
        self, connection: Connection, one: Frame, payload: Data, inline_deadline_ns: int
    ) -> None:
        kind = one.kind
        if not connection.participant:
            self._on_hello(connection, one)
        elif kind == REPLY:
            call = self.calls.get((one.gid, one.sequence))
            if call is not None:  # else it was cancelled meanwhile
                call.replied(one, payload)
        elif kind == REQUEST:
            gid, request = server_of(payload)
            asked = self.servers.get(gid)
            if asked is None:
                connection.send(Kind.END, one.sequence, one.gid)
            else:
                asked.take(connection, one, request, inline_deadline_ns)
        elif kind in SUBSCRIBER_CONTROL:
            self._on_subscriber_control(connection, one)
        elif kind in (Kind.OPENED, Kind.GONE):
            self._on_publisher(connection, one)
        else:
            self._on_call_end(connection, one, payload)

    def _on_subscriber_control(self, connection: Connection, one: Frame) -> None:
        writer = self.writers.get(one.gid)
        if writer is None:  # it has gone, and GONE is on its way
            ending = self._ending.get((connection, one.gid))
            if ending is not None and one.kind == Kind.CREDIT:
                ending.credit(one.payload, one.sequence, one.source_ns)
                if ending.settled:
                    del self._ending[connection, one.gid]
            return
        if one.kind == Kind.OPEN:
            writer.open(connection, one.payload, one.sequence, confirms=bool(one.source_ns))
        elif one.kind == Kind.SWITCHED:
            writer.switched(connection, one.payload)
        elif one.kind == Kind.CREDIT:
            writer.credit(connection, one.payload, one.sequence, one.source_ns)
        else:
            writer.leave(connection, one.payload)

    def _on_publisher(self, connection: Connection, one: Frame) -> None:
        remote_publishers = self._remote_publishers.get((connection, one.gid), [])
        for remote_publisher in list(remote_publishers):
            if one.kind == Kind.GONE:
                remote_publisher.gone()
            elif remote_publisher.gid == one.payload:
                remote_publisher.opened(one.sequence)

    def _on_call_end(self, connection: Connection, one: Frame, payload: Data) -> None:
        if one.kind == Kind.CANCEL:
            for server in self.servers.values():
                server.cancel(one.gid, one.sequence)
            return
        if one.kind not in (Kind.FAIL, Kind.END):
            raise FrameError(f"a frame of kind {one.kind} at this place")
        call = self.calls.get((one.gid, one.sequence))
        if call is None:  # it was cancelled meanwhile
            return
        if one.kind == Kind.FAIL:
            call.failed(payload)
        else:
            call.ended(connection)


async def flush(connection: Connection) -> None:
    """Wait until everything was handed to the system, or the other end takes nothing any more."""
    try:
        while not (connection.idle or connection.closed):
            async with asyncio.timeout(STALLED_S):
                await connection.progress()
    except TimeoutError:
        for queue in connection.queues:
            if queue.waiting:
                logger.warning(
                    "%s: the last %d messages to the process %s were given up: it has read nothing "
                    "for %g s",
                    queue.name,
                    queue.waiting,
                    connection.participant,
                    STALLED_S,
                )


def participant_of(one: Frame) -> str:
    """Return who says a greeting."""
    return f"{int.from_bytes(one.gid, 'big'):x}"


def handler_for(remote_publishers: list[RemotePublisher]) -> Callable[[Data, Frame, int], None]:
    """Return what gives a publisher's messages to its subscriptions here; mostly there is one."""
    if len(remote_publishers) == 1:
        return remote_publishers[0].from_link

    def take(payload: Data, one: Frame, inline_deadline_ns: int) -> None:
        for remote_publisher in tuple(remote_publishers):
            remote_publisher.from_link(payload, one, inline_deadline_ns)

    return take
