"""Transport within one context: messages are passed as objects, without encoding.

Readers share one snapshot of each message, taken when it is published. The matching rules are those
of DDS; endpoints that do not match do not communicate.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from aionode.engine.rules.lifespan import NEVER_NS
from aionode.engine.transport.base import (
    Registration,
    Request,
    Requester,
    SampleInfo,
    StopSender,
    Transport,
    Writer,
)
from aionode.errors import ServiceError
from aionode.message import snapshotter
from aionode.qos import DurabilityPolicy, depth_of, is_unlimited, keeps_all

if TYPE_CHECKING:
    from aionode.engine.transport.base import Call, Reader, ReplyTo, Serve
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["LocalTransport"]

MemberT = TypeVar("MemberT", "LocalWriter", "LocalReader")

Deliver = Callable[[Any, bytes, int, int], None]
"""Takes a message, its publisher's gid, its number and its time, as `Reader.deliver` does."""


class LocalTransport(Transport):
    """The transport of a context to itself."""

    def __init__(self) -> None:
        # By name, in order of creation.
        self._writers: dict[str, dict[LocalWriter, None]] = {}
        self._readers: dict[str, dict[LocalReader, None]] = {}
        self._servers: dict[str, list[LocalServer]] = {}

    async def open(self, graph: Graph) -> None:
        """Do nothing: there is nothing to connect."""

    async def close(self) -> None:
        """Do nothing: there is nothing to disconnect."""

    def create_node(self, node: NodeInfo) -> Registration:  # noqa: ARG002  # no other process
        """Do nothing: the graph already knows the nodes of this context."""
        return _Nothing()

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Connect a publisher with the subscriptions of its topic."""
        writer = LocalWriter(endpoint, msg_type, self._writers)
        self._writers.setdefault(endpoint.name, {})[writer] = None
        for reader in self._readers.get(endpoint.name, ()):
            writer.meet(reader)
        return writer

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Connect a subscription with the publishers of its topic; give it their history."""
        local_reader = LocalReader(endpoint, msg_type, reader, self._readers, self._writers)
        self._readers.setdefault(endpoint.name, {})[local_reader] = None
        for writer in self._writers.get(endpoint.name, ()):
            writer.meet(local_reader)
        return local_reader

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Connect a server with the clients of its service."""
        server = LocalServer(endpoint, srv_type, serve, self._servers)
        self._servers.setdefault(endpoint.name, []).append(server)
        return server

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Connect a client with the servers of its service."""
        return LocalRequester(endpoint, srv_type, self._servers)


def _in_class(msg: Any, msg_type: type[Any]) -> Any:
    """Return `msg` as an instance of `msg_type`.

    There may be two classes for one definition, such as a generated and a hand-written one.
    """
    if type(msg) is msg_type:
        return msg
    from aionode.engine.wire import cdr  # nodes of one definition need no codec

    return cdr.decode(msg_type, cdr.encode(msg))


class _Nothing(Registration):
    def close(self) -> None:
        pass


# Topics


def _leave(side: dict[str, dict[MemberT, None]], member: MemberT) -> None:
    """Remove an endpoint from those with its name; repeating it has no effect."""
    members = side.get(member.endpoint.name)
    if members is not None:
        members.pop(member, None)
        if not members:
            del side[member.endpoint.name]


class LocalReader(Registration):
    """A subscription as seen by the publishers in the same context.

    Its content filter is applied on delivery, which is still within `publish`.
    """

    def __init__(
        self,
        endpoint: EndpointInfo,
        msg_type: type[Any],
        reader: Reader,
        readers: dict[str, dict[LocalReader, None]],
        writers: dict[str, dict[LocalWriter, None]],
    ) -> None:
        self.endpoint = endpoint
        self.msg_type = msg_type
        self.reader = reader
        self._readers = readers
        self._writers = writers
        self.bounded = keeps_all(endpoint.qos)

    def delivery_from(self, msg_type: type[Any]) -> Deliver:
        """Return a function that delivers messages of `msg_type` in the form the reader wants."""
        deliver = self.reader.deliver
        if self.reader.raw:
            from aionode.engine.wire import cdr  # nodes without raw readers need no codec

            encode: Callable[[Any], Any] = cdr.encoder(msg_type)
            if self.reader.raw == "parts" and cdr.has_views(msg_type):
                encode = cdr.parts_encoder(msg_type)
            return lambda msg, *rest: deliver(encode(msg), *rest)
        if self.msg_type is not msg_type:
            return lambda msg, *rest: deliver(_in_class(msg, self.msg_type), *rest)
        return deliver

    def close(self) -> None:
        """Disconnect from every publisher."""
        _leave(self._readers, self)
        for writer in self._writers.get(self.endpoint.name, ()):
            writer.part(self)


class LocalWriter(Writer):
    """A publisher as seen by the subscriptions in the same context."""

    def __init__(
        self,
        endpoint: EndpointInfo,
        msg_type: type[Any],
        writers: dict[str, dict[LocalWriter, None]],
    ) -> None:
        self.endpoint = endpoint
        self._msg_type = msg_type
        self._writers = writers
        # Generated by the first message: most publishers of a node, like that of its parameters'
        # changes, send none to subscriptions of their own context.
        self._snapshot: Callable[[Any], Any] | None = None
        self._gid = endpoint.gid
        self._matched: dict[LocalReader, Deliver] = {}
        self._deliveries: tuple[Deliver, ...] = ()
        # The history for late readers: messages, sequence numbers and times.
        self._history: deque[tuple[Any, int, int]] | None = None
        qos = endpoint.qos
        if qos.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            self._history = deque(maxlen=depth_of(qos))
        self._lifespan_ns = NEVER_NS if is_unlimited(qos.lifespan) else qos.lifespan.nanoseconds
        self.active = self._history is not None
        self.bounded = False

    def meet(self, reader: LocalReader) -> None:
        """Connect with `reader` if they match, and give it what it missed."""
        if not self.endpoint.matches(reader.endpoint):
            return
        deliver = reader.delivery_from(self._msg_type)
        wanted = reader.endpoint.qos
        if self._history and wanted.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            for msg, sequence, source_ns in list(self._history)[-depth_of(wanted) :]:
                deliver(msg, self._gid, sequence, source_ns)
        self._matched[reader] = deliver
        # Not `_update`, which visits all readers: there may be many.
        self._deliveries += (deliver,)
        self.active = True
        self.bounded = self.bounded or reader.bounded

    def part(self, reader: LocalReader) -> None:
        """Forget `reader`, whether it was matched or not."""
        if self._matched.pop(reader, None) is not None:
            self._update()

    def _update(self) -> None:
        self._deliveries = tuple(self._matched.values())
        self.active = bool(self._deliveries) or self._history is not None
        self.bounded = self.bounded and any(reader.bounded for reader in self._matched)

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Deliver one snapshot of `msg` to all readers."""
        if self._snapshot is None:
            self._snapshot = snapshotter(self._msg_type)
        snapshot = self._snapshot(msg)
        if self._history is not None:
            self._keep(self._history, snapshot, sequence, source_ns)
        for deliver in self._deliveries:
            deliver(snapshot, self._gid, sequence, source_ns)

    def _keep(
        self, history: deque[tuple[Any, int, int]], msg: Any, sequence: int, source_ns: int
    ) -> None:
        """Keep a message for late readers, and those before it that have not expired."""
        while history and source_ns - history[0][2] >= self._lifespan_ns:
            history.popleft()
        history.append((msg, sequence, source_ns))

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:  # noqa: ARG002  # it reaches all
        """Return an object that sends the stop of a lease."""
        return LocalStop(self, stop)

    def write_stop(self, stop: Any, sequence: int, source_ns: int) -> None:
        """Deliver the stop of a lease; a full KEEP_ALL reader gets it as soon as it has room.

        For other readers it is the newest message, which full queues never drop.
        """
        if self._history is not None:
            self._keep(self._history, stop, sequence, source_ns)
        for reader, deliver in list(self._matched.items()):
            if reader.bounded and not reader.reader.has_room():
                reader.reader.when_room(partial(deliver, stop, self._gid, sequence, source_ns))
            else:
                deliver(stop, self._gid, sequence, source_ns)

    def has_room(self) -> bool:
        """Whether every reliable KEEP_ALL reader can take one more message."""
        return all(reader.reader.has_room() for reader in self._matched if reader.bounded)

    def assert_liveliness(self) -> None:
        """Tell every reader that the publisher is alive."""
        for reader in self._matched:
            reader.reader.note_alive(self.endpoint.gid)

    def is_drained(self) -> bool:
        """Return `has_room`."""
        return self.has_room()

    async def drain(self) -> None:
        """Wait until `has_room`."""
        while not self.has_room():
            for reader in list(self._matched):
                if reader.bounded:
                    await reader.reader.wait_for_room()

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return ``local`` for the subscriptions of this context."""
        return "local" if any(matched.endpoint == reader for matched in self._matched) else None

    def close(self) -> None:
        """Disconnect from every subscription."""
        _leave(self._writers, self)
        self._matched.clear()
        self._history = None
        self._update()


class LocalStop(StopSender):
    """Sends the stop of a lease to the subscriptions of this context, which needs the loop."""

    def __init__(self, writer: LocalWriter, stop: Any) -> None:
        self._writer = writer
        self._stop = stop

    def send(self, sequence: int, source_ns: int) -> None:
        """Send the stop."""
        self._writer.write_stop(self._stop, sequence, source_ns)


# Services


class LocalServer(Registration):
    """A server as seen by the clients in the same context."""

    def __init__(
        self,
        endpoint: EndpointInfo,
        srv_type: Any,
        serve: Serve,
        servers: dict[str, list[LocalServer]],
    ) -> None:
        self.endpoint = endpoint
        self.srv_type = srv_type
        self.serve = serve
        self._servers = servers
        self.unanswered: dict[
            LocalRequest, None
        ] = {}  # in order, so that they are given up in order

    def close(self) -> None:
        """Disconnect from every client, and give up unanswered requests."""
        beside = self._servers.get(self.endpoint.name, [])
        if self in beside:
            beside.remove(self)
            if not beside:
                del self._servers[self.endpoint.name]
        for request in list(self.unanswered):
            request.drop()


class LocalRequest(Request):
    """One request to one server."""

    def __init__(
        self, message: Any, sample_info: SampleInfo, server: LocalServer, call: LocalCall
    ) -> None:
        self.message = message
        self.sample_info = sample_info
        self._server = server
        self._call = call
        self._snapshot = snapshotter(server.srv_type.Response)
        server.unanswered[self] = None

    def _finish(self) -> bool:
        """Mark the request as answered; return whether it was not answered before."""
        if self not in self._server.unanswered:
            return False
        del self._server.unanswered[self]
        return True

    def reply(self, response: Any) -> None:
        """Pass a snapshot of the response to the client."""
        snapshot = self._snapshot(response)
        if self._finish():
            snapshot = _in_class(snapshot, self._call.srv_type.Response)
            self._call.reply(
                snapshot, SampleInfo(self._server.endpoint.gid, self.sample_info.sequence, 0)
            )

    def fail(self, error_type: str, error_text: str) -> None:
        """Pass an error to the client."""
        if self._finish():
            self._call.fail(ServiceError(self._server.endpoint.name, error_text, error_type))

    def drop(self) -> None:
        """Tell the client that this server will not answer."""
        if self._finish():
            self._call.end()


class LocalCall:
    """A pending call to one or more servers."""

    def __init__(self, reply_to: ReplyTo, srv_type: Any) -> None:
        self._reply_to: ReplyTo | None = reply_to
        self.srv_type = srv_type
        self.requests: list[LocalRequest] = []
        self.open = 0

    def reply(self, response: Any, sample_info: SampleInfo) -> None:
        """Pass on a server's response."""
        if self._reply_to is not None:
            self._reply_to.reply(response, sample_info)

    def fail(self, error: ServiceError) -> None:
        """Pass on a server's error."""
        if self._reply_to is not None:
            self._reply_to.fail(error)

    def end(self) -> None:
        """Handle that a server will not answer; the last one ends the call."""
        self.open -= 1
        if self.open == 0 and self._reply_to is not None:
            self._reply_to.end()

    def cancel(self) -> None:
        """Forget the call."""
        self._reply_to = None
        for request in self.requests:
            request.cancelled = True


class LocalRequester(Requester):
    """A client as seen by the servers in the same context."""

    def __init__(
        self, endpoint: EndpointInfo, srv_type: Any, servers: dict[str, list[LocalServer]]
    ) -> None:
        self._endpoint = endpoint
        self._srv_type = srv_type
        self._servers = servers
        self._snapshot = snapshotter(srv_type.Request)

    def _matched(self) -> list[LocalServer]:
        servers = self._servers.get(self._endpoint.name)
        if servers is None:
            return []
        return [server for server in servers if self._endpoint.matches(server.endpoint)]

    @property
    def servers(self) -> int:
        """The number of matched servers in this context."""
        return len(self._matched())

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Pass a snapshot of `request` to every server."""
        snapshot = self._snapshot(request)
        call = LocalCall(reply_to, self._srv_type)
        servers = self._matched()
        call.open = len(servers)
        for server in servers:
            message = _in_class(snapshot, server.srv_type.Request)
            local_request = LocalRequest(message, sample_info, server, call)
            call.requests.append(local_request)
            server.serve(local_request)
        return call

    def close(self) -> None:
        """Do nothing: clients leave nothing behind."""
