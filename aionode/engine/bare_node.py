"""Nodes and endpoints without callbacks, queues and tasks, for other APIs over aionode.

A `BareNode` is a node in the graph and nothing else: no parameters, services, log or clock. Its
endpoints pass what arrives to your functions, and send what you give them. Together with
`aionode.message.serialized`, which leaves messages in their encoded form, they carry the messages
of programs that have message classes, threads and queues of their own.

Everything here belongs to the thread of the context's event loop, where the context was opened with
``async with``: create, use and destroy it there. Your functions and objects are called in that
thread as well, and must not block. Where a loop is lent to other threads, as aionode's own is for
rclpy programs, the borrower may also send messages, requests and responses, with
`BarePublisher.publish`, `BarePublisher.publish_elsewhere`, `BareClient.send`, `BareCall.cancel` and
the methods of `Request`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from aionode import qos
from aionode.engine.causes import Party
from aionode.engine.membership import describe_endpoint, describe_node, join, load_arrays, register
from aionode.engine.transport.base import SampleInfo
from aionode.engine.transport.local import LocalWriter
from aionode.errors import EntityDestroyedError, QueueFullError
from aionode.graph import EndpointKind
from aionode.message import unserialized
from aionode.qos import KEEP_ALL_DEPTH

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.engine.context import Context
    from aionode.engine.transport.base import (
        Call,
        Reader,
        Registration,
        Request,
        Requester,
        Serve,
        Writer,
    )
    from aionode.errors import ServiceError
    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile

__all__ = ["BareCall", "BareClient", "BareEndpoint", "BareNode", "BarePublisher"]


class BareEndpoint:
    """One endpoint of a bare node, announced from its creation until `destroy`.

    Attributes:
        endpoint: Its entry in the graph, with its resolved QoS.
    """

    def __init__(
        self, node: BareNode, endpoint: EndpointInfo, registrations: Sequence[Registration]
    ) -> None:
        self.endpoint = endpoint
        self._node = node
        self._registrations = registrations

    def matched(self) -> list[EndpointInfo]:
        """Return the endpoints of the opposite kind that this one currently communicates with."""
        endpoint = self.endpoint
        others = self._node.context.graph.endpoints(endpoint.kind.opposite, name=endpoint.name)
        return [other for other in others if endpoint.matches(other)]

    def destroy(self) -> None:
        """Withdraw the endpoint; calling it again has no effect."""
        if self._node._forget(self):
            self._node.context.graph.remove_endpoint(self.endpoint)
            for registration in self._registrations:
                registration.close()


class BarePublisher(BareEndpoint):
    """A publisher of a bare node.

    Attributes:
        published: Number of messages sent.
    """

    def __init__(self, node: BareNode, endpoint: EndpointInfo, writers: Sequence[Writer]) -> None:
        super().__init__(node, endpoint, writers)
        self.published = 0
        self._causes = node.context.causes
        self._party = Party.of(endpoint)
        self._writers = writers
        self._here = [writer for writer in writers if isinstance(writer, LocalWriter)]
        self._leave_out_placeholders()
        for writer in writers:
            writer.when_replaced(self._leave_out_placeholders)

    def _leave_out_placeholders(self) -> None:
        """Send messages only to writers that are not placeholders."""
        self._elsewhere = [
            writer
            for writer in self._writers
            if not (writer.is_placeholder or isinstance(writer, LocalWriter))
        ]

    def is_heard(self) -> bool:
        """Return whether a message that is published now would be sent or kept."""
        return any(writer.active for writer in (*self._here, *self._elsewhere))

    def publish(self, msg: Any, source_ns: int) -> None:
        """Send a message to every matched subscription.

        Args:
            msg: An object of the class that the publisher was created with.
            source_ns: When it was published, in nanoseconds since 1970.

        Raises:
            MessageError: a value does not fit its field; nothing was sent.
            QueueFullError: a reliable KEEP_ALL subscription of this context is full; nothing was
                sent. `drain` waits for room.
        """
        sequence = self.publish_here(msg, source_ns)
        if sequence:
            self.publish_elsewhere(msg, sequence, source_ns)

    def publish_here(self, msg: Any, source_ns: int) -> int:
        """Send a message to the subscriptions of this context only, and deliver it immediately.

        Any thread may call it, but only one at a time, and not while a subscription is being
        created in the context; the readers must expect that thread.

        Args:
            msg: An object of the class that the publisher was created with.
            source_ns: When it was published, in nanoseconds since 1970.

        Returns:
            Its number, for `publish_elsewhere`; 0 if no other context needs the message.

        Raises:
            QueueFullError: as for `publish`.
        """
        for writer in self._here:
            if writer.bounded and not writer.has_room():
                raise QueueFullError(self.endpoint.name, KEEP_ALL_DEPTH)
        sequence = self.published = self.published + 1
        if self._causes is not None:
            self._causes.note("message", self._party, sequence)
        for writer in self._here:
            if writer.active:
                writer.write(msg, sequence, source_ns)
        for other in self._elsewhere:
            if other.active:
                return sequence
        return 0

    def publish_elsewhere(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send a message to other contexts, after `publish_here`; in the thread of the loop.

        Messages must be passed in order. A link takes the message immediately, unless its socket is
        full or the subscription's window is used up; then the message waits for the loop.

        Args:
            msg: The same message.
            sequence: The result of `publish_here`.
            source_ns: The same time.
        """
        for writer in self._elsewhere:
            if writer.active:
                writer.write(msg, sequence, source_ns)

    def assert_liveliness(self) -> None:
        """Tell the matched subscriptions that the publisher is alive, without a message."""
        for writer in self._writers:
            writer.assert_liveliness()

    async def drain(self) -> None:
        """Wait until all reliable KEEP_ALL subscriptions have room and nothing is left to send."""
        for writer in self._writers:
            await writer.drain()


class BareClient(BareEndpoint):
    """A client of a bare node.

    Attributes:
        calls: Number of requests sent, which is the number of the last one.
    """

    def __init__(
        self, node: BareNode, endpoint: EndpointInfo, requesters: Sequence[Requester]
    ) -> None:
        super().__init__(node, endpoint, requesters)
        self.calls = 0
        self._requesters = requesters

    @property
    def servers(self) -> int:
        """The number of servers currently matched."""
        return sum(requester.servers for requester in self._requesters)

    def send(
        self,
        request: Any,
        source_ns: int,
        on_reply: Callable[[Any], None],
        on_error: Callable[[ServiceError | None], None],
    ) -> BareCall:
        """Send a request to every matched server; exactly one of the callbacks is called, once.

        Args:
            request: An object of the request class that the client was created with.
            source_ns: When it was sent, in nanoseconds since 1970.
            on_reply: Called with the first response, possibly before this method returns.
            on_error: Called with the error that a server sent instead, or with None if no matched
                server is left that could answer. If there is no server at all, neither is called.

        Raises:
            MessageError: a value does not fit its field; nothing was sent.
        """
        self.calls += 1
        sample_info = SampleInfo(self.endpoint.gid, self.calls, source_ns)
        call = BareCall(on_reply, on_error)
        try:
            for requester in self._requesters:
                if requester.servers:
                    call.open += 1
                    call.calls.append(requester.send(request, sample_info, call))
        except BaseException:
            call.cancel()
            raise
        return call


class BareCall:
    """A pending request; `cancel` forgets it. Transports see it as the `ReplyTo`.

    Attributes:
        calls: The request in each transport.
        open: Number of transports that may still answer.
    """

    def __init__(
        self,
        on_reply: Callable[[Any], None],
        on_error: Callable[[ServiceError | None], None],
    ) -> None:
        self.calls: list[Call] = []
        self.open = 0
        self._on_reply = on_reply
        self._on_error = on_error
        self._finished = False

    def cancel(self) -> None:
        """Forget the request: no callback is called, and a server need not start serving it."""
        self._finished = True
        for call in self.calls:
            call.cancel()

    def reply(self, response: Any, sample_info: SampleInfo) -> None:  # noqa: ARG002  # part of ReplyTo
        """Handle a response."""
        if not self._finished:
            self._finished = True
            self._on_reply(response)

    def fail(self, error: ServiceError) -> None:
        """Handle a server's error."""
        if not self._finished:
            self._finished = True
            self._on_error(error)

    def end(self) -> None:
        """Handle that a transport has no more answers."""
        self.open -= 1
        if self.open == 0 and not self._finished:
            self._finished = True
            self._on_error(None)


class BareNode:
    """A node in the graph, and the owner of bare endpoints.

    Names are used as they are given: valid, complete and remapped. It has no services of its own,
    but for what `describe_types` adds.

    Args:
        context: The context that it joins.
        name: Its name without the namespace.
        namespace: Its namespace, starting with a slash.
        enclave: Its security enclave.

    Attributes:
        context: The context.
        info: Its entry in the graph.

    Raises:
        EntityDestroyedError: the context was shut down (a RuntimeError).
    """

    def __init__(
        self, context: Context, name: str, namespace: str = "/", enclave: str = "/"
    ) -> None:
        self.context = context
        self.info = describe_node(context, name, namespace, enclave)
        self._endpoints: dict[BareEndpoint, Any] = {}  # each with its type
        self._destroyed = False
        self._leave = join(context, self, self.info, self._abandon)

    def create_publisher(self, msg_type: Any, topic: str, profile: QoSProfile) -> BarePublisher:
        """Create a publisher of `msg_type`, a message class or the result of `serialized` for one.

        Raises:
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        endpoint = self._describe(EndpointKind.PUBLISHER, topic, msg_type, profile)
        writers = register(
            self.context, lambda transport: transport.create_writer(endpoint, msg_type)
        )
        return self._add(BarePublisher(self, endpoint, writers), msg_type)

    def create_subscription(
        self, msg_type: Any, topic: str, profile: QoSProfile, reader: Reader
    ) -> BareEndpoint:
        """Create a subscription that passes messages to `reader`, whose `endpoint` is set first.

        Messages kept by transient local publishers may be delivered before this returns.

        Raises:
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        endpoint = reader.endpoint = self._describe(
            EndpointKind.SUBSCRIPTION, topic, msg_type, profile
        )
        registrations = register(
            self.context, lambda transport: transport.create_reader(endpoint, msg_type, reader)
        )
        return self._add(BareEndpoint(self, endpoint, registrations), msg_type)

    def create_server(
        self, srv_type: Any, service: str, profile: QoSProfile, serve: Serve
    ) -> BareEndpoint:
        """Create a server that passes requests to `serve`, which answers each `Request` once.

        Raises:
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        load_arrays(srv_type)
        endpoint = self._describe(EndpointKind.SERVER, service, srv_type, profile)
        registrations = register(
            self.context, lambda transport: transport.create_server(endpoint, srv_type, serve)
        )
        return self._add(BareEndpoint(self, endpoint, registrations), srv_type)

    def create_client(self, srv_type: Any, service: str, profile: QoSProfile) -> BareClient:
        """Create a client.

        Raises:
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        endpoint = self._describe(EndpointKind.CLIENT, service, srv_type, profile)
        requesters = register(
            self.context, lambda transport: transport.create_requester(endpoint, srv_type)
        )
        return self._add(BareClient(self, endpoint, requesters), srv_type)

    def describe_types(self) -> None:
        """Serve ``get_type_description``, so that other processes find types that only it uses.

        Nodes of Humble have no such service: in a context of Humble, this has no effect.

        Raises:
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        # Imported on demand: only needed here.
        from aionode.engine.type_descriptions import describe_type
        from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription

        def serve(request: Request, inline_deadline_ns: int = 0) -> None:  # noqa: ARG001  # part of Serve
            used = [unserialized(ros_type) for ros_type in self._endpoints.values()]
            request.reply(describe_type(used, request.message, GetTypeDescription.Response()))

        if self.context.ros_distro != "humble":
            name = f"{self.info.fully_qualified_name}/get_type_description"
            self.create_server(GetTypeDescription, name, qos.qos_profile_services_default, serve)

    def destroy_node(self) -> None:
        """Destroy the endpoints, newest first, and leave the graph; repeating it has no effect."""
        if self._destroyed:
            return
        self._destroyed = True
        for endpoint in reversed(list(self._endpoints)):
            endpoint.destroy()
        self._leave()

    def _abandon(self) -> None:
        """Mark the node as destroyed without closing anything; for a forked child."""
        self._destroyed = True
        self._endpoints.clear()

    def _describe(
        self, kind: EndpointKind, name: str, ros_type: Any, profile: QoSProfile
    ) -> EndpointInfo:
        if self._destroyed:
            raise EntityDestroyedError(
                f"node {self.info.fully_qualified_name}", f"create {kind.value}"
            )
        return describe_endpoint(self.context, kind, self.info, name, ros_type, profile)

    def _add(self, endpoint: EndpointT, ros_type: Any) -> EndpointT:
        self._endpoints[endpoint] = ros_type
        self.context.graph.add_endpoint(endpoint.endpoint)
        return endpoint

    def _forget(self, endpoint: BareEndpoint) -> bool:
        """Forget an endpoint; return whether it was known."""
        known = endpoint in self._endpoints
        self._endpoints.pop(endpoint, None)
        return known


EndpointT = TypeVar("EndpointT", bound=BareEndpoint)
