"""Tests of awaited transforms in nodes."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from aionode import Context, MessageInfo, Node, Time
from aionode.cli._nouns.doctor.transforms import two_broadcasters
from aionode.clock import Duration
from aionode.errors import (
    ConnectivityException,
    EntityDestroyedError,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    MessageError,
    TimeoutException,
)
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.geometry_msgs.msg import PointStamped, TransformStamped
from aionode.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from aionode.interfaces.tf2_msgs.srv import FrameGraph
from aionode.lifecycle import LifecycleNode
from aionode.logging import get_logger
from aionode.parameter import Parameter
from aionode.qos import QoSProfile
from aionode.testing import ManualClock, settle
from aionode.tf import (
    Buffer,
    BufferClient,
    BufferCore,
    BufferServer,
    StaticTransformBroadcaster,
    TransformBroadcaster,
    TransformListener,
    waiters,
)
from aionode.tf.waiters import Waiter
from tests.support.living import living
from tests.support.spies import returns_of
from tests.support.transforms import message, parts, transform


def at(seconds: float) -> Time:
    """Return a time."""
    return Time(nanoseconds=round(seconds * 1e9))


@pytest.fixture
def buffer(node: Node) -> Buffer:
    """Return a buffer whose transforms the test sets directly."""
    return Buffer(node)


def put(buffer: BufferCore, *transforms: TransformStamped) -> None:
    """Insert transforms."""
    for one in transforms:
        buffer.set_transform(one, "test")


@pytest.fixture
def logged() -> Iterator[list[str]]:
    """Return what nodes log."""
    texts: list[str] = []
    remove = get_logger("node").add_sink(lambda event: texts.append(event.msg))
    yield texts
    remove()


async def waiting(work: Any) -> asyncio.Task[Any]:
    """Return a task that has started to wait."""
    task = asyncio.get_running_loop().create_task(work)
    await settle()
    assert not task.done()
    return task


# Waiting


async def test_a_transform_that_is_there_needs_no_wait(buffer: Buffer) -> None:
    """The call returns it at once."""
    put(buffer, transform("map", "base", 1.0))
    found = await buffer.wait_for_transform("map", "base", at(1))
    assert found == buffer.lookup_transform("map", "base", at(1))
    assert buffer.can_transform("map", "base") is True


async def test_a_wait_ends_when_the_last_piece_arrives(buffer: Buffer) -> None:
    """None of the frames exists at first, and other frames do not matter."""
    task = await waiting(buffer.wait_for_transform("map", "camera", at(1.5)))
    put(buffer, transform("base", "camera", 1.0), transform("base", "camera", 2.0))
    put(buffer, transform("map", "odom", 1.5), transform("other", "x", 1.5))
    put(buffer, transform("odom", "base", 1.0))
    await settle()
    assert not task.done()
    put(buffer, transform("odom", "base", 1.6))
    assert parts(await task)[:3] == pytest.approx((3, 0, 0))


async def test_the_answer_is_that_of_the_moment(buffer: Buffer) -> None:
    """By the time the task runs, the data may be gone."""
    task = await waiting(buffer.wait_for_transform("map", "base", at(1)))
    put(buffer, transform("map", "base", 1.0), transform("map", "base", 100.0))
    put(buffer, transform("map", "base", 101.0))
    assert (await task).header.stamp.sec == 1


async def test_data_of_other_times_and_frames_wakes_nobody(
    buffer: Buffer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A hundred waiters cost nothing while a thousand transforms arrive."""
    put(buffer, *(transform("map", f"f{n}", 1.0) for n in range(50)))
    tasks = [
        await waiting(buffer.wait_for_transform("map", f"f{n % 50}", at(10 + n)))
        for n in range(100)
    ]
    asked = returns_of(monkeypatch, waiters, "problem_of")
    for stamp in range(2, 10):
        put(buffer, *(transform("map", f"f{n}", float(stamp)) for n in range(50)))
    assert asked.empty()

    put(buffer, transform("map", "f7", 17.5))
    assert asked.qsize() == 1
    assert (await tasks[7]).child_frame_id == "f7"
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


async def test_a_time_limit_says_why(node_factory: Callable[..., Node]) -> None:
    """It runs on the node's clock, and is a TimeoutError."""
    clock = ManualClock()
    async with Node("node", context=Context(transport="local", clock=clock)) as node:
        buffer = Buffer(node)
        put(buffer, transform("map", "base", 1.0), transform("map", "base", 2.0))
        late = await waiting(buffer.wait_for_transform("map", "base", at(5), timeout_sec=0.5))
        unknown = await waiting(buffer.wait_for_transform("map", "x", timeout_sec=0.5))
        await clock.advance(0.4)
        assert not late.done()
        await clock.advance(0.2)
        with pytest.raises(TimeoutException) as caught:
            await late
        assert isinstance(caught.value, TimeoutError)
        assert str(caught.value) == (
            "Timed out waiting for transform from [base] to [map] at 5.000000: Lookup would "
            "require extrapolation into the future.  Requested time 5.000000 but the latest data "
            "is at time 2.000000, when looking up transform from frame [base] to frame [map]; "
            "waited 0.5 s"
        )
        with pytest.raises(TimeoutException, match='frame "x" does not exist'):
            await unknown


async def test_a_limit_of_asyncio_shows_the_reason_as_its_cause(buffer: Buffer) -> None:
    """`asyncio.timeout` cancels, and the CancelledError has a note."""
    put(buffer, transform("map", "base", 1.0), transform("other", "x", 1.0))
    with pytest.raises(TimeoutError) as caught:
        async with asyncio.timeout(0.01):
            await buffer.wait_for_transform("map", "x", at(1))
    cause = caught.value.__cause__
    assert isinstance(cause, asyncio.CancelledError)
    assert "not part of the same tree" in cause.__notes__[0]


async def test_a_wait_for_what_has_gone_fails_at_once(buffer: Buffer) -> None:
    """A time older than all kept data can never become available."""
    put(buffer, transform("map", "base", 100.0), transform("map", "base", 101.0))
    with pytest.raises(ExtrapolationException, match="into the past"):
        await buffer.wait_for_transform("map", "base", at(1))
    task = await waiting(buffer.wait_for_transform("map", "base", at(95)))
    put(buffer, transform("map", "base", 106.0))
    with pytest.raises(ExtrapolationException, match="into the past"):
        await task


async def test_names_that_no_frame_can_have_are_refused(buffer: Buffer) -> None:
    """Waiting for them would be pointless."""
    for names in (("", "a"), ("/a", "b")):
        with pytest.raises(InvalidArgumentException):
            await buffer.wait_for_transform(*names)
        with pytest.raises(InvalidArgumentException):
            buffer.follow(*names)


async def test_two_times_are_awaited_as_well(buffer: Buffer) -> None:
    """First one of the two is missing, then the other one."""
    put(buffer, *(transform("map", "robot", t, (t, 0.0, 0.0)) for t in (1.0, 2.0)))
    wait = buffer.wait_for_transform_full("robot", at(3), "robot", at(1.5), "map")
    task = await waiting(wait)
    put(buffer, transform("map", "robot", 4.0, (4.0, 0.0, 0.0)))
    assert parts(await task)[0] == pytest.approx(-1.5)
    assert buffer.can_transform_full("robot", at(3), "robot", at(1.5), "map")
    found = buffer.lookup_transform_full("robot", at(3), "robot", at(1.5), "map")
    assert found == task.result()


async def test_the_end_of_the_node_ends_the_waits(node_factory: Callable[..., Node]) -> None:
    """Other tasks get an error, and loops end."""
    node = node_factory("node")
    async with node:
        buffer = Buffer(node)
        task = await waiting(buffer.wait_for_transform("map", "base"))
        changes = await waiting(anext(buffer.follow("map", "base"), None))
        node.destroy_node()
        with pytest.raises(EntityDestroyedError, match="transform buffer of /node"):
            await task
        assert await changes is None
    with pytest.raises(EntityDestroyedError):
        await buffer.wait_for_transform("map", "base")


# The three deadlocks of geometry2: 327, 438, 797


async def test_a_callback_that_waits_does_not_stop_the_transforms(
    node_factory: Callable[..., Node],
) -> None:
    """In tf2, a callback that waits blocks the executor that would deliver the transforms."""
    async with node_factory("sender") as sender, node_factory("node") as node:
        buffer = Buffer(node)
        found: asyncio.Future[TransformStamped] = asyncio.get_running_loop().create_future()

        async def on_point(msg: PointStamped) -> None:
            found.set_result(await buffer.wait_for_transform("map", "base", msg.header.stamp))

        node.create_subscription(PointStamped, "point", on_point, 10)
        points = sender.create_publisher(PointStamped, "point", 10)
        broadcaster = TransformBroadcaster(sender)
        points.publish(PointStamped(header=transform("base", "", 3.0).header))
        await settle()
        assert not found.done()
        broadcaster.sendTransform(transform("map", "base", 3.0))
        assert (await found).header.stamp.sec == 3


async def test_waits_in_callbacks_of_a_timer_and_of_one_topic_do_not_block_each_other(
    node_factory: Callable[..., Node],
) -> None:
    """In tf2, two waits in one callback group block each other."""
    async with node_factory("node") as node:
        buffer = Buffer(node)
        done: list[str] = []

        async def wait(name: str) -> None:
            await buffer.wait_for_transform("map", name)
            done.append(name)

        once = [False]

        async def tick() -> None:
            if not once[0]:
                once[0] = True
                await wait("a")

        node.create_timer(0.001, tick)
        task = await waiting(wait("b"))
        broadcaster = TransformBroadcaster(node)
        broadcaster.sendTransform([transform("map", "b", 1.0), transform("map", "a", 1.0)])
        await task
        async with asyncio.timeout(5):
            while len(done) < 2:
                await node.get_clock().sleep(0.001)


@pytest.mark.slow
async def test_a_wait_without_an_end_can_be_given_up(buffer: Buffer) -> None:
    """In tf2, `lookup_transform_async` has no timeout, and its future stays in the buffer."""
    waiters = living(Waiter)
    futures = living(asyncio.Future)
    for _ in range(100):
        with pytest.raises(TimeoutException):
            await buffer.wait_for_transform("map", "never", at(1), timeout_sec=1e-9)
    assert living(Waiter) <= waiters
    assert living(asyncio.Future) < futures + 10


# Following and filtering


async def test_following_yields_each_change_of_the_chain(buffer: Buffer) -> None:
    """Other frames are ignored, and a slow loop gets only the newest change."""
    futures = living(asyncio.Future)
    changes = buffer.follow("map", "camera")
    task = await waiting(anext(changes))
    put(buffer, transform("base", "camera", 1.0), transform("map", "base", 1.0))
    assert (await task).header.stamp.sec == 1
    put(buffer, transform("base", "camera", 3.0), transform("map", "base", 2.0))
    put(buffer, transform("map", "base", 3.0))
    assert (await anext(changes)).header.stamp.sec == 3
    task = await waiting(anext(changes))
    put(buffer, transform("map", "other", 9.0), transform("base", "camera", 9.0))
    await settle()
    assert not task.done()
    put(buffer, transform("map", "base", 4.0))
    assert (await task).header.stamp.sec == 4
    assert living(asyncio.Future) <= futures


def stamped_point(frame: str, seconds: float) -> PointStamped:
    """Return a point at the origin of a frame."""
    return PointStamped(header=transform(frame, "", seconds).header)


async def test_a_filter_holds_messages_until_their_transform_is_there(
    node: Node, buffer: Buffer
) -> None:
    """Each message comes with its transform, as soon as that is available."""
    subscription = node.create_subscription(PointStamped, "point", None, 10)
    points = node.create_publisher(PointStamped, "point", 10)
    filtered = buffer.filter(subscription, "map")
    task = await waiting(anext(filtered))
    for seconds in (3.0, 2.0):
        points.publish(stamped_point("base", seconds))
    await settle()
    assert filtered.waiting == 2
    put(buffer, transform("map", "base", 1.0), transform("map", "base", 2.5))
    msg, found = await task
    assert (msg.header.stamp.sec, found.header.stamp.sec) == (2, 2)
    put(buffer, transform("map", "base", 4.0))
    msg, found = await anext(filtered)
    assert (msg.header.stamp.sec, found.header.frame_id) == (3, "map")
    subscription.destroy()
    with pytest.raises(StopAsyncIteration):
        await anext(filtered)


async def test_a_filter_counts_what_it_drops_with_the_reason(
    node: Node, buffer: Buffer, logged: list[str]
) -> None:
    """Its memory is bounded, and each reason is logged once."""
    subscription = node.create_subscription(PointStamped, "point", None, 100)
    points = node.create_publisher(PointStamped, "point", 100)
    filtered = buffer.filter(subscription, "map", queue_size=2)
    task = await waiting(anext(filtered))
    put(buffer, transform("map", "base", 100.0), transform("map", "base", 101.0))
    for _ in range(2):
        points.publish(stamped_point("", 1.0))
        points.publish(stamped_point("base", 1.0))
    for seconds in (200.0, 201.0, 202.0, 203.0):
        points.publish(stamped_point("base", seconds))
    await settle()

    assert dict(filtered.dropped) == {
        "the frame id of the message is empty": 2,
        "the timestamp on the message is earlier than all the data in the transform cache": 2,
        "discarding message because the queue is full": 2,
    }
    assert sum("Message Filter dropping message" in text for text in logged) == 3
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
    with pytest.raises(ValueError, match="queue_size=0"):
        buffer.filter(subscription, "map", queue_size=0)


async def test_a_filter_that_is_left_behind_leaves_no_waiters(node: Node, buffer: Buffer) -> None:
    """A loop that ends by `break` has nothing to close."""
    waiters = living(Waiter)
    subscription = node.create_subscription(PointStamped, "point", None, 10)
    filtered = buffer.filter(subscription, "map")
    publisher = node.create_publisher(PointStamped, "point", 10)
    for frame in ("never", "map"):
        publisher.publish(stamped_point(frame, 1.0))
    await anext(filtered)
    assert filtered.waiting == 1
    del filtered
    assert living(Waiter) <= waiters


async def test_a_filter_that_is_always_ready_lets_others_run(node: Node, buffer: Buffer) -> None:
    """A loop over available messages must not stop timers."""
    subscription = node.create_subscription(PointStamped, "point", None, 5000)
    points = node.create_publisher(PointStamped, "point", 10)
    put(buffer, transform("map", "base", 1.0))
    for _ in range(3000):
        points.publish(stamped_point("base", 1.0))
    ran = [0]
    loop = asyncio.get_running_loop()

    def tick() -> None:
        ran[0] += 1
        loop.call_soon(tick)

    loop.call_soon(tick)
    filtered = buffer.filter(subscription, "map")
    for _ in range(3000):
        await anext(filtered)
    assert ran[0] > 3


# Where transforms come from


async def test_transforms_come_from_tf_and_tf_static(
    node_factory: Callable[..., Node],
) -> None:
    """A late buffer gets all static transforms; the authority is the sender's node."""
    async with node_factory("sender") as sender:
        static = StaticTransformBroadcaster(sender)
        static.sendTransform(transform("base", "camera"))
        static.sendTransform([transform("base", "lidar"), transform("base", "camera", yaw=1.0)])
        async with node_factory("node") as node:
            buffer = Buffer(node)
            await buffer.wait_for_transform("camera", "lidar")
            assert parts(buffer.lookup_transform("base", "camera"))[5] > 0.4
            TransformBroadcaster(sender).sendTransform(transform("odom", "base", 1.0))
            await buffer.wait_for_transform("odom", "camera")
            assert "broadcaster: '/sender'" in buffer.all_frames_as_yaml()


@pytest.mark.parametrize("broadcaster", [TransformBroadcaster, StaticTransformBroadcaster])
async def test_only_transforms_are_sent(broadcaster: Any, node: Node) -> None:
    """Anything else is refused, and the next transform is still sent."""
    sending = broadcaster(node)
    for other in (5, None, [transform("base", "camera"), 5]):
        with pytest.raises(MessageError, match="needs geometry_msgs/msg/TransformStamped"):
            sending.sendTransform(other)
    buffer = Buffer(node)
    sending.sendTransform(transform("base", "camera", 1.0))
    await buffer.wait_for_transform("base", "camera")


def from_publisher(gid: bytes) -> MessageInfo:
    """Return the information about a message."""
    return MessageInfo(
        source_timestamp=0,
        received_timestamp=0,
        publication_sequence_number=1,
        reception_sequence_number=1,
        publisher_gid=gid,
    )


def publisher(topic: str, gid: bytes) -> EndpointInfo:
    """Return a publisher of the node /sender, as the graph knows it."""
    node = NodeInfo("a" * 32, 0, "sender", "/")
    kind, profile = EndpointKind.PUBLISHER, QoSProfile(depth=1)
    return EndpointInfo(kind, node, 1, topic, "tf2_msgs/msg/TFMessage", "", profile, gid)


async def test_the_sender_of_static_transforms_is_named_when_the_graph_learns_of_it(
    node: Node, buffer: Buffer
) -> None:
    """Over DDS, transforms may come before the name of their node; the static ones come once."""
    gid = bytes(range(16))
    arrived = message(transform("base", "camera"), transform("base", "lidar"))
    buffer.listener.static_callback(arrived, from_publisher(gid))
    assert f"broadcaster: 'publisher {gid.hex()}'" in buffer.all_frames_as_yaml()
    node.graph.add_endpoint(publisher("/tf_static", gid))
    assert buffer.all_frames_as_yaml().count("broadcaster: '/sender'") == 2


async def test_two_publishers_of_one_node_are_one_sender_once_they_are_named(
    node: Node, buffer: Buffer, logged: list[str]
) -> None:
    """Otherwise `aionode doctor` would warn of two broadcasters, and name one node twice."""
    gids = bytes(range(16)), bytes(range(16, 32))
    camera = message(transform("base", "camera"))
    buffer.listener.static_callback(camera, from_publisher(gids[0]))
    buffer.listener.callback(camera, from_publisher(gids[1]))
    node.graph.add_endpoint(publisher("/tf_static", gids[0]))
    assert len(list(two_broadcasters(buffer))) == 1
    node.graph.add_endpoint(publisher("/tf", gids[1]))
    assert not list(two_broadcasters(buffer))
    buffer.listener.static_callback(camera, from_publisher(gids[0]))
    assert not any("TF_TWO_BROADCASTERS" in text for text in logged)


async def test_two_broadcasters_of_one_frame_are_named(
    node_factory: Callable[..., Node], logged: list[str]
) -> None:
    """The warning has the names of their nodes."""
    async with (
        node_factory("one") as one,
        node_factory("two") as two,
        node_factory("node") as node,
    ):
        buffer = Buffer(node)
        senders = [TransformBroadcaster(one), TransformBroadcaster(two)]
        for stamp in range(1, 5):
            senders[stamp % 2].sendTransform(transform("odom", "base", float(stamp)))
            await buffer.wait_for_transform("odom", "base", at(stamp))
    told = [text for text in logged if "TF_TWO_BROADCASTERS" in text]
    assert len(told) == 1
    assert 'frame "base" is sent by ' in told[0]
    assert "/one" in told[0]
    assert "/two" in told[0]


async def test_a_core_can_be_fed_from_topics_of_other_names(
    node_factory: Callable[..., Node],
) -> None:
    """/tf is global; robots of a fleet remap it into their namespaces."""
    arguments = ["--ros-args", "-r", "/tf:=tf", "-r", "/tf_static:=tf_static"]
    async with (
        node_factory("node", namespace="robot7", cli_args=arguments) as node,
        node_factory("plain") as plain,
    ):
        buffer = Buffer(node)
        TransformBroadcaster(node).sendTransform(transform("odom", "base", 1.0))
        await buffer.wait_for_transform("odom", "base")
        core = BufferCore()
        listener = TransformListener(core, plain, tf_topic="/robot7/tf")
        TransformBroadcaster(node).sendTransform(transform("odom", "base", 2.0))
        await buffer.wait_for_transform("odom", "base", at(2))
        await settle()
        assert core._frameExists("odom")
        assert listener.tf_sub.topic_name == "/robot7/tf"
        listener.unregister()
        assert listener.tf_sub.destroyed


async def test_a_managed_node_has_its_transforms_in_every_state(
    node_factory: Callable[..., Node],
) -> None:
    """Static transforms are sent once: one dropped while inactive would be missing forever."""
    async with node_factory("sender") as sender:
        StaticTransformBroadcaster(sender).sendTransform(transform("base", "camera"))
        node = LifecycleNode("managed", context=sender.context)
        async with node:
            buffer = Buffer(node)
            await buffer.wait_for_transform("base", "camera", timeout_sec=5.0)
            TransformBroadcaster(node).sendTransform(transform("odom", "base", 1.0))
            await buffer.wait_for_transform("odom", "camera", timeout_sec=5.0)


async def test_simulated_time_drives_limits_and_a_jump_back_clears(
    node_factory: Callable[..., Node], logged: list[str]
) -> None:
    """This is as in tf2; static transforms are kept."""
    use_sim_time = [Parameter("use_sim_time", value=True)]
    async with (
        node_factory("clock") as driver,
        node_factory("node", parameter_overrides=use_sim_time) as node,
    ):
        buffer = Buffer(node)
        clock = driver.create_publisher(ClockMsg, "/clock", 10)

        async def show(seconds: float) -> None:
            clock.publish(ClockMsg(clock=at(seconds).to_msg()))
            await settle()

        await show(100)
        put(buffer, transform("map", "base", 99.0))
        buffer.set_transform_static(transform("base", "camera"), "test")
        task = await waiting(buffer.wait_for_transform("map", "base", at(105), timeout_sec=10))
        await show(109)
        assert not task.done()
        await show(111)
        with pytest.raises(TimeoutException):
            await task

        task = await waiting(buffer.wait_for_transform("map", "base", at(95)))
        await show(90)
        assert not buffer.can_transform("map", "base")
        assert buffer.can_transform("base", "camera")
        assert "Detected jump back in time. Clearing tf buffer." in logged
        put(buffer, transform("map", "base", 90.0), transform("map", "base", 96.0))
        assert (await task).header.stamp.sec == 95


async def test_a_switch_of_the_time_source_sets_limits_anew(
    node_factory: Callable[..., Node],
) -> None:
    """An alarm belongs to the time source that was in use when it was set."""
    async with node_factory("node") as node:
        buffer = Buffer(node)
        task = await waiting(buffer.wait_for_transform("map", "base", timeout_sec=1000.0))
        node.get_clock().set_ros_time_active(True)
        node.get_clock().set_ros_time_override(at(5))
        await settle()
        assert not task.done()
        node.get_clock().set_ros_time_override(at(2000))
        with pytest.raises(TimeoutException):
            await task


# A server


async def test_a_server_answers_for_those_without_a_buffer(
    node_factory: Callable[..., Node],
) -> None:
    """It returns tf2's errors, also after a wait."""
    async with node_factory("server") as server, node_factory("client") as asker:
        buffer = Buffer(server)
        BufferServer(buffer, server)
        client = BufferClient(asker, timeout_padding=30.0)
        put(buffer, transform("map", "base", 1.0), transform("other", "x", 1.0))

        assert parts(await client.lookup_transform("map", "base"))[0] == 1.0
        assert await client.can_transform("map", "base", at(1))
        assert not await client.can_transform("map", "base", at(2))
        for error, question in (
            (LookupException, ("map", "nothing")),
            (ConnectivityException, ("map", "x")),
            (ExtrapolationException, ("map", "base", at(7))),
            (InvalidArgumentException, ("", "base")),
        ):
            with pytest.raises(error):
                await client.lookup_transform(*question)
        with pytest.raises(TimeoutException, match="Timed out waiting for transform"):
            await client.lookup_transform("map", "base", at(7), timeout_sec=0.01)
        task = await waiting(client.lookup_transform("map", "base", at(7), timeout_sec=60.0))
        put(buffer, transform("map", "base", 8.0, (8.0, 0.0, 0.0)))
        assert parts(await task)[0] == pytest.approx(7.0)
        full = await client.lookup_transform_full("base", at(8), "base", at(1), "map")
        assert parts(full)[0] == pytest.approx(-7.0)
        moved = await client.transform(stamped_point("base", 8.0), "map")
        assert moved.point.x == 8.0

        graph = asker.create_client(FrameGraph, "tf2_frames")
        answer = await graph.call(FrameGraph.Request())
        assert "parent: 'map'" in answer.frame_yaml


async def test_without_a_server_a_client_says_so(node: Node) -> None:
    """The error is worded as in tf2."""
    client = BufferClient(node, "nobody", timeout_padding=Duration(nanoseconds=1))
    with pytest.raises(TimeoutException, match=r"The BufferServer is not ready\."):
        await client.lookup_transform("a", "b")
