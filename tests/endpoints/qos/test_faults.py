"""Policies over a transport that delays and loses messages."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest

from aionode.clock import Duration, Time
from aionode.endpoints.events import (
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSMessageLostInfo,
    QoSRequestedDeadlineMissedInfo,
)
from aionode.engine.context import Context
from aionode.engine.transport.local import LocalTransport
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from aionode.qos import LivelinessPolicy, QoSProfile
from aionode.testing import FaultyTransport, ManualClock, settle
from tests.endpoints.qos.conftest import waiting
from tests.support.arrivals import reader_of
from tests.support.peers import quiet_node

SECOND = Duration(seconds=1)


@pytest.fixture
def clock() -> ManualClock:
    """The time, stepped by the tests."""
    return ManualClock(Time(seconds=1000))


@pytest.fixture
def network(clock: ManualClock) -> FaultyTransport:
    """The transport of the messages; a test sets its faults."""
    return FaultyTransport(LocalTransport(), clock=clock)


@pytest.fixture
async def node(clock: ManualClock, network: FaultyTransport) -> AsyncIterator[Node]:
    """A node whose messages to itself use that transport."""
    context = Context(transport=network, clock=clock)
    async with quiet_node("node", context) as node:
        yield node


async def test_a_message_that_was_on_its_way_for_too_long_is_not_delivered(
    node: Node, network: FaultyTransport, clock: ManualClock
) -> None:
    """A slow network makes it old before it arrives."""
    subscription = node.create_subscription(Int32, "n")
    publisher = node.create_publisher(Int32, "n", QoSProfile(depth=10, lifespan=SECOND))
    for delay in (0.9, 1.0):
        network.delay = delay
        publisher.publish(Int32())
    await clock.advance(2)
    assert len(reader_of(subscription)) == 0
    assert subscription.stats.expired == 2
    network.delay = 0.9
    publisher.publish(Int32(data=3))
    await clock.advance(0.95)
    assert (await subscription.receive()).data == 3


async def test_lost_messages_miss_the_deadline_of_the_subscription_alone(
    node: Node, network: FaultyTransport, clock: ManualClock
) -> None:
    """The publisher did what it promised."""
    profile = QoSProfile(depth=10, deadline=SECOND)
    subscription = node.create_subscription(Int32, "n", None, profile)
    publisher = node.create_publisher(Int32, "n", profile)
    events = subscription.events
    for drop in (0, 1, 1, 0):
        network.drop = drop
        publisher.publish(Int32())
        await clock.advance(0.7)
    assert waiting(publisher.events, type(None)) == []
    found = waiting(events, QoSRequestedDeadlineMissedInfo)
    assert found == [QoSRequestedDeadlineMissedInfo(1, 1), QoSRequestedDeadlineMissedInfo(2, 1)]
    assert subscription.stats.lost == 2


async def test_missing_messages_are_reported(
    node: Node, network: FaultyTransport, clock: ManualClock
) -> None:
    """When the next message arrives."""
    subscription = node.create_subscription(Int32, "n")
    publisher = node.create_publisher(Int32, "n", 10)
    events = subscription.events
    for drop in (0, 1, 1, 0):
        network.drop = drop
        publisher.publish(Int32())
    await settle()
    assert waiting(events, QoSMessageLostInfo) == [QoSMessageLostInfo(2, 2)]


async def test_lost_assertions_end_the_life_of_a_publisher_for_its_readers(
    node: Node, network: FaultyTransport, clock: ManualClock
) -> None:
    """The publisher does not know: it asserted its liveliness in time."""
    profile = QoSProfile(
        depth=10,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=SECOND,
    )
    subscription = node.create_subscription(Int32, "n", None, profile)
    publisher = node.create_publisher(Int32, "n", profile)
    events = subscription.events
    for drop in (0, 1, 1, 0):
        network.drop = drop
        publisher.assert_liveliness()
        await clock.advance(0.7)
    assert [event.alive_count for event in waiting(events, QoSLivelinessChangedInfo)] == [1, 0, 1]
    assert waiting(publisher.events, QoSLivelinessLostInfo) == []
