"""One suite for all transports: a node behaves alike in this process and in another.

`left` and `right` are two running nodes. With ``local`` they share a context; with ``zenoh``,
``link`` and ``rcl`` each has its own, as in two processes. ``rcl`` needs an installed ROS 2,
differs in what `OVER_RCL` lists, and has only the types that are on PyPI. ``fake_rcl`` is the same
without a ROS 2.
"""

from __future__ import annotations

import asyncio
from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest

from aionode.endpoints.service_introspection import ServiceIntrospectionState
from aionode.engine.context import Context
from aionode.engine.transport.rcl import RclTransport
from aionode.engine.wire import cdr
from aionode.errors import MessageError, ServiceError, ServiceUnavailableError
from aionode.interfaces.sensor_msgs.msg import Image, JointState
from aionode.interfaces.std_msgs.msg import Int8, Int32
from aionode.interfaces.test_msgs.srv import BasicTypes
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.parameter_client import AsyncParameterClient
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tests.support import fake_rcl
from tests.support.arrivals import direct_subscription, reader_of
from tests.support.peers import contexts_over, two_contexts
from tests.support.ros import gids_of_a_client, ros_domain, ros_missing
from tests.support.waiting import until
from tests.support.without_ros import without_ros

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.endpoints.core.subscription_reader import Parts

Request = BasicTypes.Request
Response = BasicTypes.Response


class Pair(NamedTuple):
    """Two running nodes, and a way to create a third beside the right one."""

    left: Node
    right: Node
    beside_right: Context


OVER_RCL = {
    "test_a_failing_handler_answers_with_its_error": "a service of ROS 2 carries no error",
    "test_so_many_bytes_wait_for_a_service": "as above",
    "test_both_sides_see_the_same_graph": "DDS discovery does not tell history and depth",
}
"""The tests of features that a middleware under rcl lacks, with the reasons."""


@pytest.fixture(params=["local", "zenoh", "link", "rcl", "fake_rcl"])
async def pair(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[Pair]:
    """Two nodes that know each other."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    async with AsyncExitStack() as stack, asyncio.timeout(30):
        if request.param in {"rcl", "fake_rcl"}:
            why_not = OVER_RCL.get(request.function.__name__)
            if request.param == "fake_rcl":
                fake_rcl.install(monkeypatch)
            else:
                stack.enter_context(without_ros())  # another test may have installed aionode's
                why_not = why_not or ros_missing(*getattr(request.module, "ROS_PACKAGES", ()))
            if why_not:
                pytest.skip(why_not)
            over = two_contexts(transport="rcl", domain_id=ros_domain())
        else:
            over = contexts_over(request.param)
        contexts = await stack.enter_async_context(over)
        left = await stack.enter_async_context(Node("left", context=contexts[0]))
        right = await stack.enter_async_context(Node("right", context=contexts[1]))
        await left.wait_for_node("/right")
        await right.wait_for_node("/left")
        yield Pair(left, right, contexts[1])


def numbers(reader: Any, count: int) -> Any:
    """Return a coroutine that receives so many numbers."""

    async def take() -> list[int]:
        return [(await reader.receive()).data for _ in range(count)]

    return take()


def add(request: Request, response: Response) -> Response:
    """Respond like the tutorial's server."""
    response.int64_value = request.int64_value + request.int32_value
    return response


# Topics


async def test_messages_arrive_in_order_and_once(pair: Pair) -> None:
    """Whatever route they take."""
    reader = pair.right.create_subscription(Int32, "numbers", None, 100)
    writer = pair.left.create_publisher(Int32, "numbers", 100)
    await writer.wait_for_subscribers()
    for number in range(100):
        writer.publish(Int32(data=number))
    assert await numbers(reader, 100) == list(range(100))
    assert (reader.stats.received, reader.stats.dropped, reader.stats.lost) == (100, 0, 0)


async def test_service_events_arrive_from_both_sides(pair: Pair) -> None:
    """Both of the client and of the server, with their contents and one gid."""
    server = pair.right.create_service(BasicTypes, "add", add)
    client = pair.left.create_client(BasicTypes, "add")
    for endpoint, node in ((server, pair.right), (client, pair.left)):
        endpoint.configure_introspection(node.get_clock(), 10, ServiceIntrospectionState.CONTENTS)
    reader = pair.left.create_subscription(BasicTypes.Event, "add/_service_event")
    await client.wait_for_service()
    while reader.get_publisher_count() < 2:
        await pair.left.graph.changed()
    (events_of_server,) = [
        each for each in pair.right.publishers if each.topic_name == reader.topic_name
    ]
    await events_of_server.wait_for_subscribers()

    await client.call(Request(int64_value=2, int32_value=3))
    events = [await reader.receive() for _ in range(4)]

    assert sorted(int(event.info.event_type) for event in events) == [0, 1, 2, 3]
    gids = {bytes(event.info.client_gid) for event in events}
    over_rcl = isinstance(pair.left.context.transports[-1], RclTransport)
    assert len(gids) <= (gids_of_a_client() if over_rcl else 1)
    assert [event.request[0].int32_value for event in events if len(event.request)] == [3, 3]
    assert [event.response[0].int64_value for event in events if len(event.response)] == [5, 5]


async def test_readers_on_both_sides_hear_each_message_once(pair: Pair) -> None:
    """Including readers in the publisher's own process."""
    readers = [node.create_subscription(Int32, "numbers", None, 10) for node in pair[:2]]
    writer = pair.left.create_publisher(Int32, "numbers", 10)
    await writer.wait_for_subscribers(2)
    for number in range(3):
        writer.publish(Int32(data=number))
    for reader in readers:
        assert await numbers(reader, 3) == [0, 1, 2]
        assert reader.stats.received == 3


async def test_callbacks_get_what_readers_get(pair: Pair) -> None:
    """The message and its info."""
    heard: list[tuple[Int32, Any]] = []
    came = asyncio.Event()

    def callback(msg: Int32, info: Any) -> None:
        heard.append((msg, info))
        came.set()

    pair.right.create_subscription(Int32, "numbers", callback)
    writer = pair.left.create_publisher(Int32, "numbers", 10)
    await writer.wait_for_subscribers()
    writer.publish(Int32(data=7))
    await came.wait()
    ((msg, info),) = heard
    assert msg == Int32(data=7)
    assert info["publication_sequence_number"] == 1
    assert info["received_timestamp"] >= info["source_timestamp"] > 0
    (publisher,) = pair.left.get_publishers_info_by_topic("numbers")
    assert list(info["publisher_gid"]) == publisher.endpoint_gid


async def test_arrays_arrive_read_only_and_whole(pair: Pair) -> None:
    """Large ones, small ones and empty ones."""
    reader = pair.right.create_subscription(JointState, "joints")
    images = pair.right.create_subscription(Image, "image")
    joints = pair.left.create_publisher(JointState, "joints", 10)
    pixels = pair.left.create_publisher(Image, "image", 10)
    await joints.wait_for_subscribers()
    await pixels.wait_for_subscribers()
    joints.publish(JointState(name=["a", "b"], position=[1.0, 2.0]))
    data = bytes(range(256)) * 4096
    pixels.publish(Image(height=1024, width=1024, data=data))

    state = await reader.receive()
    assert isinstance(state.position, np.ndarray)
    assert not state.position.flags.writeable
    assert (state.name, list(state.position), len(state.velocity)) == (["a", "b"], [1.0, 2.0], 0)
    assert bytes((await images.receive()).data) == data


async def test_a_late_reader_of_a_kept_topic_gets_the_last_ones_once(pair: Pair) -> None:
    """In order, before new ones; a volatile reader gets none of them."""
    profile = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    writer = pair.left.create_publisher(Int32, "map", profile)
    for number in range(4):
        writer.publish(Int32(data=number))
    await writer.drain()  # # a thread stores them where late readers find them
    late = pair.right.create_subscription(Int32, "map", None, profile)
    volatile = pair.right.create_subscription(Int32, "map", None, 10)
    assert await numbers(late, 2) == [2, 3]
    await writer.wait_for_subscribers(2)
    writer.publish(Int32(data=4))
    assert await numbers(late, 1) == [4]
    assert await numbers(volatile, 1) == [4]


async def test_raw_readers_get_the_bytes(pair: Pair) -> None:
    """They get the same bytes, whichever way they come."""
    reader = pair.right.create_subscription(Int32, "numbers", raw=True)
    writer = pair.left.create_publisher(Int32, "numbers", 10)
    await writer.wait_for_subscribers()
    writer.publish(Int32(data=5))
    assert bytes(await reader.receive()) == cdr.encode(Int32(data=5))


async def test_direct_subscriptions_get_the_bytes_and_times_of_every_message(pair: Pair) -> None:
    """Recorders take them as they arrive, and miss none."""
    taken: list[tuple[bytes, int]] = []
    times: list[int] = []

    def take(raw: Parts, sequence: int, source_ns: int, received_ns: int) -> None:
        assert not isinstance(raw, list)
        taken.append((bytes(raw), sequence))
        times.extend((source_ns, received_ns))

    reader = direct_subscription(pair.right, Int32, "numbers", take, QoSProfile(depth=10))
    writer = pair.left.create_publisher(Int32, "numbers", 10)
    await writer.wait_for_subscribers()
    for number in range(5):
        writer.publish(Int32(data=number))
    await until(lambda: len(taken) == 5)
    assert [raw for raw, _ in taken] == [cdr.encode(Int32(data=number)) for number in range(5)]
    assert [sequence for _, sequence in taken] == [1, 2, 3, 4, 5]
    assert min(times) > 0
    assert reader.stats.lost == 0


async def test_a_value_that_does_not_fit_is_refused_by_publish(pair: Pair) -> None:
    """No subscription gets it, and the next message arrives."""
    reader = pair.right.create_subscription(Int8, "numbers")
    writer = pair.left.create_publisher(Int8, "numbers", 10)
    await writer.wait_for_subscribers()
    with pytest.raises(MessageError, match=r"std_msgs/msg/Int8\.data"):
        writer.publish(Int8(data=300))
    writer.publish(Int8(data=3))
    assert await numbers(reader, 1) == [3]


async def test_nothing_is_lost_with_keep_all_and_drain(pair: Pair) -> None:
    """Nothing is lost if the publisher waits for room."""
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    reader = pair.right.create_subscription(Int32, "numbers", None, keep_all)
    writer = pair.left.create_publisher(Int32, "numbers", keep_all)
    await writer.wait_for_subscribers()
    for number in range(2000):
        writer.publish(Int32(data=number))
        if number % 500 == 0:
            await writer.drain()
    await writer.drain()
    assert await numbers(reader, 2000) == list(range(2000))


async def test_a_destroyed_publisher_leaves_the_graph_of_the_other_side(pair: Pair) -> None:
    """The counts change with it."""
    reader = pair.right.create_subscription(Int32, "numbers")
    writer = pair.left.create_publisher(Int32, "numbers", 10)
    while reader.get_publisher_count() != 1:
        await pair.right.graph.changed()
    writer.destroy()
    while reader.get_publisher_count() != 0:
        await pair.right.graph.changed()
    assert pair.right.count_publishers("numbers") == 0


# Services


async def test_a_call_returns_the_response(pair: Pair) -> None:
    """Between any two nodes."""
    pair.right.create_service(BasicTypes, "add", add)
    client = pair.left.create_client(BasicTypes, "add")
    await client.wait_for_service()
    assert (await client.call(Request(int64_value=2, int32_value=3))).int64_value == 5


async def test_many_calls_at_once_are_told_apart(pair: Pair) -> None:
    """They are answered out of order."""
    gate = asyncio.Event()

    async def handler(request: Request) -> Response:
        if request.int64_value % 2:
            await gate.wait()
        return Response(int64_value=request.int64_value)

    pair.right.create_service(BasicTypes, "add", handler, concurrent=True)
    client = pair.left.create_client(BasicTypes, "add")
    await client.wait_for_service()
    async with asyncio.TaskGroup() as tasks:
        calls = [tasks.create_task(client.call(Request(int64_value=n))) for n in range(30)]
        await asyncio.wait(calls[::2])
        gate.set()
    assert [call.result().int64_value for call in calls] == list(range(30))


async def test_a_failing_handler_answers_with_its_error(pair: Pair) -> None:
    """The error's type and text cross the network."""

    def handler(request: Request) -> Response:
        raise ValueError(f"cannot add {request.int64_value}")

    pair.right.create_service(BasicTypes, "add", handler, on_error="log")
    client = pair.left.create_client(BasicTypes, "add")
    await client.wait_for_service()
    with pytest.raises(ServiceError, match="/add: ValueError: cannot add 7") as caught:
        await client.call(Request(int64_value=7))
    assert (caught.value.error_type, caught.value.error_text) == ("ValueError", "cannot add 7")


async def test_a_server_that_goes_away_ends_the_call(pair: Pair) -> None:
    """The call ends at once, with an error that gives the reason."""
    began = asyncio.Event()

    async def handler(request: Request) -> Response:
        began.set()
        await asyncio.Event().wait()
        return Response()

    client = pair.left.create_client(BasicTypes, "add")
    async with Node("third", context=pair.beside_right) as third:
        third.create_service(BasicTypes, "add", handler)
        await client.wait_for_service()
        call = asyncio.get_running_loop().create_task(client.call(Request()))
        await began.wait()
    with pytest.raises(ServiceUnavailableError):
        await call
    while client.service_is_ready():
        await pair.left.graph.changed()


async def test_a_cancelled_call_does_not_disturb_the_next(pair: Pair) -> None:
    """Its late response is discarded."""
    began = asyncio.Event()
    gate = asyncio.Event()

    async def handler(request: Request) -> Response:
        began.set()
        if request.int64_value == 1:
            await gate.wait()
        return Response(int64_value=request.int64_value)

    pair.right.create_service(BasicTypes, "add", handler, concurrent=True)
    client = pair.left.create_client(BasicTypes, "add")
    await client.wait_for_service()
    call = asyncio.get_running_loop().create_task(client.call(Request(int64_value=1)))
    await began.wait()
    call.cancel()
    with pytest.raises(asyncio.CancelledError):
        await call
    gate.set()
    assert (await client.call(Request(int64_value=2))).int64_value == 2


async def test_parameters_of_the_other_side_can_be_set(pair: Pair) -> None:
    """By six services with real types."""
    pair.right.declare_parameter("speed", 1.0)
    client = AsyncParameterClient(pair.left, "/right")
    await client.wait_for_services()
    (result,) = await client.set_parameters([Parameter("speed", value=2.0)])
    assert result.successful
    assert pair.right.get_parameter("speed").value == 2.0


# Graph


async def test_both_sides_see_the_same_graph(pair: Pair) -> None:
    """Names, types, hashes, profiles and ids."""
    pair.left.create_publisher(Int32, "/numbers", QoSProfile(depth=3))
    while not pair.right.count_publishers("/numbers"):
        await pair.right.graph.changed()
    assert pair.right.get_publishers_info_by_topic(
        "/numbers"
    ) == pair.left.get_publishers_info_by_topic("/numbers")
    assert sorted(pair.right.get_node_names()) == sorted(pair.left.get_node_names())


@pytest.fixture
def small_queues(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limit each queue to 1 MB."""
    monkeypatch.setenv("AIONODE_QUEUE_BYTES", "1000000")


@pytest.mark.usefixtures("small_queues")
async def test_so_many_bytes_wait_in_a_subscription_whatever_its_depth(pair: Pair) -> None:
    """The oldest are dropped and counted; a message larger than the limit gets through."""
    late = pair.right.create_subscription(Image, "images", None, 1000)
    writer = pair.left.create_publisher(Image, "images", 1000)
    await writer.wait_for_subscribers()
    for number in range(40):
        writer.publish(Image(width=number, data=bytes(100_000)))
        await until(lambda: reader_of(late).items and reader_of(late).items[-1][1].width == number)  # noqa: B023  # called at once
    kept = [(await late.receive()).width for _ in range(len(reader_of(late)))]

    assert kept == list(range(40 - len(kept), 40))
    assert 8 <= len(kept) <= 20
    assert late.stats.dropped == 40 - len(kept)

    writer.publish(Image(width=40, data=bytes(3_000_000)))
    assert (await late.receive()).width == 40


@pytest.mark.usefixtures("small_queues")
async def test_so_many_bytes_wait_for_a_service(pair: Pair) -> None:
    """One more is refused at once, so that its client does not wait in vain."""
    opened = asyncio.Event()

    async def wait(request: Request) -> Response:
        await opened.wait()
        return Response(int32_value=request.int32_value)

    service = pair.right.create_service(BasicTypes, "wait", wait)
    client = pair.left.create_client(BasicTypes, "wait")
    await client.wait_for_service()
    text = "x" * 100_000
    calls = [
        client.call_async(Request(int32_value=number, string_value=text)) for number in range(30)
    ]
    await until(lambda: sum(each.done() for each in calls) + len(service._message_queue) == 29)
    opened.set()
    answers = await asyncio.gather(*calls, return_exceptions=True)

    refused = [each for each in answers if isinstance(each, ServiceError)]
    assert 8 <= len(answers) - len(refused) <= 12
    assert "as many bytes as may wait (AIONODE_QUEUE_BYTES)" in str(refused[0])
