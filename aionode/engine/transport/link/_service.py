"""Servers and clients whose requests go over links or over Zenoh.

A request goes over links only if they reach every server of its service, because over Zenoh it
reaches all of them. While one of a client's requests is pending over Zenoh, later ones also go over
Zenoh, so that none overtakes another.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode.engine.transport.base import Registration, Request, Requester, SampleInfo
from aionode.engine.transport.drops import Drop
from aionode.engine.transport.link._protocol import GID_SIZE, Cancel, End, Fail, Kind
from aionode.engine.wire import cdr
from aionode.engine.wire.cdr._layout import has_views
from aionode.errors import DecodeError, FrameError, ServiceError
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.engine.transport.base import Call, ReplyTo, Serve
    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._registry import LinkRegistry
    from aionode.engine.wire.cdr import Data
    from aionode.graph import EndpointInfo

__all__ = ["REPLY", "LinkCall", "LinkRequester", "LinkServer", "server_of"]

REQUEST: Final = int(Kind.REQUEST)
REPLY: Final = int(Kind.REPLY)


# Servers


class LinkServer(Registration):
    """A server.

    Args:
        registry: The links of this context.
        endpoint: The server.
        srv_type: Its service.
        serve: Handles its requests.
        zenoh: Its registration with Zenoh.

    Attributes:
        unanswered: The requests received over links, by client gid and number; each stays until it
            is answered, dropped, or its link ends.
    """

    def __init__(
        self,
        registry: LinkRegistry,
        endpoint: EndpointInfo,
        srv_type: Any,
        serve: Serve,
        zenoh: Registration,
    ) -> None:
        self.endpoint = endpoint
        self.srv_type = srv_type
        self.unanswered: dict[tuple[bytes, int], LinkRequest] = {}
        self.now_ns = registry.now_ns
        self._serve = serve
        self._zenoh = zenoh
        self._registry = registry

    def take(
        self,
        connection: Connection,
        payload: Data,
        sample_info: SampleInfo,
        inline_deadline_ns: int,
    ) -> None:
        """Handle a request; a handler may run within this call until `inline_deadline_ns`."""
        gid, sequence = sample_info.gid, sample_info.sequence
        try:
            message = cdr.decode_request(self.srv_type.Request, payload)
        except DecodeError as error:
            self._registry.drops.note(Drop.MALFORMED, self.endpoint.name, f"a request ({error})")
            connection.send(Fail(gid, sequence, "DecodeError", str(error)))
            return
        request = LinkRequest(message, sample_info, connection, self)
        self.unanswered[gid, sequence] = request
        self._serve(request, inline_deadline_ns)

    def cancel(self, gid: bytes, sequence: int) -> None:
        """Mark a request as cancelled by its client."""
        request = self.unanswered.get((gid, sequence))
        if request is not None:
            request.cancelled = True

    def broken(self, connection: Connection) -> None:
        """Forget the requests of `connection`, which is closed."""
        for key, request in list(self.unanswered.items()):
            if request.connection is connection:
                request.cancelled = True
                del self.unanswered[key]

    def close(self) -> None:
        """Withdraw the server, and drop the requests that were not answered."""
        self._registry.remove(self.endpoint.gid)
        self._zenoh.close()
        for request in list(self.unanswered.values()):
            request.drop()


class LinkRequest(Request):
    """A request received over a link."""

    def __init__(
        self, message: Any, sample_info: SampleInfo, connection: Connection, server: LinkServer
    ) -> None:
        self.message = message
        self.sample_info = sample_info
        self.connection = connection
        self._server = server

    def _finish(self) -> bool:
        """Forget the request; return whether it was still unanswered."""
        key = (self.sample_info.gid, self.sample_info.sequence)
        return self._server.unanswered.pop(key, None) is not None

    def reply(self, response: Any) -> None:
        """Send the response, with the client's own number."""
        parts = parts_of(response)
        if self._finish():
            sample_info = self.sample_info
            now_ns = self._server.now_ns()
            self.connection.send_data(REPLY, sample_info.sequence, now_ns, sample_info.gid, parts)

    def fail(self, error_type: str, error_text: str) -> None:
        """Send an error."""
        if self._finish():
            sample_info = self.sample_info
            self.connection.send(
                Fail(sample_info.gid, sample_info.sequence, error_type, error_text)
            )

    def drop(self) -> None:
        """Tell the client that this server will not answer."""
        if self._finish():
            self.connection.send(End(self.sample_info.gid, self.sample_info.sequence))


# Clients


class LinkRequester(Requester):
    """A client.

    Args:
        registry: The links of this context.
        endpoint: The client.
        srv_type: Its service.
        zenoh: Its registration with Zenoh.

    Attributes:
        over_zenoh: The calls pending over Zenoh.
        calls: The calls pending over links, by number.
    """

    def __init__(
        self, registry: LinkRegistry, endpoint: EndpointInfo, srv_type: Any, zenoh: Requester
    ) -> None:
        self.endpoint = endpoint
        self.srv_type = srv_type
        self.over_zenoh: set[ForwardedCall] = set()
        self.calls: dict[int, LinkCall] = {}
        self._registry = registry
        self._zenoh = zenoh
        # The registry's `changes` when the next three were computed, -1 to recompute them: the
        # number of matched servers, the links to those that are linked, and whether that is all of
        # them.
        self._asked_at = -1
        self._servers = 0
        self._connections: list[tuple[bytes, Connection]] = []
        self._reaches_all = False

    def note_malformed(self, problem: str) -> None:
        """Count a malformed response."""
        self._registry.drops.note(Drop.MALFORMED, self.endpoint.name, problem)

    @property
    def servers(self) -> int:
        """The number of matched servers in other contexts."""
        if self._asked_at != self._registry.changes:
            self._ask()
        return self._servers

    def _ask(self) -> None:
        """Find out which servers there are, and whether links reach them all."""
        registry = self._registry
        self._asked_at = registry.changes
        self._servers = self._zenoh.servers
        servers = [
            server
            for server in registry.remote(EndpointKind.SERVER, self.endpoint.name)
            if self.endpoint.matches(server)
        ]
        links = [(server.gid, registry.linked(server.node.participant)) for server in servers]
        self._connections = [(gid, link) for gid, link in links if link is not None]
        self._reaches_all = bool(links) and len(self._connections) == len(links) == self._servers

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send `request` to every server of other contexts."""
        if self._asked_at != self._registry.changes:
            self._ask()
        if not self._reaches_all or self.over_zenoh:
            return ForwardedCall(self, request, sample_info, reply_to, self._zenoh)
        parts = parts_of(request)
        call = LinkCall(self, sample_info.sequence, reply_to)
        for server, route in self._connections:
            call.routes.append(route)
            route.send_data(
                REQUEST,
                sample_info.sequence,
                sample_info.source_ns,
                sample_info.gid,
                [server, *parts],
            )
        return call

    def close(self) -> None:
        """Withdraw the client."""
        self._registry.remove(self.endpoint.gid)
        self._zenoh.close()
        for call in list(self.calls.values()):
            call.end_all()


class ForwardedCall:
    """A call over Zenoh, kept in `LinkRequester.over_zenoh` while it is pending."""

    def __init__(
        self,
        requester: LinkRequester,
        request: Any,
        sample_info: SampleInfo,
        reply_to: ReplyTo,
        zenoh: Requester,
    ) -> None:
        self._under_way = requester.over_zenoh
        self._reply_to = reply_to
        self._under_way.add(self)
        try:
            self._call = zenoh.send(request, sample_info, self)
        except BaseException:
            self._under_way.discard(self)
            raise

    def reply(self, response: Any, sample_info: SampleInfo) -> None:
        """Pass on a response."""
        self._under_way.discard(self)
        self._reply_to.reply(response, sample_info)

    def fail(self, error: ServiceError) -> None:
        """Pass on an error."""
        self._under_way.discard(self)
        self._reply_to.fail(error)

    def end(self) -> None:
        """Pass on that no answer will come."""
        self._under_way.discard(self)
        self._reply_to.end()

    def cancel(self) -> None:
        """Forget the call."""
        self._under_way.discard(self)
        self._call.cancel()


class LinkCall:
    """A call over one or more links.

    Attributes:
        routes: The links over which an answer may still arrive.
    """

    def __init__(self, requester: LinkRequester, sequence: int, reply_to: ReplyTo) -> None:
        self.routes: list[Connection] = []
        self._requester = requester
        self._sequence = sequence
        self._reply_to = reply_to
        requester.calls[sequence] = self

    def _finish(self) -> bool:
        return self._requester.calls.pop(self._sequence, None) is not None

    def replied(self, payload: Data, sample_info: SampleInfo) -> None:
        """Handle a response."""
        service = self._requester.endpoint.name
        try:
            response = cdr.decode(self._requester.srv_type.Response, payload)
        except DecodeError as error:
            self._requester.note_malformed(f"a response ({error})")
            if self._finish():
                self._reply_to.fail(ServiceError(service, f"the response is unreadable: {error}"))
            return
        if self._finish():
            self._reply_to.reply(response, sample_info)

    def failed(self, error_type: str, error_text: str) -> None:
        """Handle a server's error."""
        if self._finish():
            name = self._requester.endpoint.name
            self._reply_to.fail(ServiceError(name, error_text, error_type))

    def ended(self, connection: Connection) -> None:
        """Expect no answer over `connection`; end the call if it was the last one."""
        if connection in self.routes:
            self.routes.remove(connection)
        if not self.routes:
            self.end_all()

    def end_all(self) -> None:
        """End the call: no answer will come."""
        if self._finish():
            self._reply_to.end()

    def cancel(self) -> None:
        """Forget the call, and tell the servers."""
        if self._finish():
            for route in self.routes:
                route.send(Cancel(self._requester.endpoint.gid, self._sequence))


def parts_of(message: Any) -> Sequence[Data]:
    """Encode a request or response, without copying its arrays yet."""
    cls = type(message)
    return cdr.parts_encoder(cls)(message) if has_views(cls) else (cdr.encode(message),)


def server_of(payload: Data) -> tuple[bytes, Data]:
    """Split a request payload into the gid of its server and the request itself.

    Raises:
        FrameError: the payload is too short for a gid.
    """
    if len(payload) < GID_SIZE:
        raise FrameError(f"expected the gid of a server, got a request of {len(payload)} bytes")
    return bytes(payload[:GID_SIZE]), payload[GID_SIZE:]
