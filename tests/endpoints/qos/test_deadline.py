"""The deadline of publishers and subscriptions."""

from __future__ import annotations

from aionode.clock import Duration
from aionode.endpoints.events import (
    PublisherEventCallbacks,
    QoSOfferedDeadlineMissedInfo,
    QoSRequestedDeadlineMissedInfo,
    SubscriptionEventCallbacks,
)
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import QoSProfile
from aionode.testing import ManualClock, local_context, settle
from tests.endpoints.qos.conftest import Pair, waiting
from tests.support.peers import quiet_node

DEADLINE = QoSProfile(depth=10, deadline=Duration(seconds=0.5))


async def test_a_publisher_learns_of_each_period_without_a_message(pair: Pair) -> None:
    """As over Fast DDS: the first message starts the time, and each period counts."""
    publisher, subscription = await pair.joined(DEADLINE, DEADLINE)
    events = publisher.events
    await pair.clock.advance(2)
    assert waiting(events, QoSOfferedDeadlineMissedInfo) == []
    await pair.send(publisher, subscription)
    await pair.clock.advance(0.49)
    assert waiting(events, QoSOfferedDeadlineMissedInfo) == []
    await pair.clock.advance(0.76)
    assert waiting(events, QoSOfferedDeadlineMissedInfo) == [
        QoSOfferedDeadlineMissedInfo(total_count=1, total_count_change=1),
        QoSOfferedDeadlineMissedInfo(total_count=2, total_count_change=1),
    ]


async def test_a_subscription_learns_of_each_period_without_a_message(pair: Pair) -> None:
    """The same at the other end."""
    publisher, subscription = await pair.joined(DEADLINE, DEADLINE)
    events = subscription.events
    await pair.clock.advance(2)
    assert waiting(events, QoSRequestedDeadlineMissedInfo) == []
    await pair.send(publisher, subscription)
    await pair.clock.advance(1.2)
    assert waiting(events, QoSRequestedDeadlineMissedInfo) == [
        QoSRequestedDeadlineMissedInfo(1, 1),
        QoSRequestedDeadlineMissedInfo(2, 1),
    ]


async def test_messages_in_time_miss_nothing(pair: Pair) -> None:
    """Each message restarts the period."""
    publisher, subscription = await pair.joined(DEADLINE, DEADLINE)
    for number in range(5):
        await pair.send(publisher, subscription, number)
        await pair.clock.advance(0.4)
    assert waiting(publisher.events, QoSOfferedDeadlineMissedInfo) == []
    assert waiting(subscription.events, QoSRequestedDeadlineMissedInfo) == []


async def test_the_periods_of_a_stall_are_all_counted(pair: Pair) -> None:
    """DDS counts periods, rather than how often the program had time to check."""
    publisher, subscription = await pair.joined(DEADLINE, DEADLINE)
    await pair.send(publisher, subscription)
    await pair.clock.jump(2.2)
    assert waiting(publisher.events, QoSOfferedDeadlineMissedInfo) == [
        QoSOfferedDeadlineMissedInfo(4, 4)
    ]
    assert waiting(subscription.events, QoSRequestedDeadlineMissedInfo) == [
        QoSRequestedDeadlineMissedInfo(4, 4)
    ]


async def test_a_subscription_goes_on_counting_without_a_publisher(pair: Pair) -> None:
    """A node that relies on data must learn that there is none; Fast DDS does the same."""
    publisher, subscription = await pair.joined(DEADLINE, DEADLINE)
    await pair.send(publisher, subscription)
    publisher.destroy()
    await pair.clock.advance(1.1)
    (missed,) = waiting(subscription.events, QoSRequestedDeadlineMissedInfo)
    assert missed.total_count == 2


async def test_any_publisher_keeps_the_deadline_of_a_subscription(pair: Pair) -> None:
    """A topic without keys is one instance, however many publishers it has."""
    first, subscription = await pair.joined(DEADLINE, DEADLINE)
    second = pair.talker.create_publisher(Int32, "n", DEADLINE)
    await second.wait_for_subscribers()
    await pair.listener.graph.until(lambda: subscription.get_publisher_count() == 2)
    for number in range(3):
        await pair.send(first, subscription, number)
        await pair.clock.advance(0.3)
        await pair.send(second, subscription, number)
        await pair.clock.advance(0.3)
    assert waiting(subscription.events, QoSRequestedDeadlineMissedInfo) == []
    (missed,) = waiting(first.events, QoSOfferedDeadlineMissedInfo)
    assert missed.total_count == 3


async def test_callbacks_get_what_the_streams_get(pair: Pair) -> None:
    """Rclpy's form, with a function and a coroutine function."""
    offered: list[QoSOfferedDeadlineMissedInfo] = []
    requested: list[QoSRequestedDeadlineMissedInfo] = []

    async def on_requested(event: QoSRequestedDeadlineMissedInfo) -> None:
        requested.append(event)

    publisher, subscription = await pair.joined(
        DEADLINE,
        DEADLINE,
        publisher_events=PublisherEventCallbacks(deadline=offered.append),
        subscription_events=SubscriptionEventCallbacks(deadline=on_requested),
    )
    await pair.send(publisher, subscription)
    await pair.clock.advance(0.5)
    assert offered == [QoSOfferedDeadlineMissedInfo(1, 1)]
    assert requested == [QoSRequestedDeadlineMissedInfo(1, 1)]


async def test_a_message_before_the_node_runs_starts_the_time() -> None:
    """A constructor may publish; the deadline counts from there."""
    clock = ManualClock()
    async with local_context(clock=clock) as context:
        node = quiet_node("node", context)
        publisher = node.create_publisher(Int32, "n", DEADLINE)
        publisher.publish(Int32())
        await clock.advance(0.7)
        async with node:
            await clock.advance(0.1)
            (event,) = waiting(publisher.events, QoSOfferedDeadlineMissedInfo)
            assert event == QoSOfferedDeadlineMissedInfo(1, 1)


async def test_nothing_is_missed_after_the_end_of_the_node(pair: Pair) -> None:
    """A destroyed publisher or subscription has no deadline any more."""
    missed: list[object] = []
    publisher, subscription = await pair.joined(
        DEADLINE,
        DEADLINE,
        publisher_events=PublisherEventCallbacks(deadline=missed.append),
        subscription_events=SubscriptionEventCallbacks(deadline=missed.append),
    )
    await pair.send(publisher, subscription)
    pair.talker.destroy_node()
    pair.listener.destroy_node()
    await settle()
    await pair.clock.advance(2)
    assert missed == []
