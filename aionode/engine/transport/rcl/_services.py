"""Servers and clients on rcl.

ROS 2 services cannot transmit errors or their own end: a server whose handler fails can only stay
silent, and a call whose server is gone is ended here, when the graph shows it.
"""

from __future__ import annotations

import logging
from ctypes import byref, c_bool, c_int64
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import perf_ns
from aionode.engine.transport.base import Request, Requester, SampleInfo
from aionode.engine.transport.rcl._bindings import RequestId, ServiceInfo
from aionode.engine.transport.rcl._state import RclDeclaration
from aionode.engine.transport.rcl._types import MessageSupport, rosidl_class
from aionode.engine.transport.rcl._wake import Wake
from aionode.engine.wire import cdr
from aionode.errors import DecodeError, ServiceError, TransportError
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.base import Call, ReplyTo, Serve
    from aionode.engine.transport.rcl._bindings import ByteArray, Rcl
    from aionode.engine.transport.rcl._state import RclState
    from aionode.graph import EndpointInfo

__all__ = ["RclRequester", "RclServer"]

logger = logging.getLogger("aionode.transport.rcl")

DEPTH: Final = 1000
"""Minimum depth of our servers and clients: with ROS's 10, some of 30 parallel calls are lost."""

AVAILABLE_S: Final = 0.005
"""Interval at which a client checks whether a known server can answer yet, in seconds."""

AVAILABLE_NS: Final = 5_000_000_000
"""Time after which a request is sent anyway, in nanoseconds."""


class Exchanges:
    """Converts the two messages of a service between CDR and rosidl's C structures.

    Raises:
        TransportError: see `rosidl_class`.
    """

    def __init__(self, rcl: Rcl, endpoint: EndpointInfo) -> None:
        self._rcl = rcl
        self.ros_class = rosidl_class(endpoint.type_name, endpoint.type_hash)
        self.request = MessageSupport(rcl, self.ros_class.Request)
        self.response = MessageSupport(rcl, self.ros_class.Response)
        self._array: ByteArray = rcl.new_array()

    def take(
        self, take: Callable[..., int], pointer: int, info: ServiceInfo, support: MessageSupport
    ) -> bytes | None:
        """Return the next message as CDR; None if there is none."""
        message = support.create()
        try:
            if take(pointer, byref(info), message):
                self._rcl.forget_error()
                return None
            return support.to_cdr(message, self._array)
        finally:
            support.destroy(message)

    def send(
        self,
        send: Callable[..., int],
        pointer: int,
        support: MessageSupport,
        payload: bytes,
        *others: Any,
    ) -> None:
        """Send a message; `others` are further arguments of `send`.

        Raises:
            TransportError: rcl refuses it.
        """
        message = support.create()
        try:
            support.from_cdr(payload, message)
            order = (
                (pointer, *others, message)
                if support is self.response
                else (
                    pointer,
                    message,
                    *others,
                )
            )
            if send(*order):
                raise TransportError(self._rcl.error())
        finally:
            support.destroy(message)

    def close(self) -> None:
        """Free its resources."""
        self._rcl.free_array(self._array)


# Servers


class RclServer(RclDeclaration):
    """A server for clients of other contexts; our own clients are served by `LocalTransport`."""

    def __init__(
        self, state: RclState, endpoint: EndpointInfo, srv_type: Any, serve: Serve
    ) -> None:
        super().__init__(state, endpoint)
        self.srv_type = srv_type
        self._serve = serve
        self._exchanges: Exchanges | None = None
        self._handle: Any = None
        self._wake: Wake | None = None
        self._info = ServiceInfo()
        self._warned = False
        self.unanswered: set[RclRequest] = set()
        state.add(self)

    def declare(self, rcl: Rcl) -> None:
        """Create the server."""
        exchanges = Exchanges(rcl, self.endpoint)
        loop = self.state.loop
        if loop is None:
            return
        self._handle = self.make(rcl.module.Service, exchanges.ros_class, DEPTH)
        self._exchanges = exchanges
        self._wake = Wake(loop, rcl, rcl.set_service_callback, self._handle.pointer, self._take)

    def undeclare(self) -> None:
        """Destroy it; unanswered requests stay unanswered."""
        wake, self._wake = self._wake, None
        handle, self._handle = self._handle, None
        exchanges, self._exchanges = self._exchanges, None
        if wake is not None:
            wake.close()
        if handle is not None:
            handle.destroy_when_not_in_use()
        if exchanges is not None:
            exchanges.close()
        self.unanswered.clear()

    def _take(self, inline_deadline_ns: int) -> bool:
        """Take one request; return whether there may be more."""
        rcl, exchanges, info = self.state.rcl, self._exchanges, self._info
        if rcl is None or exchanges is None:
            return False
        try:
            payload = exchanges.take(
                rcl.take_request, self._handle.pointer, info, exchanges.request
            )
            if payload is None:
                return False
            gid = bytes(info.request_id.gid)
            if self.state.is_own(gid):
                return True
            message = cdr.decode_request(self.srv_type.Request, payload)
        except (DecodeError, TransportError) as error:
            self.state.note_malformed(self.endpoint.name, str(error))
            return True
        sample_info = SampleInfo(gid, info.request_id.sequence, info.source_ns)
        self._serve(RclRequest(message, sample_info, self), inline_deadline_ns)
        return True

    def respond(self, sample_info: SampleInfo, payload: bytes) -> None:
        """Send a response; a client that is gone gets none."""
        rcl, exchanges = self.state.rcl, self._exchanges
        if rcl is None or exchanges is None:
            return
        request_id = RequestId()
        request_id.gid[:] = sample_info.gid
        request_id.sequence = sample_info.sequence
        try:
            exchanges.send(
                rcl.send_response,
                self._handle.pointer,
                exchanges.response,
                payload,
                byref(request_id),
            )
        except TransportError as error:
            logger.debug("%s: not answered: %s", self.endpoint.name, error)

    def note_failed(self) -> None:
        """Warn once that clients are not told about failed requests."""
        if not self._warned:
            self._warned = True
            logger.warning(
                "%s: a request failed, and its client waits forever: over DDS, services cannot "
                "transmit errors. Let the handler report failures in a field of the response",
                self.endpoint.name,
            )


class RclRequest(Request):
    """One request from another process."""

    def __init__(self, message: Any, sample_info: SampleInfo, server: RclServer) -> None:
        self.message = message
        self.sample_info = sample_info
        self._server = server
        server.unanswered.add(self)

    def _finish(self) -> bool:
        """Mark the request as answered; return whether it was not answered before."""
        if self not in self._server.unanswered:
            return False
        self._server.unanswered.discard(self)
        return True

    def reply(self, response: Any) -> None:
        """Send the response."""
        payload = cdr.encoder(self._server.srv_type.Response)(response)
        if self._finish():
            self._server.respond(self.sample_info, payload)

    def fail(self, error_type: str, error_text: str) -> None:  # noqa: ARG002  # cannot be told
        """Leave the client without an answer: errors cannot be transmitted."""
        if self._finish():
            self._server.note_failed()

    def drop(self) -> None:
        """Leave the client without an answer; the graph shows it that the server is going away."""
        self._finish()


# Clients


class RclRequester(RclDeclaration, Requester):
    """A client for servers of other contexts."""

    def __init__(self, state: RclState, endpoint: EndpointInfo, srv_type: Any) -> None:
        super().__init__(state, endpoint)
        self.srv_type = srv_type
        self._exchanges: Exchanges | None = None
        self._handle: Any = None
        self._wake: Wake | None = None
        self._info = ServiceInfo()
        self._servers: set[EndpointInfo] = set()
        self._unwatch: Callable[[], None] | None = None
        self.waiting: set[RclCall] = set()
        self.calls: dict[int, RclCall] = {}
        state.add(self)

    def declare(self, rcl: Rcl) -> None:
        """Create the client."""
        exchanges = Exchanges(rcl, self.endpoint)
        loop, graph = self.state.loop, self.state.graph
        if loop is None or graph is None:
            return
        self._handle = self.make(rcl.module.Client, exchanges.ros_class, DEPTH)
        self._exchanges = exchanges
        gid = rcl.client_gid(self._handle.pointer)
        self.state.note_own(gid)
        self.identify(gid)
        self._unwatch = graph.watch(EndpointKind.SERVER, self.endpoint.name, self._note_server)
        self._wake = Wake(loop, rcl, rcl.set_client_callback, self._handle.pointer, self._take)

    def undeclare(self) -> None:
        """Destroy it, and end pending calls."""
        wake, self._wake = self._wake, None
        handle, self._handle = self._handle, None
        exchanges, self._exchanges = self._exchanges, None
        if self._unwatch is not None:
            self._unwatch()
            self._unwatch = None
        if wake is not None:
            wake.close()
        if handle is not None:
            handle.destroy_when_not_in_use()
        if exchanges is not None:
            exchanges.close()
        self._servers.clear()
        self._end_calls()

    @property
    def servers(self) -> int:
        """The number of matched servers in other contexts."""
        return len(self._servers)

    def _note_server(self, server: EndpointInfo, present: bool) -> None:
        if present and server.node.over_rcl and self.endpoint.matches(server):
            self._servers.add(server)
            return
        self._servers.discard(server)
        if not self._servers:
            self._end_calls()

    def _end_calls(self) -> None:
        for call in [*self.waiting, *self.calls.values()]:
            call.end()

    def is_available(self) -> bool:
        """Return whether a server can accept a request and answer it."""
        rcl = self.state.rcl
        if rcl is None or self._handle is None:
            return True  # then sending fails
        answer = c_bool(False)
        node = self.state.node(self.endpoint.node)
        if rcl.is_available(node.pointer, self._handle.pointer, byref(answer)):
            rcl.forget_error()
        return bool(answer)

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:  # noqa: ARG002  # DDS numbers them
        """Send `request` to every server."""
        payload = cdr.encoder(self.srv_type.Request)(request)
        call = RclCall(self, reply_to, payload)
        call.send_when_available()
        return call

    def send_now(self, payload: bytes) -> int:
        """Send a request; return its number.

        Raises:
            TransportError: rcl refuses it, or the context is closed.
        """
        rcl, exchanges = self.state.rcl, self._exchanges
        if rcl is None or exchanges is None:
            raise TransportError(f"{self.endpoint.name}: the context is closed")
        number = c_int64()
        exchanges.send(
            rcl.send_request, self._handle.pointer, exchanges.request, payload, byref(number)
        )
        return number.value

    def call_later(self, callback: Callable[[], None]) -> None:
        """Call `callback` in `AVAILABLE_S`."""
        if self.state.loop is not None:
            self.state.loop.call_later(AVAILABLE_S, callback)

    def _take(self, inline_deadline_ns: int) -> bool:  # noqa: ARG002  # a reply wakes a task
        """Take one response; return whether there may be more."""
        rcl, exchanges, info = self.state.rcl, self._exchanges, self._info
        if rcl is None or exchanges is None:
            return False
        try:
            payload = exchanges.take(
                rcl.take_response, self._handle.pointer, info, exchanges.response
            )
        except TransportError as error:
            self.state.note_malformed(self.endpoint.name, str(error))
            return True
        if payload is None:
            return False
        call = self.calls.get(info.request_id.sequence)
        if call is not None:
            call.take(payload, info)
        return True


class RclCall:
    """A pending call."""

    def __init__(self, requester: RclRequester, reply_to: ReplyTo, payload: bytes) -> None:
        self._requester = requester
        self._reply_to: ReplyTo | None = reply_to
        self._payload = payload
        self._number: int | None = None
        self._until_ns = perf_ns() + AVAILABLE_NS
        requester.waiting.add(self)

    def send_when_available(self) -> None:
        """Send the request as soon as a known server can answer it."""
        if self._reply_to is None:
            return
        requester = self._requester
        if not requester.is_available() and perf_ns() < self._until_ns:
            requester.call_later(self.send_when_available)
            return
        requester.waiting.discard(self)
        try:
            self._number = requester.send_now(self._payload)
        except TransportError as error:
            logger.debug("%s: not sent: %s", requester.endpoint.name, error)
            self.end()
        else:
            requester.calls[self._number] = self

    def take(self, payload: bytes, info: ServiceInfo) -> None:
        """Handle the response."""
        requester, reply_to = self._requester, self._reply_to
        self.cancel()
        if reply_to is None:
            return
        name = requester.endpoint.name
        try:
            response = cdr.decode(requester.srv_type.Response, payload)
        except DecodeError as error:
            requester.state.note_malformed(name, str(error))
            reply_to.fail(ServiceError(name, f"the response is unreadable: {error}"))
        else:
            gid, number = bytes(info.request_id.gid), info.request_id.sequence
            reply_to.reply(response, SampleInfo(gid, number, info.source_ns))

    def end(self) -> None:
        """Handle that no answer can come."""
        reply_to = self._reply_to
        self.cancel()
        if reply_to is not None:
            reply_to.end()

    def cancel(self) -> None:
        """Forget the call: the server is not told and continues, and its reply is dropped."""
        self._reply_to = None
        self._requester.waiting.discard(self)
        if self._number is not None:
            self._requester.calls.pop(self._number, None)
