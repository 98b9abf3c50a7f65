"""The contract between endpoints and the ways that messages travel.

Above this line there are only typed messages, below it bytes, keys and foreign threads. A context
uses one or more transports at once. Each endpoint of a node has a counterpart in each of them, and
each matched reader is reached through exactly one: a transport never delivers to endpoints that
another transport of the same context serves (`local` serves the context itself, the others serve
everyone else).

Everything here is called on the thread of the event loop, except that endpoints may be made before
a loop runs; they are reached by other processes once `Transport.open` has returned.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, Protocol

import msgspec

from aionode.engine.transport.drops import Drops

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Set as AbstractSet

    from aionode.errors import DecodeError, ServiceError
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = [
    "NOT_INLINE_NS",
    "Call",
    "LinkStatus",
    "Raw",
    "Reader",
    "ReaderRegistration",
    "Registration",
    "ReplyTo",
    "Request",
    "Requester",
    "SampleInfo",
    "Serve",
    "StopSender",
    "Transport",
    "Writer",
]

Raw = bool | Literal["parts"]
"""Whether a reader wants CDR bytes; ``"parts"``: a large message of this context may come as a list
of its parts, of which some are views of the message, so that nothing is copied.
"""

NOT_INLINE_NS: Final = 1
"""A `perf_ns` time in the past: the message is of another process, and no callback runs at once."""


class SampleInfo(msgspec.Struct, frozen=True, gc=False):
    """The origin of a message.

    Attributes:
        gid: The 16 bytes that identify the sending endpoint; for a request, its client.
        sequence: The sender's number of the message, from 1 and rising by 1.
        source_ns: When it was sent, in nanoseconds since 1970 by the sender's clock; 0 if unknown.
        arrived_ns: When it arrived, in nanoseconds since 1970, if it was held back since; else 0.
    """

    gid: bytes
    sequence: int
    source_ns: int
    arrived_ns: int = 0


class Registration(ABC):
    """Something that was announced to a transport, until it is closed."""

    @abstractmethod
    def close(self) -> None:
        """Withdraw it; twice is the same as once."""


# Topics


class Reader(Protocol):
    """The receiving end of a subscription, as a transport sees it."""

    endpoint: EndpointInfo

    @property
    def raw(self) -> Raw:
        """Whether `deliver` wants the message as CDR bytes; ``"parts"`` if in parts as well."""

    def deliver(
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,
        arrived_ns: int = 0,
    ) -> None:
        """Take one message, which must not be changed from now on. Never raises, never waits.

        What is known of it comes as plain arguments, and not as a `SampleInfo`, which most
        subscriptions have no use for.

        Args:
            msg: The message.
            gid: The 16 bytes that identify its publisher.
            sequence: The publisher's number of it, from 1 and rising by 1.
            source_ns: When it was published, in nanoseconds since 1970 by the publisher's clock; 0
                if unknown.
            inline_deadline_ns: Until which `perf_ns` a callback may run at once, within this call.
                A transport sets it once for each event of the loop, so that the loop has its turn.
                0 means that none may, as the message is one of this process: the caller is itself
                in a callback or in `publish`. For one of another process that is `NOT_INLINE_NS`.
            arrived_ns: When it arrived, in nanoseconds since 1970, if it was held back since; else
                0.
        """

    def note_alive(self, gid: bytes) -> None:
        """Take the assertion of a publisher that it is alive. Never raises."""

    def reject(self, error: DecodeError) -> None:
        """Count a sample that is no message of this type. Never raises."""

    def has_room(self) -> bool:
        """Whether a message can be taken without losing one that should be kept (KEEP_ALL)."""

    @property
    def waiting(self) -> int:
        """The number of messages that wait here for a callback or a reader."""

    async def wait_for_room(self) -> None:
        """Wait until `has_room`, or until the reader is destroyed."""

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` soon after the next message was taken, or the reader destroyed."""


class ReaderRegistration(Registration):
    """A subscription in a transport with links, until it is closed."""

    @abstractmethod
    def is_linked(self, publisher: bytes) -> bool | None:
        """Return whether messages of a publisher come by a link that only its process can end.

        Args:
            publisher: The gid of the publisher.

        Returns:
            False if there was such a link, and it has ended; None if there was none.
        """


class Writer(Registration):
    """The sending end of one publisher in one transport.

    Attributes:
        active: Whether a message written now would be used: a reader is matched, or it is kept for
            late ones. Encoding and copying are left out where this is false.
        bounded: Whether `has_room` may be false.
        is_placeholder: Whether it only stands for a writer that does not exist yet, so that
            publishers leave it out.
    """

    active: bool = False
    bounded: bool = False
    is_placeholder: bool = False

    def when_replaced(self, callback: Callable[[], None]) -> None:
        """Call `callback` once this writer is no longer a placeholder, if it is one now."""

    @abstractmethod
    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg` to every reader matched through this transport; never blocks.

        The caller may change `msg` afterwards.

        Args:
            msg: The message.
            sequence: The publisher's number of it, from 1 and rising by 1.
            source_ns: When it was published, in nanoseconds since 1970.

        Raises:
            MessageError: a value does not fit its field; nothing was sent.
        """

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:  # noqa: ARG002  # it is not repeated
        """Return what sends the stop of a lease, encoded now, through this writer.

        Args:
            stop: The message, a snapshot, which nobody changes.
            is_last: Whether the publisher has sent nothing since; any thread may ask.

        Raises:
            MessageError: a value does not fit its field.
        """
        return MessageStop(self, stop)

    def has_room(self) -> bool:
        """Whether every reliable KEEP_ALL reader can take one more message."""
        return True

    async def drain(self) -> None:
        """Wait until `has_room`, and what was written has been handed on."""

    def assert_liveliness(self) -> None:
        """Tell the readers that the publisher is alive, without a message."""

    # For statistics; not asked for each message.

    @property
    def dropped(self) -> int:
        """The number of messages dropped on their way because it was slow."""
        return 0

    def route_of(self, reader: EndpointInfo) -> str | None:  # noqa: ARG002  # knows of none
        """Return in a word how messages reach a matched reader, or None if not through this."""
        return None


class StopSender(ABC):
    """Sends the stop of one lease through one writer, as the last message of that lease.

    No full queue drops, delays or overtakes it: what waits there before it may be dropped, and is
    counted. It takes the route and the priority of the messages before it, so that none of them
    arrives after it, and goes to all readers.
    """

    @abstractmethod
    def send(self, sequence: int, source_ns: int) -> None:
        """Send it, on the thread of the event loop; called once.

        After `send_past_loop` it is called too, with the same numbers, as soon as the loop goes on:
        for the readers that only the loop reaches, and so that what was lost is sent again. Readers
        that number their messages take it once.
        """

    def send_past_loop(self, sequence: int, source_ns: int) -> None:  # noqa: B027  # as in `local`
        """Send it to other processes from any thread, while the loop's thread is busy elsewhere.

        That thread may be anywhere, except in a call of this writer by its publisher.
        """

    def repeat(self) -> None:  # noqa: B027  # most lose nothing
        """Put it once more, with the same number, where it may be dropped; from any thread.

        The caller does so for a moment after `send_past_loop`. After `send` alone, the writer sees
        to that itself, and does not end before.
        """


class MessageStop(StopSender):
    """Sends the stop as any other message: enough for a writer without queues.

    Args:
        writer: The writer.
        stop: The message.
    """

    def __init__(self, writer: Writer, stop: Any) -> None:
        self._writer = writer
        self._stop = stop

    def send(self, sequence: int, source_ns: int) -> None:
        """Send it, if any reader wants it."""
        if self._writer.active:
            self._writer.write(self._stop, sequence, source_ns)


# Services


class ReplyTo(Protocol):
    """The outcomes of one request, as the client's end sees them. Late calls do nothing."""

    def reply(self, response: Any, sample_info: SampleInfo) -> None:
        """Take a response."""

    def fail(self, error: ServiceError) -> None:
        """Take a server's error."""

    def end(self) -> None:
        """Handle the end of the answers of this transport."""


class Call(Protocol):
    """One request under way in one transport."""

    def cancel(self) -> None:
        """Forget it: a server that has not begun need not serve it, and a reply is dropped."""


class Requester(Registration):
    """The sending end of one client in one transport."""

    @property
    @abstractmethod
    def servers(self) -> int:
        """The number of servers that are matched through this transport now."""

    @property
    def caveat(self) -> str:
        """A known reason why the matched servers cannot answer, and the way out; or empty."""
        return ""

    @abstractmethod
    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send `request` to every matched server; never blocks.

        At least one of `reply`, `fail` and `end` is called on `reply_to`, perhaps before this
        method returns, unless the call is cancelled first.

        Raises:
            MessageError: a value does not fit its field; nothing was sent.
        """


class Request(ABC):
    """One request at the server's end. It is answered once; what comes later is dropped.

    Attributes:
        message: The request itself.
        sample_info: The client and its number of the request.
        cancelled: Whether the client is known to have given up.
    """

    message: Any
    sample_info: SampleInfo
    cancelled: bool = False

    @abstractmethod
    def reply(self, response: Any) -> None:
        """Send the response.

        Raises:
            MessageError: a value does not fit its field; nothing was sent.
        """

    @abstractmethod
    def fail(self, error_type: str, error_text: str) -> None:
        """Send an error in place of a response, to clients that can be told."""

    @abstractmethod
    def drop(self) -> None:
        """Give the request up without an answer: the server goes away."""


class Serve(Protocol):
    """The receiving end of a service, as a transport sees it."""

    def __call__(self, request: Request, inline_deadline_ns: int = 0) -> None:
        """Take one request; never raises or waits. `inline_deadline_ns` is as in `deliver`."""


# The whole


class LinkStatus(NamedTuple):
    """The links between contexts of the domain, as the contexts report them.

    Attributes:
        advertisements: The announcement of each context by which others can link to it.
        pairs: The ids of each two contexts that are linked.
    """

    advertisements: AbstractSet[str]
    pairs: AbstractSet[frozenset[str]]


class Transport(ABC):
    """One way for messages to travel."""

    @abstractmethod
    async def open(self, graph: Graph) -> None:
        """Connect, and report the nodes and endpoints of others to `graph` from now on.

        Returns when what exists already is known and reachable, as far as can be told. What was
        created before is announced now.

        Raises:
            TransportError: there is no way to connect; the text says what to change.
        """

    @abstractmethod
    async def close(self) -> None:
        """Withdraw everything and disconnect, within a second; it can be opened again."""

    def send_rest(self, ends_ns: int) -> None:  # noqa: B027  # most leave nothing for later
        """Hand to the operating system what was published and waits for the event loop.

        Called in the loop's thread, within a signal handler that has interrupted neither this nor
        an endpoint: the process is about to end, or to be suspended. It may take until `ends_ns`,
        by `perf_ns`.
        """

    @property
    def drops(self) -> Drops:
        """What was dropped of what others send."""
        return Drops()

    async def all_known(self, quiet_s: float) -> bool:  # noqa: ARG002  # no other process
        """Wait until the graph of all reachable peers is known.

        `open` waits for that as well, but not for long. False when a peer has not answered, and
        nothing has come for `quiet_s` seconds. For tools, whose answer is to be complete.
        """
        return True

    def silent_processes(self) -> list[str]:
        """Return in words which processes have not answered `all_known`, as far as can be told."""
        return []

    async def other_domains(self) -> frozenset[int]:
        """Look for domains other than this one; most transports know of none."""
        return frozenset()

    def abandon(self) -> None:  # noqa: B027  # most have nothing to let go of
        """Release what a forked child inherited from its parent, without telling anyone.

        Called in the child, which never uses this transport again.
        """

    async def observe(self, timeout_s: float) -> dict[str, bytes | None]:  # noqa: ARG002
        """Ask the other contexts of the domain for their reports, by participant. For tools.

        An empty answer is that of a context that keeps no reports, such as one of an older aionode;
        None stands for one of aionode that has not answered within `timeout_s` seconds.
        """
        return {}

    def tell(self, report: Callable[[], bytes]) -> None:  # noqa: B027  # most have no one to tell
        """Answer other contexts that ask for the report of this one, as `report` returns it."""

    async def link_status(self) -> LinkStatus:
        """Ask all contexts which links they offer and have. For tools."""
        return LinkStatus(set(), set())

    @abstractmethod
    def create_node(self, node: NodeInfo) -> Registration:
        """Announce a node."""

    @abstractmethod
    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher of `msg_type`."""

    @abstractmethod
    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Announce a subscription of `msg_type`, whose messages go to `reader`.

        What it returns may be a `ReaderRegistration`, if the transport has links.
        """

    @abstractmethod
    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a server of `srv_type`, whose requests go to `serve`.

        Closing it ends the calls of requests that it has not answered.
        """

    @abstractmethod
    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client of `srv_type`."""
