"""Handles of service servers and clients, over the endpoints of a bare node."""

from __future__ import annotations

import logging
from collections import deque
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from aionode._process.recent import Recent
from aionode.clock import MachineTime, perf_ns
from aionode.engine.bare_node import BareClient, BareEndpoint
from aionode.engine.causes import Party, Run, acting_for
from aionode.engine.reports.limits import heavy_text
from aionode.engine.rules.service_events import (
    REQUEST_RECEIVED,
    REQUEST_SENT,
    RESPONSE_RECEIVED,
    RESPONSE_SENT,
)
from aionode.engine.transport.drops import Drop
from aionode.errors import DecodeError
from rclpy._impl.endpoint import BareT, EndpointHandle
from rclpy._impl.introspection import Introspection
from rclpy._impl.typesupport import service_support

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Clock
    from aionode.engine.rules.service_events import ServiceIntrospectionState
    from aionode.engine.transport.base import Request
    from aionode.errors import ServiceError
    from aionode.qos import QoSProfile
    from rclpy._impl.destroyable import Arrivals
    from rclpy._impl.node import NodeHandle

__all__ = ["ClientHandle", "ServiceHandle", "rmw_request_id_t", "rmw_service_info_t"]

MAX_REQUESTS = 1000
"""Maximum number of requests that a service keeps until they are taken, whatever its QoS."""

logger = logging.getLogger("aionode.rclpy")

now_ns = MachineTime().system_ns


class rmw_request_id_t(NamedTuple):  # noqa: N801  # rclpy's name
    """The request that a response belongs to."""

    sequence_number: int
    writer_guid: bytes = bytes(16)


class rmw_service_info_t(NamedTuple):  # noqa: N801  # rclpy's name
    """The origin of a request or a response."""

    request_id: rmw_request_id_t
    source_timestamp: int = 0
    received_timestamp: int = 0


class Requests:
    """The requests that wait for a server; filled by the thread of the context."""

    def __init__(
        self, limit: int, limit_bytes: int, arrivals: Arrivals, on_heavy: Callable[[], None]
    ) -> None:
        self.items: deque[tuple[Request, int]] = deque()
        self._limit = limit
        self._limit_bytes = limit_bytes
        self._on_heavy: Callable[[], None] | None = on_heavy  # called once
        self._arrivals = arrivals

    def serve(self, request: Request, inline_deadline_ns: int = 0) -> None:
        """Accept a request; if too many wait, drop the oldest and notify its client."""
        while self.items and (len(self.items) >= self._limit or self._is_heavy(request)):
            if len(self.items) < self._limit and self._on_heavy is not None:
                on_heavy, self._on_heavy = self._on_heavy, None
                on_heavy()
            with suppress(IndexError):  # another thread has taken it
                self.items.popleft()[0].drop()
        self.items.append((request, now_ns()))
        self._arrivals.note()

    def _is_heavy(self, request: Request) -> bool:
        waiting = self.items.copy()  # other threads take from it
        waiting_bytes = sum(len(other.message.data) for other, _ in waiting)
        return waiting_bytes + len(request.message.data) > self._limit_bytes


class CallHandle(EndpointHandle[BareT]):
    """One end of a service: a server or a client.

    Args:
        node: Its node.
        srv_type: The service class.
        srv_name: Its name.
        qos_profile: Its profile.
        wanted: The name of this end, for the error after shutdown.
    """

    def __init__(
        self, node: NodeHandle, srv_type: Any, srv_name: str, qos_profile: Any, wanted: str
    ) -> None:
        super().__init__(node, srv_name, qos_profile, f"failed to create {wanted}", is_service=True)
        self.srv_type = srv_type
        self._support = service_support(srv_type)
        self._introspection = Introspection(node, srv_type, self.name)

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publish events of calls on ``<service>/_service_event``.

        Args:
            clock: The clock for the stamps of events.
            service_event_qos_profile: The profile of that topic.
            introspection_state: Whether events are published, and whether with contents.
        """
        self._introspection.configure(clock, service_event_qos_profile, introspection_state)

    def _destroy(self) -> None:
        if hasattr(self, "_introspection"):
            self._introspection.close()
        super()._destroy()


MAX_TAKEN = 10_000
"""Number of requests that may wait for a late answer; beyond that, the oldest gets none."""


class ServiceHandle(CallHandle[BareEndpoint]):
    """A service server, in which requests wait until they are taken."""

    def __init__(self, node: NodeHandle, srv_type: Any, srv_name: str, qos_profile: Any) -> None:
        super().__init__(node, srv_type, srv_name, qos_profile, "service")
        limit_bytes = node.bare.context.network.queue_bytes
        text = heavy_text(self.name, limit_bytes, "refused (logged once)")
        self._requests = Requests(
            self.profile.depth or MAX_REQUESTS,
            limit_bytes,
            node.requests,
            partial(logger.warning, text),
        )
        # Threads that spin add and pop requests, each in one atomic step.
        self._taken: Recent[rmw_request_id_t, Request] = Recent(MAX_TAKEN)
        self._announce(node.bare.create_server, self._support.wire_type, self._requests.serve)

    def ready(self) -> bool:
        """Return whether a request waits."""
        return bool(self._requests.items) and not self._unwanted

    def service_take_request(
        self, request_type: Any
    ) -> tuple[Any, rmw_service_info_t] | tuple[None, None]:
        """Return the oldest waiting request and its header, or None twice."""
        del request_type
        while True:
            try:
                request, received_ns = self._requests.items.popleft()
            except IndexError:
                return None, None
            if request.cancelled:
                self.io.post(request.drop)
                continue
            try:
                message = self._support.request.decode(request.message.data)
            except DecodeError as error:
                self.io.context.drops.note(Drop.MALFORMED, self.name, f"a request ({error})")
                self.io.send(partial(request.fail, "DecodeError", str(error)))
                continue
            info = request.sample_info
            request_id = rmw_request_id_t(info.sequence, info.gid)
            self._taken.put(request_id, request)
            self._introspection.tell(REQUEST_RECEIVED, info.gid, info.sequence, message)
            return message, rmw_service_info_t(request_id, info.source_ns, received_ns)

    def service_send_response(self, response: Any, request_id: rmw_request_id_t) -> None:
        """Answer the request with this id; a second answer is dropped."""
        data = self._support.response.encode(response)
        request = self._taken.pop(request_id, None)
        if request is None:
            return
        if self.causes is not None:
            sequence, gid = request_id
            self.causes.note("response", Party.of(self.endpoint), sequence, gid=gid)
        self.io.send(partial(request.reply, self._support.wire_type.Response(data)))
        self._introspection.tell(
            RESPONSE_SENT, request_id.writer_guid, request_id.sequence_number, response
        )

    def service_send_error(self, error_type: str, text: str, request_id: rmw_request_id_t) -> None:
        """Send an error instead of a response; only aionode clients get it."""
        request = self._taken.pop(request_id, None)
        if request is not None:
            self.io.send(partial(request.fail, error_type, text))

    def give_up(self, request_id: rmw_request_id_t) -> None:
        """Leave a request without an answer; its client keeps waiting.

        As in rclpy, whose clients do not learn that a callback has failed.
        """
        self._taken.pop(request_id, None)


class Replies:
    """The replies that wait for a client; filled by the thread of the context."""

    def __init__(self, arrivals: Arrivals) -> None:
        self.items: deque[tuple[int, Any, int]] = deque()
        # Calling threads add an entry before they send, and pop it to give up; the thread of the
        # context pops the entry of a reply. Each is one atomic step, so only one of them gets the
        # entry.
        self.blocked: dict[int, Callable[[Any], None]] = {}
        self._arrivals = arrivals

    def take(self, sequence: int, response: Any) -> None:
        """Handle a response; a thread waiting for it gets it immediately."""
        waiting = self.blocked.pop(sequence, None)
        if waiting is not None:
            waiting(response.data)
            return
        self.items.append((sequence, response.data, now_ns()))
        self._arrivals.note()


class ClientHandle(CallHandle[BareClient]):
    """A client, in which responses wait until they are taken."""

    def __init__(self, node: NodeHandle, srv_type: Any, srv_name: str, qos_profile: Any) -> None:
        super().__init__(node, srv_type, srv_name, qos_profile, "client")
        self._replies = Replies(node.responses)
        self._calls: dict[int, Any] = {}  # used by the thread of the loop, or its borrower
        self._sequence = 0  # changed under the lock of the client
        # Where causes are kept: the numbers by which others know the requests that are pending.
        self._numbers: Recent[int, int] = Recent(MAX_REQUESTS)
        self._announce(node.bare.create_client, self._support.wire_type)

    def ready(self) -> bool:
        """Return whether a response waits."""
        return bool(self._replies.items) and not self._unwanted

    def send_request(self, request: Any, on_response: Callable[[Any], None] | None = None) -> int:
        """Send a request and return its number.

        Args:
            request: The request.
            on_response: Called in the thread of the context with the bytes of the response, which
                then need not be taken: for a thread that waits for it.
        """
        data = self._support.request.encode(request)
        self._sequence += 1
        sequence = self._sequence
        if on_response is not None:
            self._replies.blocked[sequence] = on_response
        self._introspection.tell(REQUEST_SENT, self.endpoint.gid, sequence, request)
        wired, causes = self._support.wire_type.Request(data), acting_for()
        self.io.send(partial(self._send, sequence, wired, now_ns(), causes))
        return sequence

    def take_cause(self, sequence: int) -> Run | None:
        """Return what has taken the response of a request; None if causes are not kept."""
        number = self._numbers.pop(sequence, None)
        if number is None:
            return None
        at_ns = perf_ns()
        return Run(Party.of(self.endpoint), "response", self.endpoint.gid, number, at_ns, at_ns)

    def _send(self, sequence: int, request: Any, source_ns: int, causes: tuple[Run, ...]) -> None:
        replies, calls = self._replies, self._calls

        def reply(response: Any) -> None:
            calls.pop(sequence, None)
            replies.take(sequence, response)

        def fail(error: ServiceError | None) -> None:
            # rclpy's clients wait forever: no error reaches them.
            calls.pop(sequence, None)
            if error is not None:
                logger.warning("%s: %s", self.name, error)

        if self.bare.servers:
            if self.causes is not None:
                number = self.bare.calls + 1
                self._numbers.put(sequence, number)
                self.causes.note("request", Party.of(self.endpoint), number, causes=causes)
            call = self.bare.send(request, source_ns, reply, fail)
            if call.open:
                calls[sequence] = call

    def receive(self, sequence: int, data: bytes) -> Any:
        """Decode a response received as bytes.

        Raises:
            DecodeError: the bytes are not a response.
        """
        response = self._support.response.decode(data)
        self._introspection.tell(RESPONSE_RECEIVED, self.endpoint.gid, sequence, response)
        return response

    def forget(self, sequence: int) -> None:
        """Forget a request: the server need not start it, and its response is dropped."""
        self._replies.blocked.pop(sequence, None)

        def cancel() -> None:
            call = self._calls.pop(sequence, None)
            if call is not None:
                call.cancel()

        self.io.post(cancel)

    def take_response(
        self, response_type: Any
    ) -> tuple[rmw_service_info_t, Any] | tuple[None, None]:
        """Return the header of the oldest waiting response, and the response, or None twice."""
        del response_type
        while True:
            try:
                sequence, data, received_ns = self._replies.items.popleft()
            except IndexError:
                return None, None
            try:
                response = self.receive(sequence, data)
            except DecodeError as error:
                self.io.context.drops.note(Drop.MALFORMED, self.name, f"a response ({error})")
                continue
            request_id = rmw_request_id_t(sequence, self.endpoint.gid)
            return rmw_service_info_t(request_id, 0, received_ns), response

    def service_server_is_available(self) -> bool:
        """Return whether a server is matched.

        Raises:
            RCLError: the context is shut down.
        """
        self._node.context_handle.refuse_after_shutdown("failed to check service availability")
        return self.io.call(lambda: self.bare.servers > 0)
