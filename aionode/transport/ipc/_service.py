"""Servers and clients, each with two ways to the other end.

A request takes the links only if they reach every server of its service, because over Zenoh it goes
to all of them. While a request of a client is under way over Zenoh, the next ones take the same
way, so that none overtakes another.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.errors import DecodeError, FrameError, ServiceError
from aionode.graph import EndpointKind
from aionode.transport.base import Registration, Request, Requester, SampleInfo
from aionode.transport.ipc._protocol import GID_SIZE, Kind
from aionode.wire import cdr

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo
    from aionode.transport.base import Call, ReplyTo, Serve
    from aionode.transport.ipc._connection import Connection
    from aionode.transport.ipc._manager import LinkManager
    from aionode.transport.ipc._protocol import Frame
    from aionode.wire.cdr import Data

__all__ = ["REPLY", "REQUEST", "IpcCall", "IpcRequester", "IpcServer", "server_of"]

REQUEST: Final = int(Kind.REQUEST)
REPLY: Final = int(Kind.REPLY)

ERROR: Final = msgspec.json.Decoder(tuple[str, str])


# Servers


class IpcServer(Registration):
    """A server.

    Args:
        manager: The links of this context.
        endpoint: The server.
        srv_type: Its service.
        serve: Takes its requests.
        zenoh: Its other way.
    """

    def __init__(
        self,
        manager: LinkManager,
        endpoint: EndpointInfo,
        srv_type: Any,
        serve: Serve,
        zenoh: Registration,
    ) -> None:
        self.endpoint = endpoint
        self.srv_type = srv_type
        self.unanswered: dict[tuple[bytes, int], IpcRequest] = {}
        self.now_ns = manager.now_ns
        self._serve = serve
        self._zenoh = zenoh
        self._manager = manager
        manager.servers[endpoint.gid] = self

    def take(
        self, connection: Connection, one: Frame, payload: Data, inline_deadline_ns: int
    ) -> None:
        """Take a request; a handler may run at once until `inline_deadline_ns`."""
        sample_info = SampleInfo(one.gid, one.sequence, one.source_ns, True)
        try:
            message = cdr.decode(self.srv_type.Request, payload)
        except DecodeError as error:
            fail(connection, one.sequence, one.gid, "DecodeError", str(error))
            return
        request = IpcRequest(message, sample_info, connection, self)
        self.unanswered[sample_info.gid, sample_info.sequence] = request
        self._serve(request, inline_deadline_ns)

    def cancel(self, gid: bytes, sequence: int) -> None:
        """Note that a client has given a request up."""
        request = self.unanswered.get((gid, sequence))
        if request is not None:
            request.cancelled = True

    def broken(self, connection: Connection) -> None:
        """Forget the requests of `connection`: nobody waits for their answers."""
        for key, request in list(self.unanswered.items()):
            if request.connection is connection:
                request.cancelled = True
                del self.unanswered[key]

    def close(self) -> None:
        """Withdraw the server; requests that were not answered are given up."""
        self._manager.servers.pop(self.endpoint.gid, None)
        self._zenoh.close()
        for request in list(self.unanswered.values()):
            request.drop()


def fail(
    connection: Connection, sequence: int, gid: bytes, error_type: str, error_text: str
) -> None:
    """Send an error in place of a response."""
    payload = msgspec.json.encode((error_type, error_text))
    connection.send(Kind.FAIL, sequence, gid, payload)


class IpcRequest(Request):
    """One request that came over a link."""

    def __init__(
        self, message: Any, sample_info: SampleInfo, connection: Connection, server: IpcServer
    ) -> None:
        self.message = message
        self.sample_info = sample_info
        self.connection = connection
        self._server = server

    def _finish(self) -> bool:
        """Note that the request is done with; return whether it was not yet."""
        key = (self.sample_info.gid, self.sample_info.sequence)
        return self._server.unanswered.pop(key, None) is not None

    def reply(self, response: Any) -> None:
        """Send the response, with the client's own number."""
        payload = cdr.encode(response)
        if self._finish():
            sample_info = self.sample_info
            now_ns = self._server.now_ns()
            self.connection.send_data(REPLY, sample_info.sequence, now_ns, sample_info.gid, payload)

    def fail(self, error_type: str, error_text: str) -> None:
        """Send an error."""
        if self._finish():
            sample_info = self.sample_info
            fail(self.connection, sample_info.sequence, sample_info.gid, error_type, error_text)

    def drop(self) -> None:
        """Tell the client that this server will not answer."""
        if self._finish():
            self.connection.send(Kind.END, self.sample_info.sequence, self.sample_info.gid)


# Clients


class IpcRequester(Requester):
    """A client.

    Args:
        manager: The links of this context.
        endpoint: The client.
        srv_type: Its service.
        zenoh: Its other way.
    """

    def __init__(
        self, manager: LinkManager, endpoint: EndpointInfo, srv_type: Any, zenoh: Requester
    ) -> None:
        self.endpoint = endpoint
        self.srv_type = srv_type
        self.over_zenoh: set[ForwardedCall] = set()
        self._manager = manager
        self._zenoh = zenoh
        self._asked_at = -1
        self._servers = 0
        self._connections: list[tuple[bytes, Connection]] = []
        self._reaches_all = False

    @property
    def servers(self) -> int:
        """How many servers of other contexts are matched."""
        if self._asked_at != self._manager.changes:
            self._ask()
        return self._servers

    def _ask(self) -> None:
        """Find out which servers there are, and whether links reach them all."""
        manager = self._manager
        self._asked_at = manager.changes
        self._servers = self._zenoh.servers
        servers = [
            server
            for server in manager.remote(EndpointKind.SERVER, self.endpoint.name)
            if self.endpoint.matches(server)
        ]
        links = [(server.gid, manager.linked(server.node.participant)) for server in servers]
        self._connections = [(gid, link) for gid, link in links if link is not None]
        self._reaches_all = bool(links) and len(self._connections) == len(links) == self._servers

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send `request` to every server of other contexts."""
        if self._asked_at != self._manager.changes:
            self._ask()
        if not self._reaches_all or self.over_zenoh:
            return ForwardedCall(self, request, sample_info, reply_to, self._zenoh)
        payload = cdr.encode(request)
        call = IpcCall(self._manager, self, sample_info.sequence, reply_to)
        for server, route in self._connections:
            call.routes.append(route)
            route.send_data(
                REQUEST,
                sample_info.sequence,
                sample_info.source_ns,
                sample_info.gid,
                server + payload,
            )
        return call

    def close(self) -> None:
        """Withdraw the client."""
        self._zenoh.close()
        for call in list(self._manager.calls.values()):
            if call.requester is self:
                call.end_all()


class ForwardedCall:
    """A call over Zenoh, counted while it is under way."""

    def __init__(
        self,
        requester: IpcRequester,
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
        """Pass on that nothing will come."""
        self._under_way.discard(self)
        self._reply_to.end()

    def cancel(self) -> None:
        """Forget the call."""
        self._under_way.discard(self)
        self._call.cancel()


class IpcCall:
    """A call over one or more links."""

    def __init__(
        self, manager: LinkManager, requester: IpcRequester, sequence: int, reply_to: ReplyTo
    ) -> None:
        self.requester = requester
        self.routes: list[Connection] = []
        self._calls = manager.calls
        self._sequence = sequence
        self._reply_to = reply_to
        self._calls[requester.endpoint.gid, sequence] = self

    def _finish(self) -> bool:
        return self._calls.pop((self.requester.endpoint.gid, self._sequence), None) is not None

    def replied(self, one: Frame, payload: Data) -> None:
        """Take a response."""
        service = self.requester.endpoint.name
        try:
            response = cdr.decode(self.requester.srv_type.Response, payload)
        except DecodeError as error:
            if self._finish():
                self._reply_to.fail(ServiceError(service, f"the response is unreadable: {error}"))
            return
        if self._finish():
            self._reply_to.reply(response, SampleInfo(one.gid, one.sequence, one.source_ns, True))

    def failed(self, payload: Data) -> None:
        """Take a server's error."""
        try:
            error_type, error_text = ERROR.decode(payload)
        except msgspec.MsgspecError as error:
            raise FrameError(f"an error in no known form: {error}") from error
        if self._finish():
            self._reply_to.fail(ServiceError(self.requester.endpoint.name, error_text, error_type))

    def ended(self, connection: Connection) -> None:
        """Note that one server will not answer."""
        if connection in self.routes:
            self.routes.remove(connection)
        if not self.routes:
            self.end_all()

    def end_all(self) -> None:
        """Note that nothing will come any more."""
        if self._finish():
            self._reply_to.end()

    def cancel(self) -> None:
        """Forget the call, and tell the servers."""
        if self._finish():
            for route in self.routes:
                route.send(Kind.CANCEL, self._sequence, self.requester.endpoint.gid)


def server_of(payload: Data) -> tuple[bytes, Data]:
    """Return whom a request is for, and the request itself.

    Raises:
        FrameError: it is too short.
    """
    if len(payload) < GID_SIZE:
        raise FrameError("a request to nobody")
    return bytes(payload[:GID_SIZE]), payload[GID_SIZE:]
