"""The lifespan of messages: older ones are not delivered, wherever they have waited."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.clock import Duration
from aionode.engine.context import Context
from aionode.engine.transport.zenoh.endpoints.subscription import ZenohReader
from aionode.graph import EndpointKind
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from aionode.testing import settle
from tests.endpoints.qos.conftest import Pair
from tests.support.arrivals import reader_of
from tests.support.peers import quiet_node

if TYPE_CHECKING:
    from aionode.endpoints.subscription import Subscription

LIFESPAN = Duration(seconds=1)
LIMITED = QoSProfile(depth=10, lifespan=LIFESPAN)
KEPT = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KEPT_LIMITED = KEPT.replace(lifespan=LIFESPAN)


async def until_queued(subscription: Subscription[Any], count: int = 1) -> None:
    """Wait until a number of messages are in the queue of a subscription."""
    while len(reader_of(subscription)) < count:
        await checkpoint()


@pytest.mark.parametrize(
    ("offered", "requested"), [(LIMITED, 10), (10, LIMITED)], ids=["publisher", "subscription"]
)
async def test_an_unread_message_expires_in_the_queue(
    pair: Pair, offered: QoSProfile | int, requested: QoSProfile | int
) -> None:
    """Whether the publisher limits it, or the subscription as rmw_fastrtps lets it."""
    publisher, subscription = await pair.joined(offered, requested)
    publisher.publish(Int32(data=1))
    await until_queued(subscription)
    await pair.clock.advance(0.6)
    publisher.publish(Int32(data=2))
    await until_queued(subscription, 2)
    await pair.clock.advance(0.6)
    assert (await subscription.receive()).data == 2
    assert subscription.stats.expired == 1
    assert subscription.stats.dropped == 0


@pytest.mark.parametrize(
    ("offered", "requested"),
    [(KEPT_LIMITED, KEPT), (KEPT, KEPT_LIMITED)],
    ids=["publisher", "subscription"],
)
async def test_a_late_subscription_gets_no_expired_message(
    pair: Pair, offered: QoSProfile, requested: QoSProfile
) -> None:
    """Messages wait longest in the history of a transient local publisher."""
    publisher = pair.talker.create_publisher(Int32, "n", offered)
    publisher.publish(Int32(data=1))
    await pair.clock.advance(1.5)
    publisher.publish(Int32(data=2))
    await pair.listener.graph.until(lambda: pair.listener.count_publishers("n") == 1)
    subscription = pair.listener.create_subscription(Int32, "n", None, requested)
    assert (await subscription.receive()).data == 2
    assert subscription.stats.expired <= 1  # it may not have been sent at all


async def test_a_callback_that_is_busy_gets_no_expired_message(pair: Pair) -> None:
    """Messages behind a running callback wait in the queue, which had no limit at first."""
    got: list[int] = []
    busy = asyncio.Event()

    async def take(msg: Int32) -> None:
        got.append(msg.data)
        await busy.wait()

    subscription = pair.listener.create_subscription(Int32, "n", take)
    plain = pair.talker.create_publisher(Int32, "n", 10)
    await pair.know_each_other(plain, subscription)
    plain.publish(Int32(data=1))
    while not got:
        await checkpoint()
    limited = pair.talker.create_publisher(Int32, "n", LIMITED)
    await limited.wait_for_subscribers()
    await pair.listener.graph.until(lambda: subscription.get_publisher_count() == 2)
    plain.publish(Int32(data=2))
    await until_queued(subscription, 1)
    limited.publish(Int32(data=3))
    await until_queued(subscription, 2)
    await pair.clock.advance(1)
    busy.set()
    await settle()
    assert got == [1, 2]
    assert subscription.stats.expired == 1


async def test_expired_messages_make_room(pair: Pair) -> None:
    """A publisher that waits for a KEEP_ALL subscription waits for its lifespan at most."""
    if pair.transport != "local":
        pytest.skip("to other processes a publisher is held up by what is on its way, too")
    publisher, subscription = await pair.joined(
        LIMITED.replace(history=HistoryPolicy.KEEP_ALL), QoSProfile(history=HistoryPolicy.KEEP_ALL)
    )
    for number in range(10_000):
        publisher.publish(Int32(data=number))
    async with asyncio.TaskGroup() as tasks:
        drained = tasks.create_task(publisher.drain())
        await pair.clock.advance(0.5)
        assert not drained.done()
        await pair.clock.advance(0.5)
    assert subscription.stats.expired == 10_000


async def test_a_message_of_a_publisher_that_has_gone_expires_too(pair: Pair) -> None:
    """The lifespan comes with the message."""
    publisher, subscription = await pair.joined(LIMITED, 10)
    publisher.publish(Int32(data=1))
    await until_queued(subscription)
    publisher.destroy()
    await pair.clock.advance(1)
    assert not reader_of(subscription)


async def test_a_stamp_from_the_future_counts_as_now(pair: Pair) -> None:
    """Clocks of two machines may differ; DDS then counts from the arrival."""
    _, subscription = await pair.joined(10, LIMITED)
    future_ns = pair.clock.system_ns() + 3600 * 10**9
    reader_of(subscription).deliver(Int32(data=1), b"x" * 16, 1, future_ns)
    assert (await subscription.receive()).data == 1
    reader_of(subscription).deliver(Int32(data=2), b"x" * 16, 2, future_ns)
    await pair.clock.advance(1)
    assert not reader_of(subscription)


async def test_what_waits_for_a_new_process_expires_too(
    pair: Pair, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its history must not arrive before the tokens, which say how long it is valid."""
    known: list[int] = []
    declare = ZenohReader.declare_data

    def note(reader: ZenohReader, session: Any) -> None:
        assert reader.state.graph is not None
        known.append(reader.state.graph.count(EndpointKind.PUBLISHER, "/n"))
        declare(reader, session)

    publisher = pair.talker.create_publisher(Int32, "n", KEPT_LIMITED)
    for number in range(5):
        publisher.publish(Int32(data=number))
    await pair.clock.advance(1)
    publisher.publish(Int32(data=5))
    monkeypatch.setattr(ZenohReader, "declare_data", note)
    context = pair.talker.context if pair.transport == "local" else Context(clock=pair.clock)
    node = quiet_node("late", context)
    subscription = node.create_subscription(Int32, "n", None, KEPT)
    async with node:
        assert (await subscription.receive()).data == 5
    assert known == ([] if pair.transport == "local" else [1])
