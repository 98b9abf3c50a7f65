"""Manages the links of one context: which contexts to link to, and how to handle control frames."""

from __future__ import annotations

import asyncio
import logging
from itertools import chain
from typing import TYPE_CHECKING, Final

from aionode._process.concurrency import running_loop
from aionode._process.later import DelayedCalls
from aionode._process.recent import Recent
from aionode._process.restart import doubled
from aionode.clock import MachineTime
from aionode.engine.transport.base import SampleInfo
from aionode.engine.transport.drops import Drop, Drops
from aionode.engine.transport.link._connection import Connection, flush
from aionode.engine.transport.link._continuation import STOPS, LinkSecrets, seal
from aionode.engine.transport.link._endpoint_table import EndpointTable, communicate_by_link
from aionode.engine.transport.link._protocol import (
    VERSION,
    Cancel,
    Close,
    Credit,
    End,
    Fail,
    Gone,
    Hello,
    Kind,
    Open,
    Opened,
    RetransmitDone,
    Switched,
)
from aionode.engine.transport.link._publisher import LinkWriter
from aionode.engine.transport.link._service import REPLY, LinkRequester, LinkServer, server_of
from aionode.engine.transport.link._shared_memory import BufferPool
from aionode.engine.transport.link._subscription import LinkReader, heard_from
from aionode.errors import FrameError, TransportError
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable, Sequence

    from aionode.engine.transport.link._listener import Advertisement, Listener
    from aionode.engine.transport.link._protocol import Control
    from aionode.engine.transport.link._registry import PeerDirectory
    from aionode.engine.transport.link._send_queue import LinkSendQueue
    from aionode.engine.wire.cdr import Data
    from aionode.graph import EndpointInfo, Graph

__all__ = ["LinkManager"]

logger = logging.getLogger("aionode.transport.link")

AGAIN_S: Final = 1.0
"""Delay between the end of a link, or a failed attempt, and the next attempt, in seconds.

It doubles after each failed attempt, up to `LAST_AGAIN_S`.
"""

LAST_AGAIN_S: Final = 30.0

HELLO_S: Final = 5.0
"""Timeout for the other end of an accepted socket to send its `Hello`, in seconds."""

MAX_OPENING: Final = 64
"""Maximum number of accepted sockets without a `Hello`; beyond it, the oldest is closed.

A context that was dialled may take as long as it likes, since it was announced: it is busy, and
accepts the connection when it is not.
"""

MAX_HELD: Final = 1 << 27
"""Maximum number of bytes of incomplete frames, over all links."""

MAX_ENDING: Final = 1_000
"""Number of destroyed publishers to remember until their subscriptions have confirmed."""

RETRANSMIT_BYTES: Final = 1 << 20
"""Size of a batch of retransmitted messages, which may be exceeded by one frame."""


class LinkManager:
    """The links of one context: the `LinkRegistry` of its endpoints, and the owner of connections.

    Of two contexts with matching endpoints, the one with the smaller id dials; both know which.

    Args:
        participant: Id of the context.
        domain_id: The ROS domain.
        peer_directory: What is known about other contexts.

    Attributes:
        pool: Shared memory for large payloads.
        now_ns: Returns the time of the context, in nanoseconds since 1970.
        writers: The publishers that may use links.
        readers: The subscriptions.
        servers: The servers, by gid.
        requesters: The clients, by gid.
    """

    def __init__(self, participant: str, domain_id: int, peer_directory: PeerDirectory) -> None:
        self.participant = participant
        self.drops = Drops(logger)
        self.pool = BufferPool()
        self.now_ns = MachineTime().system_ns
        # Endpoints: added when they are created, removed when they are closed.
        self.writers: EndpointTable[LinkWriter] = EndpointTable()
        self.readers: EndpointTable[LinkReader] = EndpointTable()
        self.servers: dict[bytes, LinkServer] = {}
        self.requesters: dict[bytes, LinkRequester] = {}
        self._peer_directory = peer_directory
        self._secrets = LinkSecrets()
        self._domain_id = domain_id
        self._graph: Graph | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._listener: Listener | None = None
        # Contexts that can be linked, from their advertisement until it is withdrawn.
        self._near: set[str] = set()
        # By context, from the arrival of its Hello until the connection is closed.
        self._links: dict[str, Connection] = {}
        # Connections whose Hello has not arrived, oldest first, with the context that was dialled,
        # or None if accepted.
        self._opening: dict[Connection, str | None] = {}
        # Contexts not to dial now: from an attempt or the end of a link until a Hello arrives, a
        # delay has passed, or the advertisement is withdrawn.
        self._backoff: set[str] = set()
        # Consecutive failed attempts by context, until a Hello arrives.
        self._failures: dict[str, int] = {}
        # By connection and publisher: what a destroyed publisher left to be sent or confirmed,
        # until everything is confirmed or the connection is closed.
        self._ending: Recent[tuple[Connection, bytes], LinkSendQueue] = Recent(MAX_ENDING)
        self._delayed = DelayedCalls()  # of `later`
        self._link_changes = 0

    # Lifetime

    def open(self, graph: Graph, listener: Listener | None) -> None:
        """Start accepting and dialling; without a listener there are no links."""
        self.pool = BufferPool()
        self._graph = graph
        self._loop = running_loop()
        self._listener = listener
        if listener is not None:
            self._peer_directory.on_retransmit = self.on_retransmit
            self._peer_directory.on_unannounced_peers = self._on_unannounced_peers
            self._loop.add_reader(listener.sock.fileno(), self._accept)

    def close(self) -> None:
        """End all links."""
        listener, self._listener = self._listener, None
        if listener is not None and self._loop is not None:
            self._loop.remove_reader(listener.sock.fileno())
            listener.close()
        self._delayed.cancel()
        for send_queue in self._ending.values():  # `flush` has warned about losses
            send_queue.drop()
        self._ending.clear()
        for connection in [*self._links.values(), *self._opening]:
            connection.close()
        self._near.clear()
        self._backoff.clear()
        self._failures.clear()
        self._secrets.clear()
        self.pool.close()
        self._graph = None

    def abandon(self) -> None:
        """Close the descriptors of all sockets, in a forked child.

        Otherwise the parent's links would outlive the parent. Nothing is sent, and the parent's
        socket keeps its name.
        """
        if self._listener is not None:
            self._listener.sock.close()
        for connection in [*self._links.values(), *self._opening]:
            connection.abandon()

    async def flush(self) -> None:
        """Wait until pending data was passed to the operating system.

        A process that reads nothing for `STALLED_S` is given up, with a warning about what was
        lost.
        """
        async with (
            asyncio.TaskGroup() as tasks
        ):  # so that several frozen processes cause only one delay
            for connection in list(self._links.values()):
                tasks.create_task(flush(connection))

    # The registry: what endpoints need

    @property
    def changes(self) -> int:
        """Incremented whenever endpoints or links change."""
        return self._link_changes + (0 if self._graph is None else self._graph.changes)

    def may_be_heard(self, publisher: EndpointInfo, changed: Callable[[], None]) -> bool:
        """Return whether a publisher may have subscriptions that are not announced."""
        return self._peer_directory.may_be_heard(publisher, changed)

    def linked(self, participant: str) -> Connection | None:
        """Return the link to a context, if there is one."""
        return self._links.get(participant)

    def remote(self, kind: EndpointKind, name: str) -> list[EndpointInfo]:
        """Return the endpoints of other contexts with this name."""
        if self._graph is None:
            return []
        return [
            endpoint
            for endpoint in self._graph.endpoints(kind, name=name)
            if endpoint.node.participant != self.participant and not endpoint.node.bridged
        ]

    def later(self, delay_s: float, call: Callable[[], None]) -> None:
        """Call `call` after a delay, unless the links are closed first."""
        if self._listener is not None:
            self._delayed.add(delay_s, call)

    def post(self, connection: Connection, stop: bytes) -> None:
        """Send a STOP to the other end of a link over Zenoh, from any thread. It may be lost."""
        self._peer_directory.post(connection.participant, seal(connection.secret, STOPS, stop))

    def keep(self, gid: bytes, send_queue: LinkSendQueue) -> None:
        """Keep what a destroyed publisher left to be sent or confirmed."""
        if not send_queue.settled:
            given_up = self._ending.put((send_queue.connection, gid), send_queue)
            if given_up is not None:
                given_up.drop()

    def remove(self, gid: bytes) -> None:
        """Forget a closed endpoint of this context."""
        writer = self.writers.get(gid)
        if writer is not None:
            self.writers.remove(gid)
            self._peer_directory.forget(writer.endpoint, writer.routes.reconsider)
        self.readers.remove(gid)
        self.servers.pop(gid, None)
        self.requesters.pop(gid, None)

    # Contexts that appear and disappear

    @property
    def links(self) -> list[str]:
        """The contexts that are linked now."""
        return list(self._links)

    def on_advertisement(self, advertisement: Advertisement, present: bool) -> None:
        """Handle the advertisement of a context that can be linked, or its withdrawal."""
        participant = advertisement.participant
        if not present:
            self._near.discard(participant)
            self._backoff.discard(participant)
            self._failures.pop(participant, None)
            self._read_until_eof(participant)
            return
        self._near.add(participant)
        self._consider(participant)

    def _read_until_eof(self, participant: str) -> None:
        """Read a link to its end, which was learned from elsewhere."""
        connection = self._links.get(participant)
        if connection is not None:
            connection.read_until_eof()

    def _on_unannounced_peers(self, _: bool) -> None:
        for writer in self.writers.values():
            writer.routes.reconsider()

    def on_endpoint(self, endpoint: EndpointInfo) -> None:
        """Handle a new endpoint, of this context or another."""
        if self._graph is None:
            return
        readers = self.readers.named(endpoint.name)
        if endpoint.node.participant != self.participant:
            if endpoint.kind is EndpointKind.SUBSCRIPTION:
                for writer in self.writers.named(endpoint.name):
                    writer.routes.reconsider()
            self._consider(endpoint.node.participant, endpoint, readers)
            return
        new = [reader for reader in readers if reader.endpoint is endpoint]
        for theirs in self.remote(endpoint.kind.opposite, endpoint.name):
            self._consider(theirs.node.participant, theirs, new)

    def _consider(
        self,
        participant: str,
        endpoint: EndpointInfo | None = None,
        readers: Sequence[LinkReader] = (),
    ) -> None:
        """Use the link to a context, or dial it if there are matching endpoints.

        Args:
            participant: The context.
            endpoint: The endpoint there to consider; None for all.
            readers: The subscriptions here that may receive from it.
        """
        if participant not in self._near:
            return
        connection = self._links.get(participant)
        if connection is not None:
            if endpoint is None:
                self._open_publishers(connection)
            elif endpoint.kind is EndpointKind.PUBLISHER:
                for reader in readers:
                    reader.open(endpoint, connection)
        elif (
            self.participant < participant
            and participant not in self._backoff
            # Its advertisement may come and go while it is being dialled, which ends the backoff.
            and participant not in self._opening.values()
            and self._has_matches(participant, endpoint)
        ):
            self._dial(participant)

    def _has_matches(self, participant: str, endpoint: EndpointInfo | None) -> bool:
        """Return whether a context, or its new endpoint, matches an endpoint of this context."""
        graph = self._graph
        if graph is None:
            return False
        # Only the new endpoint is considered: checking all of them each time would be quadratic.
        if endpoint is not None:
            return any(
                communicate_by_link(ours, endpoint) for ours in graph.own_opposites(endpoint)
            )
        return any(
            theirs.node.participant == participant and communicate_by_link(ours, theirs)
            for ours in graph.own()
            for theirs in graph.opposites(ours)
        )

    def _open_publishers(self, connection: Connection) -> None:
        """Ask for the messages of the publishers at the other end that match our subscriptions."""
        for reader in self.readers.values():
            for publisher in self.remote(EndpointKind.PUBLISHER, reader.endpoint.name):
                if publisher.node.participant == connection.participant:
                    reader.open(publisher, connection)

    # Opening links

    def _dial(self, participant: str) -> None:
        self._backoff.add(participant)
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
        """Dial again after a growing delay: the other context may be busy, or restarting."""
        self._backoff.add(participant)
        failures = self._failures.get(participant, 0)
        self._failures[participant] = failures + 1
        delay_s = doubled(AGAIN_S, failures, LAST_AGAIN_S)
        self.later(delay_s, lambda: self._try_again(participant))

    def _try_again(self, participant: str) -> None:
        self._backoff.discard(participant)
        self._consider(participant)

    def _accept(self) -> None:
        if self._listener is None or self._loop is None:
            return
        try:
            sock = self._listener.accept()
        except OSError as error:  # the listener stays readable, so do not watch it for a while
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
        connection = Connection(self._loop, sock, self.pool, self)
        self._opening[connection] = participant
        if participant is None:
            accepted = [waiting for waiting, dialled in self._opening.items() if dialled is None]
            for waiting in accepted[: max(len(accepted) - MAX_OPENING, 0)]:
                waiting.close()
            self.later(HELLO_S, lambda: self._close_if_silent(connection))
        connection.send(Hello(self.participant, VERSION, self._domain_id, connection.secret))

    def _close_if_silent(self, connection: Connection) -> None:
        if connection in self._opening:
            connection.close()

    def _on_hello(self, connection: Connection, hello: Hello) -> None:
        participant = hello.participant
        if hello.version != VERSION or hello.domain_id != self._domain_id:
            raise FrameError(
                f"expected HELLO of version {VERSION}, domain {self._domain_id}; got version "
                f"{hello.version}, domain {hello.domain_id}"
            )
        # It dials again only after it has closed its first socket, whose end may still be unread.
        self._read_until_eof(participant)
        if participant in self._links or participant == self.participant:
            raise FrameError(f"a second link to {participant}")
        connection.accept_hello(participant)
        self._secrets.add(participant, hello.secret)
        self._opening.pop(connection, None)
        self._backoff.discard(participant)
        self._failures.pop(participant, None)
        self._links[participant] = connection
        self._link_changes += 1
        logger.debug("linked to %s", participant)
        self._near.add(participant)
        self._peer_directory.note_link(participant, True)
        self._open_publishers(connection)

    # The owner of connections

    def on_held(self, connection: Connection) -> None:
        """Limit the bytes held of incomplete frames by ending the link that holds most."""
        if not connection.participant:
            connection.close(FrameError("expected HELLO, got a longer frame"))
        connections = [*self._links.values(), *self._opening]
        if sum(connection.held for connection in connections) > MAX_HELD:
            largest = max(connections, key=lambda connection: connection.held)
            largest.close(FrameError(f"more than {MAX_HELD} bytes of incomplete frames"))

    def on_closed(self, connection: Connection) -> None:
        """Continue its endpoints over Zenoh, and dial again after a delay."""
        dialled = self._opening.pop(connection, None)
        if dialled is not None:
            self._try_later(dialled)
        participant = connection.participant
        if self._links.get(participant) is not connection:
            return
        del self._links[participant]
        self._link_changes += 1
        self._peer_directory.note_link(participant, False)
        for receiver in connection.receivers.clear():
            receiver.broken()
        self._retransmit_unacked(connection)
        for server in self.servers.values():
            server.broken(connection)
        for requester in list(self.requesters.values()):
            for call in list(requester.calls.values()):
                if connection in call.routes:
                    call.ended(connection)
        self._backoff.add(participant)
        self.later(AGAIN_S, lambda: self._try_again(participant))

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
        """Pass a request to its server, or a response to its call."""
        if not connection.participant:
            raise FrameError(f"expected HELLO, got kind {kind}")
        if kind == REPLY:
            requester = self.requesters.get(client)
            call = None if requester is None else requester.calls.get(sequence)
            if call is not None:  # otherwise it was just cancelled
                call.replied(payload, SampleInfo(client, sequence, source_ns))
            return
        gid, request = server_of(payload)
        server = self.servers.get(gid)
        if server is None:
            connection.send(End(client, sequence))
        else:
            sample_info = SampleInfo(client, sequence, source_ns)
            server.take(connection, request, sample_info, inline_deadline_ns)

    def on_control(self, connection: Connection, control: Control) -> None:
        """Handle a control frame."""
        if not connection.participant:
            if not isinstance(control, Hello):
                raise FrameError(f"expected HELLO, got {type(control).__name__.upper()}")
            self._on_hello(connection, control)
        elif isinstance(control, Credit):
            self._on_credit(connection, control)
        elif isinstance(control, Open | Switched | Close):
            self._on_subscription(connection, control)
        elif isinstance(control, Opened | Gone):
            self._on_publisher(connection, control)
        elif isinstance(control, Cancel):
            for server in self.servers.values():
                server.cancel(control.client, control.sequence)
        elif isinstance(control, Fail | End):
            self._on_no_reply(connection, control)
        else:
            raise FrameError(f"unexpected {type(control).__name__.upper()} on a link")

    def _on_publisher(self, connection: Connection, control: Opened | Gone) -> None:
        if isinstance(control, Opened):
            opened = connection.receivers.get(control.publisher, control.subscription)
            if opened is not None:
                opened.opened(control.sequence)
            return
        for receiver in connection.receivers.of(control.publisher):
            receiver.gone()
            connection.receivers.remove(control.publisher, receiver)

    def _on_credit(self, connection: Connection, credit: Credit) -> None:
        writer = self.writers.get(credit.publisher)
        if writer is not None:
            writer.credit(connection, credit)
            return
        ending = self._ending.get((connection, credit.publisher))
        if ending is not None:
            ending.credit(credit)
            if ending.settled:
                del self._ending[connection, credit.publisher]

    def _on_subscription(self, connection: Connection, control: Open | Switched | Close) -> None:
        writer = self.writers.get(control.publisher)
        if writer is None:  # it was just destroyed, and Gone is on its way
            return
        if isinstance(control, Open):
            writer.open(connection, control)
        elif isinstance(control, Switched):
            writer.switched(connection, control.subscription)
        else:
            writer.leave(connection, control.subscription)

    def _on_no_reply(self, connection: Connection, control: Fail | End) -> None:
        requester = self.requesters.get(control.client)
        call = None if requester is None else requester.calls.get(control.sequence)
        if call is None:  # it was just cancelled
            return
        if isinstance(control, Fail):
            call.failed(control.error_type, control.error_text)
        else:
            call.ended(connection)

    # Retransmission

    def _retransmit_unacked(self, connection: Connection) -> None:
        """Send what is not confirmed to the process concerned, and to no other."""
        unacked = [data for writer in self.writers.values() for data in writer.broken(connection)]
        for key in [key for key in self._ending if key[0] is connection]:
            unacked += self._ending.pop(key).unacked()
        unacked.append(RetransmitDone().pack())
        batch: list[bytes] = []
        size, number = 0, 1
        for data in unacked:
            batch.append(data)
            size += len(data)
            if size >= RETRANSMIT_BYTES or data is unacked[-1]:
                sealed = seal(connection.secret, number, b"".join(batch))
                self._peer_directory.retransmit(connection.participant, sealed)
                batch.clear()
                size, number = 0, number + 1

    def on_retransmit(self, data: bytes) -> None:
        """Handle what another context could not deliver over its link."""
        if self._listener is None:  # closed: each end of a link is followed by a batch
            return
        try:
            sender, frames = self._secrets.unseal(data)
        except FrameError as error:
            self.drops.note(Drop.MALFORMED, "links", f"a batch of retransmitted messages ({error})")
            return
        if any(frame.kind != Kind.STOP for frame in frames):  # the link has ended
            self._read_until_eof(sender)
        heard = heard_from(self.readers.values(), sender)
        for frame in frames:
            if frame.kind == Kind.RETRANSMIT_DONE:
                for remote_publisher in chain.from_iterable(heard.values()):
                    remote_publisher.retransmit_done()
            for remote_publisher in heard.get(frame.gid, ()):
                remote_publisher.from_other_route(frame.payload, frame)
