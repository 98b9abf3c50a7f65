"""How the transport handles rcl's answers, with `FakeRcl`, an rcl within this process.

The contract of transports is in ``tests/engine/transport/test_contract.py``, on this one too; here
is what only rcl does.
"""

from __future__ import annotations

import asyncio
import logging
import socket
from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.endpoints.publisher import Publisher
from aionode.endpoints.subscription import Subscription
from aionode.engine.context import Context
from aionode.engine.transport.rcl import _participants, _transport, _wake
from aionode.engine.transport.rcl._bindings import view
from aionode.errors import ServiceUnavailableError, TransportError
from aionode.graph import EndpointKind
from aionode.interfaces.std_msgs.msg import Int32, String, UInt8MultiArray
from aionode.interfaces.test_msgs.srv import BasicTypes
from aionode.node import Node
from aionode.qos import KEEP_ALL_DEPTH, DurabilityPolicy, HistoryPolicy, QoSProfile
from tests.support import fake_rcl
from tests.support.arrivals import reader_of

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from tests.support.fake_rcl import FakeRcl

KEPT = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def rcl(monkeypatch: pytest.MonkeyPatch) -> FakeRcl:
    """The rcl of this test."""
    return fake_rcl.install(monkeypatch)


class Pair:
    """Two running nodes, each in its own context."""

    def __init__(self, left: Node, right: Node) -> None:
        self.left = left
        self.right = right


@pytest.fixture
async def pair(rcl: FakeRcl) -> AsyncIterator[Pair]:
    """Two nodes that know each other."""
    async with AsyncExitStack() as stack:
        nodes = []
        for name in ("left", "right"):
            context = await stack.enter_async_context(Context(transport="rcl"))
            nodes.append(await stack.enter_async_context(Node(name, context=context)))
        await nodes[0].wait_for_node("/right")
        await nodes[1].wait_for_node("/left")
        yield Pair(*nodes)


async def until(condition: Any) -> None:
    """Wait until a condition holds for which there is no notification."""
    async with asyncio.timeout(10):
        while not condition():  # noqa: ASYNC110  # what rcl does sets no event
            await asyncio.sleep(0.005)  # noqa: TID251  # as above


# Messages


async def test_what_is_published_before_the_start_is_kept_for_the_late(rcl: FakeRcl) -> None:
    """The context joins the domain when its first node starts."""
    context = Context(transport="rcl")
    node = Node("early", context=context)
    publisher = node.create_publisher(Int32, "map", KEPT)
    for number in range(5):
        publisher.publish(Int32(data=number))
    async with (
        node,
        Context(transport="rcl") as other,
        Node("late", context=other) as late,
    ):
        reader = late.create_subscription(Int32, "map", None, KEPT)
        assert [(await reader.receive()).data for _ in range(3)] == [2, 3, 4]


async def test_a_context_opens_again_with_its_entities(rcl: FakeRcl) -> None:
    """Everything is created anew, and nothing is left over from the first time."""
    context = Context(transport="rcl")
    for _ in range(2):
        async with Node("node", context=context) as node:
            node.create_publisher(Int32, "numbers", 10)
            node.create_service(BasicTypes, "add", lambda request, response: response)
        await until(lambda: not rcl.of(fake_rcl.Entity))
    assert not rcl.of(fake_rcl.NodeHandle)


async def test_a_refused_message_is_counted_and_logged_once(
    pair: Pair, rcl: FakeRcl, caplog: pytest.LogCaptureFixture
) -> None:
    """The log line gives rcl's reason."""
    pair.right.create_subscription(Int32, "numbers")
    publisher = pair.left.create_publisher(Int32, "numbers", 10)
    await publisher.wait_for_subscribers()
    rcl.refuses = "cannot send data"
    with caplog.at_level(logging.WARNING):
        for _ in range(3):
            publisher.publish(Int32())
    assert publisher.stats.dropped == 3
    assert caplog.text.count("/numbers: a message was not sent: cannot send data") == 1


async def test_large_messages_arrive_in_order_with_the_small_ones(pair: Pair) -> None:
    """Even though a thread sends them."""
    reader = pair.right.create_subscription(UInt8MultiArray, "data", None, 10)
    publisher = pair.left.create_publisher(UInt8MultiArray, "data", 10)
    await publisher.wait_for_subscribers()
    sizes = [10, 100_000, 20, 70_000, 30]
    for size in sizes:
        publisher.publish(UInt8MultiArray(data=bytes(size)))
    assert [len((await reader.receive()).data) for _ in sizes] == sizes


@pytest.mark.slow
async def test_a_full_keep_all_subscription_leaves_messages_in_the_middleware(
    pair: Pair, rcl: FakeRcl
) -> None:
    """It takes them as soon as there is room, so none is lost."""
    profile = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    reader = pair.right.create_subscription(Int32, "numbers", None, profile)
    publisher = pair.left.create_publisher(Int32, "numbers", profile)
    await publisher.wait_for_subscribers()
    count = KEEP_ALL_DEPTH + 100
    for number in range(count):
        publisher.publish(Int32(data=number))
        if number % 1000 == 0:
            await publisher.drain()
    (handle,) = [
        one
        for one in rcl.of(fake_rcl.SubscriptionHandle)
        if (one.name, one.node.name) == ("/numbers", "right")
    ]
    await until(lambda: len(handle.queue) and not reader_of(reader).has_room())
    assert [(await reader.receive()).data for _ in range(count)] == list(range(count))


async def matched(pair: Pair) -> tuple[Publisher[Int32], Subscription[Int32]]:
    """Return a publisher, and a subscription in the other context that it has matched."""
    reader = pair.right.create_subscription(Int32, "numbers", None, 10)
    publisher = pair.left.create_publisher(Int32, "numbers", 10)
    await publisher.wait_for_subscribers()
    return publisher, reader


async def three_arrive(publisher: Publisher[Int32], reader: Subscription[Int32]) -> None:
    """Publish three messages at once, and assert that all arrive in order."""
    for number in range(3):
        publisher.publish(Int32(data=number))
    assert [(await reader.receive()).data for _ in range(3)] == [0, 1, 2]


async def test_messages_without_numbers_are_not_taken_for_lost(pair: Pair, rcl: FakeRcl) -> None:
    """Messages of Cyclone DDS have none."""
    rcl.numbers = False
    publisher, reader = await matched(pair)
    await three_arrive(publisher, reader)
    assert reader.stats.lost == 0


@pytest.mark.parametrize("slice_ns", [10**9, 0], ids=["in one slice", "in a slice each"])
async def test_no_message_is_asked_for_in_vain(
    pair: Pair, rcl: FakeRcl, monkeypatch: pytest.MonkeyPatch, slice_ns: int
) -> None:
    """It would wait for the middleware's lock, held while the next message is received."""
    monkeypatch.setattr(_wake, "SLICE_NS", slice_ns)
    publisher, reader = await matched(pair)
    await until(lambda: rcl.takes)  # # messages that came before the callback was set
    before = rcl.takes
    await three_arrive(publisher, reader)
    publisher.publish(Int32(data=3))
    assert (await reader.receive()).data == 3
    for _ in range(8):  # # one of these turns would take
        await checkpoint()
    assert rcl.takes - before == 4


async def test_a_middleware_may_tell_of_several_messages_once(pair: Pair, rcl: FakeRcl) -> None:
    """All of them are taken."""
    rcl.is_fast_dds = False
    publisher, reader = await matched(pair)
    await three_arrive(publisher, reader)


async def test_a_subscription_that_the_graph_does_not_show_yet_gets_messages(
    pair: Pair, rcl: FakeRcl
) -> None:
    """The middleware knows it first, and the answer to its first message must not be lost."""
    publisher = pair.left.create_publisher(Int32, "numbers", 10)
    rcl.hides_changes = True
    reader = pair.right.create_subscription(Int32, "numbers", None, 10)
    publisher.publish(Int32(data=1))
    assert (await reader.receive()).data == 1


async def test_nothing_is_sent_for_subscriptions_of_this_context(pair: Pair, rcl: FakeRcl) -> None:
    """They get the messages as objects, although the middleware counts them."""
    reader = pair.left.create_subscription(Int32, "numbers", None, 10)
    publisher = pair.left.create_publisher(Int32, "numbers", 10)
    before = rcl.published
    publisher.publish(Int32(data=1))
    assert (await reader.receive()).data == 1
    assert rcl.published == before


async def test_bytes_in_no_known_form_are_counted(pair: Pair, rcl: FakeRcl) -> None:
    """The messages after it still arrive."""
    reader = pair.right.create_subscription(String, "text", None, 10)
    publisher = pair.left.create_publisher(String, "text", 10)
    await publisher.wait_for_subscribers()
    (handle,) = [one for one in rcl.of(fake_rcl.PublisherHandle) if one.name == "/text"]
    broken = b"\x00\x01\x00\x00\xff\xff\xff\x7f"
    rcl.publish(handle.pointer, fake_rcl.Reference(view(broken)), None)
    publisher.publish(String(data="good"))
    assert (await reader.receive()).data == "good"
    assert reader.stats.errors == 1
    assert pair.right.context.transports[1].malformed == {"/text": 1}  # type: ignore[attr-defined]


# Services


async def test_a_server_that_goes_ends_the_calls(pair: Pair) -> None:
    """As soon as the graph shows it, because the other end gets no other notification."""

    async def never(request: Any, response: Any) -> Any:
        await asyncio.Event().wait()

    server = pair.right.create_service(BasicTypes, "slow", never)
    client = pair.left.create_client(BasicTypes, "slow")
    await client.wait_for_service()

    async def call() -> None:
        with pytest.raises(ServiceUnavailableError):
            await client.call(BasicTypes.Request())

    async with asyncio.timeout(10), asyncio.TaskGroup() as tasks:
        tasks.create_task(call())
        await until(lambda: server.stats.received)
        server.destroy()


async def test_a_request_that_rcl_refuses_ends_its_call(pair: Pair, rcl: FakeRcl) -> None:
    """It was never sent."""
    pair.right.create_service(BasicTypes, "add", lambda request, response: response)
    client = pair.left.create_client(BasicTypes, "add")
    await client.wait_for_service()
    rcl.refuses = "cannot send data"
    with pytest.raises(ServiceUnavailableError):
        await client.call(BasicTypes.Request())


async def test_a_handler_that_fails_warns_once(
    pair: Pair, caplog: pytest.LogCaptureFixture
) -> None:
    """Its clients keep waiting, because a ROS 2 service cannot return an error."""

    def fail(request: Any, response: Any) -> Any:
        raise ValueError("no")

    server = pair.right.create_service(BasicTypes, "fail", fail)
    client = pair.left.create_client(BasicTypes, "fail")
    await client.wait_for_service()
    async with asyncio.TaskGroup() as tasks:
        calls = [tasks.create_task(client.call(BasicTypes.Request())) for _ in range(2)]
        await until(lambda: server.stats.errors == 2)
        for call in calls:
            call.cancel()
    assert caplog.text.count("/fail: a request failed, and its client waits forever") == 1


# Graph


async def test_an_answer_with_a_part_missing_is_asked_for_again(pair: Pair, rcl: FakeRcl) -> None:
    """DDS may announce a node before it announces its services."""
    rcl.silent = 3
    pair.right.create_service(BasicTypes, "add", lambda request, response: response)
    client = pair.left.create_client(BasicTypes, "add")
    async with asyncio.timeout(10):
        await client.wait_for_service()
    assert rcl.silent == 0


async def test_tools_wait_for_what_is_missing(pair: Pair, rcl: FakeRcl) -> None:
    """Otherwise a command would report that there is no such service."""
    rcl.silent = 3
    pair.right.create_service(BasicTypes, "add", lambda request, response: response)
    await until(lambda: rcl.silent < 3)
    assert await pair.left.context.transports[1].all_known(0.2)
    assert pair.left.graph.count(EndpointKind.SERVER, "/add")


async def test_tools_wait_for_processes_of_this_host_that_are_not_known(
    pair: Pair, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Fast DDS reports them when they next announce themselves."""
    counts = iter((3, 3, 2, 2))
    monkeypatch.setattr(_participants, "count_on_this_host", lambda _: next(counts))
    monkeypatch.setattr(_transport, "LACKING_QUIETS", 1000)
    assert await pair.left.context.transports[1].all_known(0.2)
    assert not list(counts)


async def test_tools_wait_no_longer_than_it_takes_until_all_are_announced(
    pair: Pair, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A frozen process has a port as well; in that case the command warns."""
    monkeypatch.setattr(_participants, "count_on_this_host", lambda _: 3)
    monkeypatch.setattr(_transport, "MAX_QUIETS", 1000)
    async with asyncio.timeout(10):
        assert not await pair.left.context.transports[1].all_known(0.2)


async def test_tools_know_processes_that_are_no_nodes_by_their_endpoints(
    pair: Pair, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Programs of plain DDS publish nothing on the discovery topic of ROS 2."""
    monkeypatch.setattr(_participants, "DISCOVERY_TOPIC", "unused")
    monkeypatch.setattr(_participants, "count_on_this_host", lambda _: 2)
    assert await pair.left.context.transports[1].all_known(0.2)


def test_participants_of_this_host_are_counted_by_their_ports(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Only the discovery ports; the port after each is for messages."""
    monkeypatch.setattr(_participants, "PARTICIPANTS", 1)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
        bound.bind(("127.0.0.1", 0))
        port = bound.getsockname()[1]
        monkeypatch.setattr(_participants, "FIRST_PORT", port - _participants.DOMAIN_PORTS)
        assert _participants.count_on_this_host(1) == 1
    assert _participants.count_on_this_host(1) == 0


async def test_nodes_of_one_name_are_told_apart(pair: Pair) -> None:
    """By a number, because rcl gives no id."""
    async with (
        Context(transport="rcl") as context,
        Node("right", context=context) as twin,
    ):
        await twin.wait_for_node("/left")
        await until(lambda: pair.left.get_node_names().count("right") == 2)
    await until(lambda: pair.left.get_node_names().count("right") == 1)


async def test_an_entity_that_rcl_refuses_is_named(
    pair: Pair, rcl: FakeRcl, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error has rcl's reason, and the node stays alive."""

    def refuse(*arguments: object) -> None:
        raise RuntimeError("out of ports")

    monkeypatch.setattr(rcl.module, "Publisher", refuse)
    with pytest.raises(TransportError, match="publisher of /numbers: rcl refuses it: out of ports"):
        pair.left.create_publisher(Int32, "numbers", 10)
    pair.left.create_subscription(Int32, "numbers")
