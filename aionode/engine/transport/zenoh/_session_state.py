"""The state shared by all entities of a context: session, declarations, threads and queues."""

from __future__ import annotations

import asyncio
import logging
from abc import abstractmethod
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final, Protocol, TypeVar

import zenoh
from msgspec import Struct

from aionode._process.concurrency import running_loop
from aionode._process.later import Later
from aionode.clock import MachineTime, perf_ns
from aionode.engine.transport.base import Registration
from aionode.engine.transport.drops import Drop, Drops
from aionode.engine.transport.loop_waker import LoopWaker, MessageArrivals, ThreadsafeQueue
from aionode.engine.transport.network import GRAPH_BYTES, QUEUE_BYTES
from aionode.engine.transport.send_thread import SendThread
from aionode.engine.transport.zenoh._defects.early_connections import waits_for_link
from aionode.engine.transport.zenoh.connections.connections import Connections
from aionode.engine.transport.zenoh.connections.handlers import translated
from aionode.engine.transport.zenoh.connections.sockets import send_progress
from aionode.engine.transport.zenoh.delivery.acknowledgements import Acknowledgements
from aionode.engine.transport.zenoh.delivery.assertions import Assertions
from aionode.engine.transport.zenoh.delivery.cancellations import Cancellations
from aionode.engine.transport.zenoh.delivery.control_messages import ControlMessages
from aionode.engine.transport.zenoh.delivery.peer_senders import PeerSenders
from aionode.engine.transport.zenoh.delivery.request_room import RequestRoom
from aionode.engine.transport.zenoh.delivery.shared_payload import SharedPayloads
from aionode.engine.transport.zenoh.session.announced import AnnouncedLimit
from aionode.engine.transport.zenoh.session.settings import FLUSH_S
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire._liveliness import endpoint_token, gid_of
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from aionode.clock import TimeBase
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["Declaration", "EndpointNames", "SessionState", "size_of"]

T = TypeVar("T")

logger = logging.getLogger("aionode.transport.zenoh")

BURST_BYTES: Final = 256 * 1024
BURST_NS: Final = 10_000_000
"""Number of bytes in this time that reach every live peer: a quarter of the queue."""

CALM_S: Final = 5.0
"""How long threads keep sending instead of the loop after a crowd has gone, in seconds."""

BULK_FLUSH_S: Final = 0.15
"""How long `flush` waits for large messages, which may be dropped, and for single contexts, in
seconds."""


class ReaderListener(Protocol):
    """Called when subscriptions of other contexts have changed."""

    # Positional, as every publisher is called for every one of them.
    def __call__(self, reader: EndpointInfo | None = None, present: bool = True) -> None:
        """Handle a reader that has appeared or vanished; None if all may have changed."""


class LingeringWriter(Protocol):
    """A destroyed publisher with unacknowledged messages."""

    def finish(self) -> None:
        """Undeclare it now, and count the messages that were not delivered."""


class EndpointNames(Struct, frozen=True):
    """The names by which others know one of our endpoints.

    Attributes:
        key: The key of its messages or requests.
        token: Its liveliness token; an empty one hides it from other contexts.
        gid: Its gid in attachments.
    """

    key: str
    token: str
    gid: bytes


class SessionState:
    """The connection of one context, open or not.

    Args:
        participant: Id of the context, and of its session.
        domain_id: The ROS domain.
        time_base: The time of the context; defaults to that of the machine.
        waker: Wakes the event loop; by default one of its own.

    Attributes:
        participant: Id of the context, and of its session.
        domain_id: The ROS domain.
        session: The session while it is open, else None.
        graph: The graph of the context while the session is open, else None.
        waker: Wakes the event loop from Zenoh's threads.
        connections: The sessions to which it is connected.
        bulk: The thread that sends large messages.
        send_threads: All threads that send messages, including `bulk`.
        control_messages: Sends acknowledgements, assertions and cancellations.
        peer_senders: Send requests and replies.
        burst: Limits what the loop sends at once to readers that do not acknowledge.
        acknowledgements: The acknowledgements between contexts of aionode.
        payloads: Large payloads that several subscriptions of this context receive.
        lingering: Destroyed publishers with unacknowledged messages; an ordered set.
        drops: Counts what is dropped of what others send.
        own_gids: The gids of this context's publishers, lingering ones included.
        cancellations: Requests that clients have given up.
        assertions: The liveliness that publishers assert.
        time_base: The time of the context.
        now_ns: Returns the time of the context, in nanoseconds since 1970.
        queue_bytes: How many bytes of messages may wait in one queue.
        request_room: Limits the requests that are held.
        announced: Limits what is kept of others' announcements.
        on_reader: Called when a remote subscription appears or vanishes, by topic, with the
            subscription and whether it exists, or without arguments when all may have changed;
            ordered sets.
    """

    def __init__(
        self,
        participant: str,
        domain_id: int,
        time_base: TimeBase | None = None,
        waker: LoopWaker | None = None,
        queue_bytes: int = QUEUE_BYTES,
        graph_bytes: int = GRAPH_BYTES,
    ) -> None:
        self.queue_bytes = queue_bytes
        self.request_room = RequestRoom(queue_bytes)
        self.drops = Drops(logger)
        self.participant = participant
        self.domain_id = domain_id
        # Read by threads that send, and set only by the loop: each of them reads it once, and
        # expects that Zenoh refuses, as the session may be closed by then.
        self.session: zenoh.Session | None = None
        self.graph: Graph | None = None
        self.waker = LoopWaker() if waker is None else waker
        self.connections = Connections(self.waker, waits_for_link)
        self.announced = AnnouncedLimit(graph_bytes, self.connections.kinds, self.drops)
        self.bulk = SendThread("aionode-bulk", self.waker)
        self.send_threads = {self.bulk}
        self.control_messages = ControlMessages(self.bulk, queue_bytes)
        self._calm = Later()  # ends a crowd
        self.announced.on_crowded.append(self.note_crowd)
        self.peer_senders = PeerSenders(self.waker, self._send_progress)
        self.burst = Burst()
        self.acknowledgements = Acknowledgements(
            *(participant, domain_id, self.waker, self.note_malformed, self._acknowledges),
            self.announced,
            self.control_messages,
        )
        self.payloads = SharedPayloads()
        self.lingering: dict[LingeringWriter, None] = {}
        self.own_gids: set[bytes] = set()
        self.cancellations = Cancellations(
            participant, domain_id, self.waker, self.note_malformed, self.control_messages
        )
        self.assertions = Assertions(self.waker, self.note_malformed, self.control_messages)
        self.time_base = MachineTime() if time_base is None else time_base
        self.now_ns = self.time_base.system_ns
        self.on_reader: dict[str, dict[ReaderListener, None]] = {}
        self._lingered: asyncio.Future[None] | None = None
        self._declarations: dict[Declaration, None] = {}
        self._graph_is_known = False

    # The names of endpoints, and the endpoints that they reach; here as in rmw_zenoh.

    def names_of(self, endpoint: EndpointInfo, backends: str = "") -> EndpointNames:
        """Return the names of one of our endpoints.

        Without a type hash it matches every definition of the type; ROS has no such token.
        """
        key = data_key(self.domain_id, endpoint.name, endpoint.type_name, endpoint.type_hash)
        visible = bool(endpoint.type_hash)
        token = endpoint_token(self.domain_id, endpoint, backends) if visible else ""
        return EndpointNames(key, token, gid_of(token))

    def reaches(self, node: NodeInfo) -> bool:
        """Return whether messages to the endpoints of `node` go through this transport."""
        return node.participant != self.participant and not node.bridged

    def declare_token(self, session: zenoh.Session, token: str) -> Any:
        """Declare a token, and return an object to undeclare it."""
        return session.liveliness().declare_token(token)

    def queue(self, handle: Callable[[T], None], limit: int | None = None) -> ThreadsafeQueue[T]:
        """Return a queue from Zenoh's threads to `handle`, which is called on the event loop."""
        return ThreadsafeQueue(self.waker, handle, limit)

    def arrivals(
        self,
        handle: Callable[[zenoh.Sample], None],
        limit: int,
        on_dropped: Callable[[int], None],
    ) -> MessageArrivals[zenoh.Sample]:
        """Return a queue for messages that is also bounded in bytes."""
        return MessageArrivals(self.waker, handle, limit, self.queue_bytes, size_of, on_dropped)

    def add(self, declaration: Declaration) -> None:
        """Declare `declaration` now, or as soon as the session is open."""
        self._declarations[declaration] = None
        if self.session is not None and (self._graph_is_known or not declaration.needs_graph):
            declaration.declare(self.session)

    def own_tokens(self) -> set[str]:
        """Return the tokens of what is declared in the session."""
        return {known.token for known in self._declarations if known.is_declared and known.token}

    def remove(self, declaration: Declaration) -> None:
        """Forget `declaration`."""
        self._declarations.pop(declaration, None)

    def connect(self, session: zenoh.Session, graph: Graph) -> None:
        """Declare everything in `session` that does not depend on its peers."""
        self.session = session
        self.graph = graph
        self.request_room = RequestRoom(self.queue_bytes)  # what was here before has ended
        self._start_submessages(session)
        for declaration in list(self._declarations):
            if not declaration.needs_graph:
                declaration.declare(session)

    def _start_submessages(self, session: zenoh.Session) -> None:
        """Start communicating with the other aionode contexts."""
        self.control_messages.start(session)
        self.acknowledgements.start(session)
        self.cancellations.start(session)
        self.assertions.start(session)

    def graph_is_known(self) -> None:
        """Declare what needs the graph, which now contains the endpoints of all connected peers."""
        self._graph_is_known = True
        for declaration in list(self._declarations):
            if declaration.needs_graph and self.session is not None:
                declaration.declare(self.session)

    def _send_progress(self, participant: str) -> tuple[bool, int] | None:
        """Return the progress of sends to a participant; called in a thread."""
        session = self.session
        if session is None:
            return None
        try:
            return send_progress(session, participant)
        except zenoh.ZError:  # the session was closed meanwhile
            return None

    async def flush(self) -> None:
        """Wait until all messages were sent and acknowledged, for at most `FLUSH_S`.

        Lingering publishers end the wait early if their readers make no progress.
        """
        for declaration in list(self._declarations):
            declaration.linger()
        with suppress(TimeoutError):
            async with asyncio.timeout(FLUSH_S):
                while self.lingering:
                    self._lingered = running_loop().create_future()
                    await self._lingered
                for send_thread in list(self.send_threads):
                    if send_thread is not self.bulk:
                        await send_thread.flush()
        with suppress(TimeoutError):
            async with asyncio.timeout(BULK_FLUSH_S):
                for send_thread in (self.bulk, *self.peer_senders.send_threads()):
                    await send_thread.flush()

    def has_lingered(self, writer: LingeringWriter) -> None:
        """Remove a publisher that no longer lingers."""
        self.lingering.pop(writer, None)
        if self._lingered is not None and not self._lingered.done():
            self._lingered.set_result(None)

    def disconnect(self) -> zenoh.Session | None:
        """Undeclare everything, newest first; return the session, which the caller closes."""
        session, self.session = self.session, None
        self._graph_is_known = False
        if session is not None:
            for declaration in reversed(self._declarations):
                declaration.undeclare()
            for publisher in list(self.lingering):
                publisher.finish()
        self.peer_senders.clear()
        self.control_messages.stop()
        self.cancellations.stop()
        self.assertions.stop()
        self.acknowledgements.stop()
        self.graph = None
        self.note_crowd()
        return session

    def tell_writers(self, endpoint: EndpointInfo, *, present: bool) -> None:
        """Tell the publishers of its topic about an endpoint of another context."""
        if endpoint.kind is EndpointKind.SUBSCRIPTION:
            for update in list(self.on_reader.get(endpoint.name, ())):
                update(endpoint, present)

    def _acknowledges(self, participant: str) -> None:
        """Tell the publishers of its readers that a context acknowledges."""
        if self.graph is None:
            return
        for node in self.graph.nodes():
            if node.participant == participant:
                for reader in self.graph.endpoints(EndpointKind.SUBSCRIPTION, node=node):
                    self.tell_writers(reader, present=True)

    def note_crowd(self) -> None:
        """Leave sends that may block on Zenoh to threads while others have announced too much.

        Also for a while after that: Zenoh reports the first token that it drops long before the
        last.
        """
        self._calm.cancel()
        if self.announced.is_crowded or self.session is None:
            self._set_crowded(is_crowded=self.announced.is_crowded)
        else:
            self._calm.call(CALM_S, lambda: self._set_crowded(is_crowded=False))

    def _set_crowded(self, *, is_crowded: bool) -> None:
        self.control_messages.is_crowded = self.peer_senders.is_crowded = is_crowded
        for declaration in list(self._declarations):
            declaration.note_crowd()

    def note_malformed(self, key: str, problem: str) -> None:
        """Count a malformed sample, and log it as `Drops` does."""
        self.drops.note(Drop.MALFORMED, key, problem)

    def note_lie(self, subject: str, problem: str) -> None:
        """Count an impersonation attempt, and log it as `Drops` does."""
        self.drops.note(Drop.FALSE_NAME, subject, problem)


def size_of(arriving: zenoh.Sample | zenoh.Query) -> int:
    """Return the payload size of a message or request in bytes."""
    payload = arriving.payload
    return 0 if payload is None else len(payload)


class Burst:
    """Limits what the loop sends to Zenoh at once to what fits into its queue."""

    def __init__(self) -> None:
        self._left = BURST_BYTES
        self._since_ns = 0

    def spend(self, size_bytes: int) -> bool:
        """Return whether this much more may be sent now, and count it if so."""
        self._left -= size_bytes + 128
        if self._left < 0:
            now_ns = perf_ns()
            if now_ns - self._since_ns < BURST_NS:
                return False
            self._since_ns = now_ns
            self._left = BURST_BYTES - size_bytes
        return True


class Declaration(Registration):
    """A registration that is declared in the session while it is open.

    Args:
        state: The state of the session.
        token: Its liveliness token; an empty one hides it from other contexts.
        gid: Its gid in attachments; by default derived from its token.

    Attributes:
        needs_graph: Whether to declare it only once the endpoints of connected peers are known.
        is_declared: Whether it is declared now.
    """

    needs_graph = False

    def __init__(self, state: SessionState, token: str, gid: bytes = b"") -> None:
        self.state = state
        self.token = token
        self.gid = gid or gid_of(token)
        self.is_declared = False
        self._declared_token: Any = None

    def __hash__(self) -> int:
        return id(self)

    def declare(self, session: zenoh.Session) -> None:
        """Declare its data, and then the token, which makes it visible to all other contexts."""
        with translated(self.token):
            self.declare_data(session)
            self.is_declared = True
            if self.token:
                self._declared_token = self.state.declare_token(session, self.token)

    def undeclare(self) -> None:
        """Undeclare it, in reverse order."""
        token, self._declared_token = self._declared_token, None
        declared, self.is_declared = self.is_declared, False
        with translated(self.token):
            if token is not None:
                token.undeclare()
            if declared:
                self.undeclare_data()

    def linger(self) -> None:
        """Start to linger if messages are unacknowledged, as the context is about to close."""

    def note_crowd(self) -> None:
        """Handle whether others have announced so much that Zenoh may block."""

    @abstractmethod
    def declare_data(self, session: zenoh.Session) -> None:
        """Declare its publisher, subscriber, queryable or querier, if it has one."""

    @abstractmethod
    def undeclare_data(self) -> None:
        """Undeclare what `declare_data` has declared."""

    def close(self) -> None:
        """Undeclare it for good. Repeating it has no effect."""
        self.state.remove(self)
        self.undeclare()
