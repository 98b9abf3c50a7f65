"""The contract between endpoints and transports.

Above it, there are only typed messages; below it, bytes, keys and foreign threads. A context uses
one or more transports at once. Each endpoint of a node has a counterpart in each of them, and each
matched reader is reached through exactly one: a transport never delivers to endpoints that another
transport of the same context serves (`local` serves the context itself, the others serve everyone
else).

Everything here is called on the event loop's thread, except that endpoints may be created before a
loop runs; other processes can reach them once `Transport.open` has returned.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING, Any, Final, Literal, Protocol

import msgspec

from aionode._process.sudden_end import mark_sending
from aionode.engine.transport.drops import Drops

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

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
"""Whether a reader wants CDR bytes. With ``"parts"``, a large message of this context may be
delivered as a list of its parts, some of which are views of the message, so that nothing is copied.
"""

NOT_INLINE_NS: Final = 1
"""A `perf_ns` time in the past: the message is from another process; run no callback inline."""


class SampleInfo(msgspec.Struct, frozen=True, gc=False):
    """The origin of a message.

    Attributes:
        gid: The 16 bytes that identify the sending endpoint; for a request, its client.
        sequence: The sender's sequence number, counting from 1.
        source_ns: When it was sent, in nanoseconds since 1970 by the sender's clock; 0 if unknown.
        arrived_ns: When it arrived, in nanoseconds since 1970, if it was held back since; otherwise
            0.
    """

    gid: bytes
    sequence: int
    source_ns: int
    arrived_ns: int = 0


class PartOfTransport:
    """A part of a transport, whoever has written it: its module is one that sends.

    The last messages of a process wait until such a module has finished what a signal interrupted.
    """

    __slots__ = ()

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        mark_sending(cls.__module__)


class Registration(PartOfTransport, ABC):
    """Something announced to a transport, until it is closed."""

    @abstractmethod
    def close(self) -> None:
        """Withdraw it; repeating it has no effect."""


# Topics


class Reader(Protocol):
    """The receiving end of a subscription, as seen by a transport."""

    endpoint: EndpointInfo

    @property
    def raw(self) -> Raw:
        """Whether `deliver` wants messages as CDR bytes.

        ``"parts"`` accepts a list of parts too, and a memoryview of memory that the sender lends:
        it cannot be reused before all views of it are gone.
        """

    def deliver(
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,
        arrived_ns: int = 0,
    ) -> None:
        """Accept one message, which must not be modified from now on. Never raises, never waits.

        Its metadata are passed as plain arguments and not as a `SampleInfo`, which most
        subscriptions do not need.

        Args:
            msg: The message.
            gid: The 16 bytes that identify its publisher.
            sequence: The publisher's sequence number, counting from 1.
            source_ns: When it was published, in nanoseconds since 1970 by the publisher's clock; 0
                if unknown.
            inline_deadline_ns: The `perf_ns` time until which callbacks may run inline, within this
                call. Transports set it once per event of the loop, so that the loop gets its turn.
                0 forbids it for a message from this process, as the caller is itself in a callback
                or in `publish`; `NOT_INLINE_NS` forbids it for a message from another process.
            arrived_ns: When it arrived, in nanoseconds since 1970, if it was held back since;
                otherwise 0.
        """

    def note_alive(self, gid: bytes) -> None:
        """Accept a publisher's assertion that it is alive. Never raises."""

    def reject(self, error: DecodeError) -> None:
        """Count a sample that is not a message of this type. Never raises."""

    def has_room(self) -> bool:
        """Whether a message can be accepted without losing one that must be kept (KEEP_ALL)."""

    @property
    def waiting(self) -> int:
        """The number of messages waiting here for a callback or a reader."""

    async def wait_for_room(self) -> None:
        """Wait until `has_room`, or until the reader is destroyed."""

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` soon after the next message is consumed, or the reader destroyed."""


class ReaderRegistration(Registration):
    """A subscription in a transport with links, until it is closed."""

    @abstractmethod
    def is_linked(self, publisher: bytes) -> bool | None:
        """Return whether a publisher's messages arrive over a link that only its process can end.

        Args:
            publisher: The gid of the publisher.

        Returns:
            False if there was such a link, but it has ended; None if there was none.
        """


class Writer(Registration):
    """The sending end of one publisher in one transport.

    Attributes:
        active: Whether a message written now would be used: a reader is matched, or it is kept for
            late ones. If not, encoding and copying are skipped.
        bounded: Whether `has_room` may be false.
        is_placeholder: Whether it only stands in for a writer that does not exist yet, so that
            publishers skip it.
    """

    active: bool = False
    bounded: bool = False
    is_placeholder: bool = False

    def when_replaced(self, callback: Callable[[], None]) -> None:
        """Call `callback` once this writer is no longer a placeholder, if it is one now."""

    @abstractmethod
    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg` to every reader matched through this transport; never blocks.

        The caller may modify `msg` afterwards.

        Args:
            msg: The message.
            sequence: The publisher's sequence number, counting from 1.
            source_ns: When it was published, in nanoseconds since 1970.

        Raises:
            MessageError: a value does not fit its field; nothing was sent.
        """

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:  # noqa: ARG002  # it is not repeated
        """Encode the stop of a lease now, and return an object that sends it through this writer.

        Args:
            stop: The message, a snapshot that nobody modifies.
            is_last: Whether the publisher has sent nothing since; any thread may ask.

        Raises:
            MessageError: a value does not fit its field.
        """
        return MessageStop(self, stop)

    def has_room(self) -> bool:
        """Whether every reliable KEEP_ALL reader can take one more message."""
        return True

    async def drain(self) -> None:
        """Wait until `has_room`, and what was written has been passed on."""

    def is_drained(self) -> bool:
        """Return whether `drain` would not have to wait; False if that is unknown."""
        return type(self).drain is Writer.drain

    def assert_liveliness(self) -> None:
        """Tell the readers that the publisher is alive, without a message."""

    # For statistics; not called for each message.

    @property
    def dropped(self) -> int:
        """The number of messages dropped on their way because it was slow."""
        return 0

    def route_of(self, reader: EndpointInfo) -> str | None:  # noqa: ARG002  # knows of none
        """Return the route to a matched reader as a word; None if it bypasses this writer."""
        return None


class StopSender(PartOfTransport, ABC):
    """Sends the stop of one lease through one writer, as the last message of that lease.

    Full queues never drop, delay or overtake it: what waits there before it may be dropped, and is
    counted. It takes the same route and priority as the messages before it, so that none of them
    arrives after it, and goes to all readers.
    """

    @abstractmethod
    def send(self, sequence: int, source_ns: int) -> None:
        """Send the stop, on the event loop's thread; called once.

        It is also called after `send_past_loop`, with the same numbers, as soon as the loop runs
        again: for the readers that only the loop reaches, and to resend what was lost. Readers that
        track sequence numbers accept it once.
        """

    def send_past_loop(self, sequence: int, source_ns: int) -> None:  # as in `local`
        """Send the stop to other processes from any thread, while the loop's thread is busy.

        That thread may be anywhere, except in a call of this writer by its publisher.
        """

    def repeat(self) -> None:  # most lose nothing
        """Send the stop once more, with the same number, where it may be lost; any thread.

        The caller does so for a moment after `send_past_loop`. After `send` alone, the writer takes
        care of that itself, and does not end before.
        """


class MessageStop(StopSender):
    """Sends the stop like any other message, which is enough for a writer without queues.

    Args:
        writer: The writer.
        stop: The message.
    """

    def __init__(self, writer: Writer, stop: Any) -> None:
        self._writer = writer
        self._stop = stop

    def send(self, sequence: int, source_ns: int) -> None:
        """Send the stop, if any reader wants it."""
        if self._writer.active:
            self._writer.write(self._stop, sequence, source_ns)


# Services


class ReplyTo(Protocol):
    """The possible outcomes of a request, as seen by the client's end. Late calls do nothing."""

    def reply(self, response: Any, sample_info: SampleInfo) -> None:
        """Handle a response."""

    def fail(self, error: ServiceError) -> None:
        """Handle a server's error."""

    def end(self) -> None:
        """Handle that this transport has no more answers."""


class Call(Protocol):
    """A pending request in one transport."""

    def cancel(self) -> None:
        """Forget it: a server that has not started need not serve it, and a reply is dropped."""


class Requester(Registration):
    """The sending end of one client in one transport."""

    @property
    @abstractmethod
    def servers(self) -> int:
        """The number of servers currently matched through this transport."""

    @property
    def caveat(self) -> str:
        """A known reason why the matched servers cannot answer, and the workaround; or empty."""
        return ""

    @abstractmethod
    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send `request` to every matched server; never blocks.

        At least one of `reply`, `fail` and `end` is called on `reply_to`, perhaps before this
        method returns, unless the call is cancelled first.

        Raises:
            MessageError: a value does not fit its field; nothing was sent.
        """


class Request(PartOfTransport, ABC):
    """A request at the server's end. It is answered once; later answers are dropped.

    Attributes:
        message: The request itself.
        sample_info: The client and its sequence number for the request.
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
        """Send an error instead of a response, to clients that support it."""

    @abstractmethod
    def drop(self) -> None:
        """Give up the request without an answer, because the server goes away."""


class Serve(Protocol):
    """The receiving end of a service, as seen by a transport."""

    def __call__(self, request: Request, inline_deadline_ns: int = 0) -> None:
        """Accept one request; never raises or waits. `inline_deadline_ns` is as in `deliver`."""


# Transports as a whole


class LinkStatus(msgspec.Struct, frozen=True):
    """The links between contexts of the domain, as reported by the contexts.

    Attributes:
        advertisements: The announcement of each context by which others can link to it.
        pairs: The ids of each pair of linked contexts.
    """

    advertisements: AbstractSet[str]
    pairs: AbstractSet[frozenset[str]]


class Transport(PartOfTransport, ABC):
    """One way to transport messages."""

    @abstractmethod
    async def open(self, graph: Graph) -> None:
        """Connect, and report other contexts' nodes and endpoints to `graph` from now on.

        Returns once what already exists is known and reachable, as far as can be determined.
        Endpoints that were created before are announced now.

        Raises:
            TransportError: it cannot connect; the message says what to change.
        """

    @abstractmethod
    async def close(self) -> None:
        """Withdraw everything and disconnect, within a second; it can be opened again."""

    def send_rest(self, ends_ns: int) -> None:  # most leave nothing for later
        """Pass published messages that wait for the event loop to the operating system.

        Called in the loop's thread, within a signal handler that interrupted neither this nor an
        endpoint: the process is about to end, or to be suspended. It may take until `ends_ns`, a
        `perf_ns` time.
        """

    @property
    def drops(self) -> Drops:
        """Counts what was dropped of what others send."""
        return Drops()

    async def all_known(self, quiet_s: float) -> bool:  # noqa: ARG002  # no other process
        """Wait until the graph of all reachable peers is known.

        `open` waits for that as well, but not for long. Returns False if a peer has not answered,
        and nothing has arrived for `quiet_s` seconds. For tools whose answer should be complete.
        """
        return True

    def silent_processes(self) -> list[str]:
        """Describe the processes that have not answered `all_known`, as far as they are known."""
        return []

    async def other_domains(self) -> frozenset[int]:
        """Look for domains other than this one; most transports know of none."""
        return frozenset()

    def abandon(self) -> None:  # most have nothing to let go of
        """Release what a forked child inherited from its parent, without telling anyone.

        Called in the child, which never uses this transport again.
        """

    async def observe(
        self,
        what: str,  # noqa: ARG002  # it reaches no other context
        question: bytes,  # noqa: ARG002
        timeout_s: float,  # noqa: ARG002
        participants: Collection[str] | None = None,  # noqa: ARG002
    ) -> dict[str, bytes | None]:
        """Ask other contexts of the domain about themselves, by participant. For tools.

        An empty answer comes from a context that does not know the question, such as one of an
        older aionode; None stands for a context of aionode that has not answered in time.

        Args:
            what: What is asked for: one of the names that others give to `tell`.
            question: The details of the question.
            timeout_s: The longest wait, in seconds.
            participants: Whom to ask; None for all.
        """
        return {}

    def tell(self, answers: Mapping[str, Callable[[bytes], bytes]]) -> None:
        """Answer other contexts: each function answers the questions of its name."""

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
        """Announce a subscription of `msg_type` that passes messages to `reader`.

        It may return a `ReaderRegistration` if the transport has links.
        """

    @abstractmethod
    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a server of `srv_type` that passes requests to `serve`.

        Closing it ends the calls of requests that it has not answered.
        """

    @abstractmethod
    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client of `srv_type`."""
