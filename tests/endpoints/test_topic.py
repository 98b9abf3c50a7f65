"""Publishers and subscriptions: what arrives, in which order, and what is dropped."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from aionode.clock import Duration
from aionode.engine.context import Context
from aionode.engine.transport.local import LocalTransport
from aionode.engine.wire import cdr
from aionode.errors import (
    CallbackSignatureError,
    DecodeError,
    EntityDestroyedError,
    InvalidTopicNameException,
    MessageError,
    QueueFullError,
)
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import (
    Float64MultiArray,
    Int8,
    Int32,
    String,
    UInt8MultiArray,
)
from aionode.message import Message, int32
from aionode.node import Node
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from aionode.testing import FaultyTransport, settle
from tests.support.arrivals import direct_subscription, gid_of, reader_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.endpoints.core.subscription_reader import Parts
    from aionode.endpoints.subscription import MessageInfo

KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1)
BEST_EFFORT_KEEP_ALL = QoSProfile(
    history=HistoryPolicy.KEEP_ALL, depth=1, reliability=ReliabilityPolicy.BEST_EFFORT
)


def kept(depth: int) -> QoSProfile:
    """Return a profile that keeps messages for late readers."""
    return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def fill(publisher: Any, *texts: str) -> None:
    """Publish each text."""
    for text in texts:
        publisher.publish(String(data=text))


# Delivery


async def test_a_callback_gets_each_message_in_order(node: Node) -> None:
    """The basic promise of a topic."""
    heard: list[str] = []
    node.create_subscription(String, "words", lambda msg: heard.append(msg.data))
    fill(node.create_publisher(String, "words", 10), "a", "b", "c")
    await settle()
    assert heard == ["a", "b", "c"]


async def test_a_subscription_without_callback_is_an_async_iterator(node: Node) -> None:
    """Every asyncio library offers this, but rclpy does not."""
    reader = node.create_subscription(String, "words")
    fill(node.create_publisher(String, "words", 10), "a", "b")
    reader.destroy()
    assert [msg.data async for msg in reader] == ["a", "b"]


async def test_receive_takes_one_message(node: Node) -> None:
    """For programs that want the next message and no loop."""
    reader = node.create_subscription(String, "words")
    fill(node.create_publisher(String, "words", 10), "a", "b")
    assert (await reader.receive()).data == "a"
    assert (await reader.receive()).data == "b"


async def test_receive_on_a_destroyed_and_empty_subscription_is_an_error(node: Node) -> None:
    """It would wait forever."""
    reader = node.create_subscription(String, "words")
    reader.destroy()
    with pytest.raises(EntityDestroyedError, match="subscription of /words"):
        await reader.receive()


async def test_destroying_a_subscription_ends_a_waiting_iteration(node: Node) -> None:
    """The loop that reads ends by itself when its node does."""
    reader = node.create_subscription(String, "words")

    async def read() -> list[str]:
        return [msg.data async for msg in reader]

    async with asyncio.TaskGroup() as tasks:
        reading = tasks.create_task(read())
        await settle()
        reader.destroy()
    assert reading.result() == []


async def test_cancelling_a_reader_loses_nothing(node: Node) -> None:
    """A timeout around `receive` may strike at any moment."""
    reader = node.create_subscription(String, "words")
    publisher = node.create_publisher(String, "words", 10)
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0):
            await reader.receive()
    fill(publisher, "kept")
    assert (await reader.receive()).data == "kept"


async def test_each_message_goes_to_one_of_several_readers(node: Node) -> None:
    """Several tasks that read one subscription share the work."""
    reader = node.create_subscription(String, "words")
    async with asyncio.TaskGroup() as tasks:
        reads = [tasks.create_task(reader.receive()) for _ in range(3)]
        await settle()
        fill(node.create_publisher(String, "words", 10), "a", "b", "c")
    assert sorted(read.result().data for read in reads) == ["a", "b", "c"]


async def test_reading_a_subscription_that_has_a_callback_is_refused(node: Node) -> None:
    """Both would take messages from each other."""
    subscription = node.create_subscription(String, "words", lambda msg: None)
    with pytest.raises(RuntimeError, match="its callback gets the messages"):
        await subscription.receive()


async def test_a_callback_with_two_parameters_gets_the_message_info(node: Node) -> None:
    """With rclpy's keys; times from the context's clock."""
    heard: list[MessageInfo] = []
    node.create_subscription(String, "words", lambda msg, info: heard.append(info))
    publisher = node.create_publisher(String, "words", 10)
    fill(publisher, "a", "b")
    await settle()
    assert [info["publication_sequence_number"] for info in heard] == [1, 2]
    assert [info["reception_sequence_number"] for info in heard] == [1, 2]
    assert heard[0]["received_timestamp"] >= heard[0]["source_timestamp"] > 0


async def test_times_of_a_message_come_from_the_clock_of_the_context(
    node: Node, manual_clock: Any
) -> None:
    """A test can compare them."""
    heard: list[MessageInfo] = []
    node.create_subscription(String, "words", lambda msg, info: heard.append(info))
    await manual_clock.advance(2.5)
    fill(node.create_publisher(String, "words", 10), "a")
    await settle()
    assert heard[0]["source_timestamp"] == heard[0]["received_timestamp"] == 2_500_000_000


async def test_a_publisher_may_change_its_message_at_once(node: Node) -> None:
    """Readers have a snapshot of what was published, arrays included."""
    reader = node.create_subscription(Float64MultiArray, "numbers")
    publisher = node.create_publisher(Float64MultiArray, "numbers", 10)
    msg = Float64MultiArray(data=np.zeros(3))
    publisher.publish(msg)
    msg.data[0] = 9.0
    assert list((await reader.receive()).data) == [0.0, 0.0, 0.0]


async def test_readers_of_one_process_share_one_snapshot(node: Node) -> None:
    """One copy per publish, however many listen."""
    readers = [node.create_subscription(Float64MultiArray, "numbers") for _ in range(2)]
    node.create_publisher(Float64MultiArray, "numbers", 10).publish(
        Float64MultiArray(data=np.zeros(3))
    )
    first, second = [await reader.receive() for reader in readers]
    assert first is second


async def test_read_only_arrays_travel_without_a_copy(node: Node) -> None:
    """Pixels are not copied between nodes of one process."""
    reader = node.create_subscription(Float64MultiArray, "numbers")
    pixels = np.zeros(1000)
    pixels.flags.writeable = False
    node.create_publisher(Float64MultiArray, "numbers", 10).publish(Float64MultiArray(data=pixels))
    assert np.shares_memory((await reader.receive()).data, pixels)


async def test_what_a_raw_subscription_received_can_be_published(node: Node) -> None:
    """A relay need not know the content of a message, or its class."""
    raw = node.create_subscription(String, "in", raw=True)
    reader = node.create_subscription(String, "out")
    relay = node.create_publisher(String, "out", 10)
    fill(node.create_publisher(String, "in", 10), "a")
    relay.publish(await raw.receive())
    assert await reader.receive() == String(data="a")


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview])
async def test_bytes_that_are_no_message_are_refused(node: Node, kind: type[bytes]) -> None:
    """The error comes where the mistake is made, with the field and the offset."""
    publisher = node.create_publisher(String, "words", 10)
    with pytest.raises(DecodeError, match="std_msgs/msg/String"):
        publisher.publish(kind(b"\0\1\0\0\xff"))
    assert publisher.stats.published == 0


async def test_raw_subscriptions_get_cdr_bytes_in_process_too(node: Node) -> None:
    """A recorder does not care where a message comes from."""
    reader = node.create_subscription(String, "words", raw=True)
    fill(node.create_publisher(String, "words", 10), "a")
    assert await reader.receive() == cdr.encode(String(data="a"))


async def test_a_direct_subscription_takes_messages_within_publish_until_it_is_destroyed(
    node: Node,
) -> None:
    """A recorder stores them elsewhere at once: no queue, no task and no loop is involved."""
    taken: list[tuple[bytes, int]] = []
    subscription = direct_subscription(
        node,
        String,
        "words",
        lambda raw, sequence, *_: taken.append((raw, sequence)),
        QoSProfile(depth=1),
    )
    publisher = node.create_publisher(String, "words", 10)
    fill(publisher, "a", "b")
    assert taken == [(cdr.encode(String(data=text)), at) for at, text in ((1, "a"), (2, "b"))]
    with pytest.raises(RuntimeError, match="its callback gets the messages"):
        await subscription.receive()
    subscription.destroy()
    fill(publisher, "c")
    assert len(taken) == 2
    assert (subscription.stats.received, subscription.stats.dropped) == (2, 0)


async def test_a_direct_subscription_gets_a_large_message_in_parts_without_a_copy(
    node: Node,
) -> None:
    """Copying a large image takes the event loop milliseconds."""
    taken: list[Parts] = []
    direct_subscription(
        node, UInt8MultiArray, "pixels", lambda raw, *_: taken.append(raw), QoSProfile(depth=1)
    )
    publisher = node.create_publisher(UInt8MultiArray, "pixels", 10)
    pixels = bytes(range(256)) * 1000
    publisher.publish(UInt8MultiArray(data=pixels))
    (parts,) = taken
    assert b"".join(parts) == cdr.encode(UInt8MultiArray(data=pixels))  # type: ignore[arg-type]  # a list
    assert any(part is pixels for part in parts)


async def test_a_direct_subscription_counts_what_is_missing_and_leaves_out_what_has_expired(
    node: Node,
) -> None:
    """It bypasses the queue, but not the publishers' numbers and the policies."""
    taken: list[int] = []
    subscription = direct_subscription(
        node,
        String,
        "words",
        lambda _raw, sequence, *_: taken.append(sequence),
        QoSProfile(depth=1),
    )
    deliver = reader_of(subscription).deliver
    for sequence in (1, 2, 5):
        deliver(b"", b"g" * 16, sequence, 0)
    assert (taken, subscription.stats.lost) == ([1, 2, 5], 2)
    short = QoSProfile(depth=1, lifespan=Duration(nanoseconds=1))
    node.create_publisher(String, "words", short)
    deliver(b"", gid_of(node, "/words"), 1, 1)  # published in 1970
    assert (taken, subscription.stats.expired) == ([1, 2, 5], 1)


async def test_two_classes_of_one_definition_understand_each_other(node: Node) -> None:
    """A class written by hand is as good as the generated one."""

    class Number(Message, typename="std_msgs/msg/Int32"):
        data: int32 = 0

    reader = node.create_subscription(Int32, "numbers")
    node.create_publisher(Number, "numbers", 10).publish(Number(data=7))
    assert await reader.receive() == Int32(data=7)


# Bounded queues


async def test_a_slow_reader_keeps_the_newest_and_counts_the_rest(node: Node) -> None:
    """KEEP_LAST drops the oldest message, and says how many."""
    reader = node.create_subscription(String, "words", qos_profile=2)
    fill(node.create_publisher(String, "words", 10), "a", "b", "c")
    reader.destroy()
    assert [msg.data async for msg in reader] == ["b", "c"]
    assert (reader.stats.received, reader.stats.dropped) == (2, 1)


async def test_a_depth_of_zero_means_42(node: Node) -> None:
    """As in rmw_zenoh; a warning says so, like in rclpy."""
    with pytest.warns(UserWarning, match="A zero depth"):
        reader = node.create_subscription(Int32, "numbers", qos_profile=0)
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in range(50):
        publisher.publish(Int32(data=number))
    reader.destroy()
    assert [msg.data async for msg in reader] == list(range(8, 50))


async def test_keep_all_refuses_to_publish_when_a_reliable_reader_is_full(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is lost, and no reader gets a message that another could not take."""
    monkeypatch.setattr("aionode.qos._profile.KEEP_ALL_DEPTH", 2)
    full = node.create_subscription(String, "words", qos_profile=KEEP_ALL)
    other = node.create_subscription(String, "words", qos_profile=10)
    publisher = node.create_publisher(String, "words", KEEP_ALL)
    fill(publisher, "a", "b")

    with pytest.raises(QueueFullError, match="/words: a KEEP_ALL subscription"):
        fill(publisher, "c")

    full.destroy()
    other.destroy()
    assert [msg.data async for msg in full] == ["a", "b"]
    assert [msg.data async for msg in other] == ["a", "b"]
    assert publisher.stats.published == 2


async def test_a_best_effort_keep_all_reader_drops_the_newest(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It never holds up a publisher."""
    monkeypatch.setattr("aionode.qos._profile.KEEP_ALL_DEPTH", 2)
    reader = node.create_subscription(String, "words", qos_profile=BEST_EFFORT_KEEP_ALL)
    fill(node.create_publisher(String, "words", KEEP_ALL), "a", "b", "c")
    reader.destroy()
    assert [msg.data async for msg in reader] == ["a", "b"]
    assert reader.stats.dropped == 1


async def test_drain_waits_for_room(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    """A publisher that must not lose anything adapts to the pace of its reader."""
    monkeypatch.setattr("aionode.qos._profile.KEEP_ALL_DEPTH", 2)
    reader = node.create_subscription(String, "words", qos_profile=KEEP_ALL)
    publisher = node.create_publisher(String, "words", KEEP_ALL)
    fill(publisher, "a", "b")

    async with asyncio.TaskGroup() as tasks:
        drained = tasks.create_task(publisher.drain())
        await settle()
        assert not drained.done()
        await reader.receive()

    fill(publisher, "c")


async def test_drain_ends_when_the_full_reader_goes(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No reader is left to wait for."""
    monkeypatch.setattr("aionode.qos._profile.KEEP_ALL_DEPTH", 1)
    reader = node.create_subscription(String, "words", qos_profile=KEEP_ALL)
    publisher = node.create_publisher(String, "words", KEEP_ALL)
    fill(publisher, "a")
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(publisher.drain())
        await settle()
        reader.destroy()


async def test_what_a_destroyed_callback_did_not_get_is_counted(context: Context) -> None:
    """Received + dropped equals sent, even at the end."""
    node = Node("node", context=context)
    subscription = node.create_subscription(String, "words", lambda msg: None)
    fill(node.create_publisher(String, "words", 10), "a", "b")
    node.destroy_node()
    assert (subscription.stats.received, subscription.stats.dropped) == (0, 2)


# Late joiners


@pytest.mark.parametrize(
    ("kept_by_publisher", "wanted", "expected"),
    [(3, 10, ["b", "c", "d"]), (10, 2, ["c", "d"]), (10, 10, ["a", "b", "c", "d"])],
)
async def test_a_late_transient_local_reader_gets_the_newest_once_and_in_order(
    node: Node, kept_by_publisher: int, wanted: int, expected: list[str]
) -> None:
    """As many as both sides keep, before anything new."""
    publisher = node.create_publisher(String, "map", kept(kept_by_publisher))
    fill(publisher, "a", "b", "c", "d")
    reader = node.create_subscription(String, "map", qos_profile=kept(wanted))
    fill(publisher, "e")
    reader.destroy()
    assert [msg.data async for msg in reader] == [*expected, "e"][-wanted:]


async def test_a_late_volatile_reader_gets_nothing_old(node: Node) -> None:
    """It did not request history."""
    publisher = node.create_publisher(String, "map", kept(3))
    fill(publisher, "old")
    reader = node.create_subscription(String, "map")
    fill(publisher, "new")
    reader.destroy()
    assert [msg.data async for msg in reader] == ["new"]


# Matching


async def test_incompatible_profiles_do_not_match_and_are_reported_once(
    node: Node, capfd: pytest.CaptureFixture[str]
) -> None:
    """Silence is what users of ROS 2 complain about most."""
    reader = node.create_subscription(String, "words", qos_profile=10)
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = node.create_publisher(String, "words", best_effort)
    fill(publisher, "unheard", "unheard")
    reader.destroy()

    assert [msg async for msg in reader] == []
    assert publisher.get_subscription_count() == 0
    warnings = [line for line in capfd.readouterr().err.splitlines() if "incompatible QoS" in line]
    assert len(warnings) == 1
    assert "New publisher discovered on topic '/words'" in warnings[0]
    assert "RELIABILITY" in warnings[0]


async def test_different_types_on_one_topic_are_reported(
    node: Node, capfd: pytest.CaptureFixture[str]
) -> None:
    """With both types, and a remedy."""
    node.create_subscription(String, "words", lambda msg: None)
    node.create_publisher(Int32, "words", 10).publish(Int32())
    error = capfd.readouterr().err
    assert "has type std_msgs/msg/Int32, this subscription std_msgs/msg/String" in error
    assert "use the same type, or another name" in error


async def test_wait_for_subscribers_is_woken_by_the_subscription(node: Node) -> None:
    """Without polling."""
    publisher = node.create_publisher(String, "words", 10)
    async with asyncio.TaskGroup() as tasks:
        waiting = tasks.create_task(publisher.wait_for_subscribers(2))
        node.create_subscription(String, "words")
        await settle()
        assert not waiting.done()
        node.create_subscription(String, "words")
    assert publisher.get_subscription_count() == 2


async def test_destroying_a_publisher_ends_waits_for_its_subscribers(
    node: Node,
) -> None:
    """Otherwise they would wait forever."""
    publisher = node.create_publisher(String, "words", 10)
    waiting = asyncio.get_running_loop().create_task(publisher.wait_for_subscribers(1))
    await settle()
    publisher.destroy()
    with pytest.raises(EntityDestroyedError):
        await waiting


# Mistakes


async def test_publishing_another_type_is_an_error(node: Node) -> None:
    """It names what was given and what is expected."""
    publisher = node.create_publisher(String, "words", 10)
    with pytest.raises(TypeError, match="std_msgs/msg/String"):
        publisher.publish(Int32(data=1))  # type: ignore[arg-type]  # the mistake


@pytest.mark.parametrize("listened", [True, False])
async def test_a_value_that_does_not_fit_is_an_error(node: Node, *, listened: bool) -> None:
    """With and without a subscription, and none receives anything."""
    reader = node.create_subscription(Int8, "numbers") if listened else None
    publisher = node.create_publisher(Int8, "numbers", 10)
    with pytest.raises(MessageError, match=r"std_msgs/msg/Int8\.data"):
        publisher.publish(Int8(data=300))
    assert publisher.stats.published == 0
    if reader is not None:
        reader.destroy()
        assert [msg async for msg in reader] == []


async def test_publishing_on_a_destroyed_publisher_is_an_error(node: Node) -> None:
    """A RuntimeError, as in rclpy."""
    publisher = node.create_publisher(String, "words", 10)
    publisher.destroy()
    with pytest.raises(RuntimeError, match="publisher of /words is destroyed"):
        publisher.publish(String())


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ((String, "bad topic", print), InvalidTopicNameException, "must not contain characters"),
        ((str, "words", print), TypeError, "<class 'str'> is not a message class"),
        ((AddTwoInts, "words", print), TypeError, "is not a message class"),
        ((String, "words", "print"), TypeError, "'print' is not callable"),
        ((String, "words", lambda: None), CallbackSignatureError, "must take (message) or"),
        ((String, "words", lambda a, b, c: None), RuntimeError, "must take (message) or"),
        ((String, "words", print, -1), ValueError, "greater than or equal to zero, not -1"),
        ((String, "words", print, "10"), TypeError, "Expected QoSProfile or int"),
    ],
)
async def test_a_mistake_in_create_subscription_is_reported_there(
    node: Node, arguments: tuple[Any, ...], error: type[Exception], text: str
) -> None:
    """Each its own error, with what was given and what fits."""
    with pytest.raises(error) as caught:
        node.create_subscription(*arguments)
    assert text in str(caught.value)
    assert node.subscriptions == []


@pytest.mark.parametrize(
    ("options", "error", "text"),
    [
        ({"concurrent": 0}, ValueError, "concurrent=0; at least 1"),
        ({"concurrent": -2}, ValueError, "concurrent=-2"),
        ({"concurrent": "yes"}, TypeError, "concurrent='yes'"),
        ({"on_error": "ignore"}, ValueError, "on_error='ignore' is unknown"),
        ({"on_error": 3}, TypeError, "on_error is 3"),
    ],
)
async def test_an_impossible_option_is_refused(
    node: Node, options: dict[str, Any], error: type[Exception], text: str
) -> None:
    """At once, not at the first message."""
    with pytest.raises(error, match=text):
        node.create_subscription(String, "words", print, **options)


# Faults


def faulty_node(**faults: Any) -> Node:
    """Return a node whose messages are lost, delayed or doubled."""
    context = Context(transport=FaultyTransport(LocalTransport(), **faults))
    return Node("node", context=context)


async def test_lost_messages_are_counted() -> None:
    """By the gaps in the sequence numbers of their publisher."""
    node = faulty_node(drop=0.5, seed=3)
    reader = node.create_subscription(Int32, "numbers", qos_profile=100)
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in range(100):
        publisher.publish(Int32(data=number))
    reader.destroy()
    got = [msg.data async for msg in reader]
    assert 20 < len(got) < 80
    assert reader.stats.lost == got[-1] - got[0] + 1 - len(got)


async def test_a_delayed_message_is_what_was_published(manual_clock: Any) -> None:
    """What its publisher has changed since is not in it."""
    node = faulty_node(delay=1.0, clock=manual_clock)
    reader = node.create_subscription(Int32, "numbers")
    msg = Int32(data=1)
    node.create_publisher(Int32, "numbers", 10).publish(msg)
    msg.data = 2
    await manual_clock.advance(1.0)
    assert (await reader.receive()).data == 1


async def test_the_statistics_name_each_subscription_and_its_route(node: Node) -> None:
    """Two of one node are told apart; what does not match gets nothing, and is not named."""
    publisher = node.create_publisher(String, "words", 10)
    readers = [node.create_subscription(String, "words") for _ in range(2)]
    node.create_subscription(Int8, "words")

    assert publisher.stats.routes == {
        f"/node {reader_of(reader).endpoint.gid.hex()[:8]}": "local" for reader in readers
    }
    readers[0].destroy()
    (name,) = publisher.stats.routes
    fill(publisher, "a")
    assert repr(publisher.stats) == (
        f"PublisherStats(published=1, dropped=0, routes={{'{name}': 'local'}})"
    )
    publisher.destroy()
    assert publisher.stats.routes == {}


async def test_a_faulty_transport_has_the_routes_of_the_one_that_it_wraps() -> None:
    """Simulated loss is not counted as dropped: a sender does not learn of it."""
    context = Context(transport=FaultyTransport(LocalTransport(), drop=1.0))
    async with Node("node", context=context) as node:
        node.create_subscription(String, "words")
        publisher = node.create_publisher(String, "words", 10)
        fill(publisher, "a")
        assert list(publisher.stats.routes.values()) == ["local"]
        assert publisher.stats.dropped == 0


@pytest.mark.parametrize(
    ("faults", "expected"), [({"duplicate": 1.0}, [0, 0, 1, 1]), ({"drop": 1.0}, [])]
)
async def test_the_faults_of_a_faulty_transport(
    faults: dict[str, float], expected: list[int]
) -> None:
    """Each does what its name says."""
    node = faulty_node(**faults)
    reader = node.create_subscription(Int32, "numbers")
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in range(2):
        publisher.publish(Int32(data=number))
    reader.destroy()
    assert [msg.data async for msg in reader] == expected


def test_an_impossible_fault_is_refused() -> None:
    """A likelihood is a number from 0 to 1."""
    with pytest.raises(ValueError, match=r"drop=1\.5"):
        FaultyTransport(LocalTransport(), drop=1.5)


# Description


async def test_reprs_tell_topic_type_profile_and_counts(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """The first thing to print when nothing arrives."""
    node_factory("other")
    publisher = node.create_publisher(String, "words", 10)
    subscription = node.create_subscription(String, "words", lambda msg: None)
    assert "<Publisher /words std_msgs/msg/String" in repr(publisher)
    assert "published=0" in repr(publisher)
    assert "received=0 dropped=0" in repr(subscription)
