"""The cases whose instructions are counted: without Zenoh's threads, and in one process.

A case is an async context manager that yields a function; each call of it starts one message, and a
few loop iterations complete it.
"""

# ruff: noqa: ARG002  # what the contract of transports passes

from __future__ import annotations

import asyncio
import gc
import socket
import time
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from functools import partial
from typing import Any, Final

import zenoh

from aionode import ActionClient, ActionServer, Context, Node
from aionode.engine.transport.base import Reader, Registration, Requester, Serve, Transport, Writer
from aionode.engine.transport.link import LinkTransport
from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.local import LocalTransport
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.transport.zenoh.endpoints.subscription import ZenohReader
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import qos_profile_sensor_data
from benchmarks.ipc_parts.common import TEXT, is_linked, node_of

__all__ = ["CASES", "TURNS", "Count", "calibrate"]

TURNS: Final = 3
"""Loop iterations that complete each message; a bare loop for comparison takes as many."""

SMALL: Final = 10  # depth of the queues


class Count:
    """How many messages, ticks or answers have arrived."""

    def __init__(self) -> None:
        self.count = 0

    def take(self, _: object = None) -> None:
        """Count one."""
        self.count += 1


Case = Callable[[Count], AbstractAsyncContextManager[Callable[[], Any]]]


# Transports that reach no network


class Silent(Writer, Requester):
    """An endpoint with nothing behind it."""

    active = False
    bounded = False
    servers = 1

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send nothing."""

    def send(self, request: Any, sample_info: Any, reply_to: Any) -> Any:
        """Send nothing."""

    def has_room(self) -> bool:
        """Always have room."""
        return True

    def close(self) -> None:
        """Withdraw nothing."""


class Introducer(Transport):
    """Replaces Zenoh: tells the contexts of this process about each other, and carries nothing."""

    present: Final[dict[str, tuple[Introducer, Graph]]] = {}

    def __init__(self, participant: str) -> None:
        self.participant = participant
        self.advertisement: str | None = None
        self.on_advertisement: Callable[[str, bool], None] = lambda _, __: None
        self.on_unannounced_peers: Callable[[bool], None] = lambda _: None
        self.on_retransmit: Callable[[bytes], None] = lambda _: None

    def retransmit(self, participant: str, data: bytes) -> None:
        """Send nothing."""

    def post(self, participant: str, data: bytes) -> None:
        """Send nothing."""

    def note_link(self, participant: str, on: bool) -> None:
        """Report nothing to tools."""

    def may_be_heard(self, publisher: EndpointInfo, changed: Callable[[], None]) -> bool:
        """Return whether there may be others, which announce nothing."""
        return False

    def forget(self, publisher: EndpointInfo, changed: Callable[[], None]) -> None:
        """Remember nothing."""

    async def open(self, graph: Graph) -> None:
        """Introduce the context and the existing ones to each other."""
        for other, theirs in self.present.values():
            for endpoint in theirs.endpoints():
                if endpoint.node.participant == other.participant:
                    graph.add_endpoint(endpoint)
            for one, another in ((self, other), (other, self)):
                if another.advertisement is not None:
                    one.on_advertisement(another.advertisement, True)
        self.present[self.participant] = (self, graph)

    async def close(self) -> None:
        """Leave."""
        del self.present[self.participant]

    def _announce(self, endpoint: EndpointInfo) -> Silent:
        loop = asyncio.get_running_loop()
        for other, graph in self.present.values():
            if other is not self:
                loop.call_soon(graph.add_endpoint, endpoint)
        return Silent()

    def create_node(self, node: NodeInfo) -> Registration:
        """Announce no node."""
        return Silent()

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher."""
        return self._announce(endpoint)

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Announce a subscription."""
        return self._announce(endpoint)

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a server."""
        return self._announce(endpoint)

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client."""
        return self._announce(endpoint)


class NoSession:
    """Replaces a Zenoh session, and everything that it declares; `put` sends nothing."""

    matching = True

    def __getattr__(self, name: str) -> Any:
        return self

    def __call__(self, *_: object, **__: object) -> NoSession:
        return self

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send nothing."""


class Sample:
    """A sample as passed on by Zenoh."""

    def __init__(self, payload: bytes, extra: bytes) -> None:
        self.payload = zenoh.ZBytes(payload)
        self.attachment = zenoh.ZBytes(extra)


class ZenohEndpoints(Introducer):
    """aionode's endpoints for Zenoh, without a session."""

    def __init__(self, participant: str) -> None:
        super().__init__(participant)
        self.state = SessionState(participant, 0)
        self.reader: ZenohReader | None = None

    async def open(self, graph: Graph) -> None:
        """Connect to nothing."""
        self.state.waker.open(asyncio.get_running_loop())
        self.state.connect(NoSession(), graph)  # type: ignore[arg-type]  # as far as it is used

    async def close(self) -> None:
        """End."""
        self.state.disconnect()
        self.state.waker.close()

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Return the writer that is measured."""
        return ZenohWriter(self.state, endpoint, msg_type)

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Return the reader that is measured."""
        self.reader = ZenohReader(self.state, endpoint, msg_type, reader)
        return self.reader


# Cases


@asynccontextmanager
async def nothing(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Only run the loop."""
    yield count.take


@asynccontextmanager
async def bare_socket(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Send 72 bytes over a Unix socket to a function that the loop calls."""
    ours, theirs = socket.socketpair()
    ours.setblocking(False)
    theirs.setblocking(False)
    loop = asyncio.get_running_loop()
    loop.add_reader(theirs, lambda: count.take(theirs.recv(1 << 15)))
    data = bytes(72)
    yield lambda: ours.send(data)
    loop.remove_reader(theirs)


@asynccontextmanager
async def bare_queue(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Put an object into a queue that a task reads."""
    queue: asyncio.Queue[int] = asyncio.Queue(SMALL)

    async def read() -> None:
        while True:
            count.take(await queue.get())

    reading = asyncio.ensure_future(read())
    yield lambda: queue.put_nowait(1)
    reading.cancel()


@asynccontextmanager
async def in_process(count: Count, *, causes: bool = False) -> AsyncIterator[Callable[[], Any]]:
    """Publish to a callback of the same process."""
    async with (
        Context(transport="local", causes=causes) as context,
        node_of("one", context) as node,
    ):
        publisher = node.create_publisher(String, "topic", SMALL)
        node.create_subscription(String, "topic", count.take, SMALL)
        yield lambda: publisher.publish(String(data=TEXT))


@asynccontextmanager
async def linked_nodes(*, causes: bool = False) -> AsyncIterator[tuple[Node, Node]]:
    """Return two nodes in two contexts, which are linked once they have matching endpoints."""

    def context() -> Context:
        made = Context(transport="local", causes=causes)
        made._transports = (LocalTransport(), link_of(made))  # noqa: SLF001  # with its own id
        return made

    def link_of(made: Context) -> LinkTransport:
        introducer = Introducer(made.participant)
        return LinkTransport(made.participant, 0, introducer, introducer)

    async with context() as a, context() as b, node_of("a", a) as one, node_of("b", b) as two:
        yield one, two


@asynccontextmanager
async def linked_pair(count: Count, *, causes: bool = False) -> AsyncIterator[tuple[Any, Any]]:
    """Return a publisher and the connection at the other end, which delivers to `count`."""
    async with linked_nodes(causes=causes) as (one, two):
        publisher = one.create_publisher(String, "topic", SMALL)
        two.create_subscription(String, "topic", count.take, SMALL)
        while not (publisher.get_subscription_count() and is_linked(publisher)):
            publisher.publish(String(data=TEXT))
            await asyncio.sleep(0.02)
        links = two.context.transports[1].manager._links  # type: ignore[attr-defined]  # noqa: SLF001  # no other way in
        yield publisher, next(iter(links.values()))


@asynccontextmanager
async def link_publish(count: Count, *, causes: bool = False) -> AsyncIterator[Callable[[], Any]]:
    """Publish over a link; what arrives is read from the socket and dropped."""
    async with linked_pair(count, causes=causes) as (publisher, connection):
        loop = asyncio.get_running_loop()
        sock = connection._sock  # noqa: SLF001  # to read past it
        loop.remove_reader(sock)

        def publish() -> None:
            publisher.publish(String(data=TEXT))
            count.take(sock.recv(1 << 15))

        yield publish
        loop.add_reader(sock, connection._on_readable)  # noqa: SLF001  # as before


@asynccontextmanager
async def link_receive(count: Count, *, causes: bool = False) -> AsyncIterator[Callable[[], Any]]:
    """Read frames from a link's socket, and call a callback."""
    async with linked_pair(count, causes=causes) as (publisher, _):
        gid = publisher._endpoint.gid  # noqa: SLF001  # for its frames
        (sender,) = publisher._writers[1].routes.send_queues  # noqa: SLF001  # its end of the link
        sock = sender._sock  # noqa: SLF001  # to write past it
        payload = cdr.encode(String(data=TEXT))
        # One for each message, created before counting.
        frames = iter(
            [
                protocol.pack(protocol.Kind.DATA, 1_000 + number, 1, gid, payload)
                for number in range(2_000)
            ]
        )
        yield lambda: sock.send(next(frames))


@asynccontextmanager
async def service_call(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Call a service over a link: client and server."""
    async with linked_nodes() as (one, two):
        client = one.create_client(AddTwoInts, "add")
        response = AddTwoInts.Response(sum=3)
        two.create_service(AddTwoInts, "add", lambda _: response)
        one.create_publisher(String, "topic", SMALL)  # a match, for which they are linked
        two.create_subscription(String, "topic", count.take, SMALL)
        await client.wait_for_service()
        request = AddTwoInts.Request(a=1, b=2)

        async def call() -> None:
            await client.call(request)
            count.take()

        while not one.context.transports[1].manager.links:  # type: ignore[attr-defined]  # noqa: ASYNC110  # nothing tells
            await asyncio.sleep(0.02)
        yield call


@asynccontextmanager
async def action_goal(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Have a goal executed over a link, with five feedback messages: client and server."""
    async with linked_nodes() as (one, two):
        feedback = Fibonacci.Feedback(sequence=[0, 1, 1, 2])
        result = Fibonacci.Result(sequence=[0, 1, 1, 2])

        async def execute(goal: Any) -> Fibonacci.Result:
            for _ in range(5):
                goal.publish_feedback(feedback)
            goal.succeed()
            return result

        ActionServer(two, Fibonacci, "fibonacci", execute, max_goals=SMALL)
        client = ActionClient(one, Fibonacci, "fibonacci")
        await client.wait_for_server()
        heard = Count()

        async def send() -> None:
            goal = await client.send_goal(Fibonacci.Goal(order=5), heard.take)
            await goal.result()
            count.take()

        while not one.context.transports[1].manager.links:  # type: ignore[attr-defined]  # noqa: ASYNC110  # nothing tells
            await asyncio.sleep(0.02)
        yield send


@asynccontextmanager
async def zenoh_node() -> AsyncIterator[tuple[Node, ZenohEndpoints]]:
    """Return a node on Zenoh's endpoints without a session."""
    transport = ZenohEndpoints("ab")
    async with Context(transport=transport) as context, node_of("one", context) as node:
        yield node, transport


@asynccontextmanager
async def zenoh_publish(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Publish up to the call of Zenoh's `put`."""
    async with zenoh_node() as (node, transport):
        publisher = node.create_publisher(String, "topic", qos_profile_sensor_data)
        graph = transport.state.graph
        assert graph is not None  # noqa: S101  # open
        own = publisher._endpoint  # noqa: SLF001  # for a match
        theirs = NodeInfo("cd", 1, "other", "/")
        reader = EndpointInfo(
            EndpointKind.SUBSCRIPTION, theirs, 1, own.name, own.type_name, own.type_hash,
            own.qos, bytes(16),
        )  # fmt: skip
        graph.add_endpoint(reader)
        transport.state.tell_writers(reader, present=True)  # as the watcher does

        def publish() -> None:
            publisher.publish(String(data=TEXT))
            count.take()

        yield publish


@asynccontextmanager
async def zenoh_receive(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Take a sample from Zenoh's queue, and call a callback."""
    async with zenoh_node() as (node, transport):
        node.create_subscription(String, "topic", count.take, qos_profile_sensor_data)
        assert transport.reader is not None  # noqa: S101  # just made
        queue = transport.reader._queue  # noqa: SLF001  # where Zenoh's threads put
        payload = cdr.encode(String(data=TEXT))
        gid = bytes(range(16))
        samples = iter(
            [Sample(payload, attachment.pack(number, 1, gid)) for number in range(1, 2_001)]
        )
        yield lambda: queue.put(next(samples))  # type: ignore[arg-type]  # as far as it is used


@asynccontextmanager
async def timer_tick(count: Count) -> AsyncIterator[Callable[[], Any]]:
    """Call the callback of a timer that is due."""
    async with Context(transport="local") as context, node_of("one", context) as node:
        timer = node.create_timer(0.05, count.take)

        def until_due() -> None:
            time.sleep(max(timer.time_until_next_call() or 0, 0) / 1e9 + 0.001)

        yield until_due


CASES: Final[dict[str, Case]] = {
    "nothing": nothing,
    "bare socket": bare_socket,
    "bare asyncio.Queue": bare_queue,
    "publish to callback, in process": in_process,
    "publish, link": link_publish,
    "receive to callback, link": link_receive,
    "publish, Zenoh": zenoh_publish,
    "receive to callback, Zenoh": zenoh_receive,
    "timer tick": timer_tick,
    "service call and response, link": service_call,
    "goal with five feedback messages, link": action_goal,
    "publish to callback, in process, causes kept": partial(in_process, causes=True),
    "publish, link, causes kept": partial(link_publish, causes=True),
    "receive to callback, link, causes kept": partial(link_receive, causes=True),
}

PILE: Final = bytes(2 << 20)  # twice the simulated cache
WARM_UP: Final = 64


def empty_caches() -> None:
    """Evict everything else from the caches, as other work between messages does."""
    PILE.find(b"\x01")


async def calibrate(name: str, messages: int) -> int:
    """Run some messages of a case, with empty caches before each; return how many arrived."""
    count = Count()
    gc.disable()  # otherwise some runs have a garbage collection more than others
    async with CASES[name](count) as begin:
        for number in range(WARM_UP + messages):
            if number == WARM_UP:
                count.count = 0
            empty_caches()
            begun = begin()
            if begun is not None and asyncio.iscoroutine(begun):
                await begun
            for _ in range(TURNS):
                await asyncio.sleep(0)
        return count.count
