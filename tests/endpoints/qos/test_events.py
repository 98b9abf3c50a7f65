"""Events of matches, incompatibilities and lost messages, and their two forms."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from aionode.clock import Duration
from aionode.endpoints.events import (
    EVENTS_KEPT,
    IncompatibleTypeInfo,
    MatchedInfo,
    PublisherEventCallbacks,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
    SubscriptionEventCallbacks,
)
from aionode.errors import CallbackSignatureError
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.node import Node
from aionode.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from aionode.testing import ManualClock, local_context, settle
from tests.endpoints.qos.conftest import Pair, next_of, waiting
from tests.support.arrivals import reader_of, writers_of

BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


async def test_matches_are_counted_at_both_ends(pair: Pair) -> None:
    """Removals are counted as well."""
    publisher, subscription = await pair.joined(10, 10)
    assert await next_of(publisher.events, MatchedInfo) == MatchedInfo(1, 1, 1, 1)
    assert await next_of(subscription.events, MatchedInfo) == MatchedInfo(1, 1, 1, 1)
    second = pair.talker.create_publisher(Int32, "n", 10)
    assert await next_of(subscription.events, MatchedInfo) == MatchedInfo(2, 1, 2, 1)
    second.destroy()
    assert await next_of(subscription.events, MatchedInfo) == MatchedInfo(2, 0, 1, -1)
    subscription.destroy()
    assert await next_of(publisher.events, MatchedInfo) == MatchedInfo(1, 0, 0, -1)


async def test_an_incompatible_profile_is_an_event_at_both_ends(pair: Pair) -> None:
    """Over Zenoh messages pass nevertheless, as with rmw_zenoh, so there it is a match as well."""
    publisher, subscription = await pair.joined_by_name(BEST_EFFORT, 10)
    for stream in (publisher.events, subscription.events):
        event = await next_of(stream, QoSRequestedIncompatibleQoSInfo)
        assert event == QoSRequestedIncompatibleQoSInfo(1, 1, QoSPolicyKind.RELIABILITY)
        matches = waiting(stream, MatchedInfo)
        assert matches == ([] if pair.transport == "local" else [MatchedInfo(1, 1, 1, 1)])


async def test_an_incompatible_type_is_an_event_at_both_ends(pair: Pair) -> None:
    """Neither receives from the other."""
    publisher = pair.talker.create_publisher(Int32, "n", 10)
    subscription = pair.listener.create_subscription(String, "n")
    assert await next_of(publisher.events, IncompatibleTypeInfo) == IncompatibleTypeInfo(1, 1)
    assert await next_of(subscription.events, IncompatibleTypeInfo) == IncompatibleTypeInfo(1, 1)
    assert waiting(subscription.events, MatchedInfo) == []


async def test_messages_that_are_missing_are_an_event(node: Node) -> None:
    """The publishers are in other processes; within one, nothing is lost."""
    got: list[QoSMessageLostInfo] = []
    subscription = node.create_subscription(
        Int32, "n", event_callbacks=SubscriptionEventCallbacks(message_lost=got.append)
    )
    for number in (1, 2, 5, 6, 8):
        reader_of(subscription).deliver(Int32(), b"x" * 16, number, 0)
    await settle()
    assert got == [QoSMessageLostInfo(2, 2), QoSMessageLostInfo(3, 1)]


async def test_a_late_stream_begins_with_what_has_happened(node: Node) -> None:
    """One event of each kind, whose change is the whole count."""
    publisher = node.create_publisher(Int32, "n", 10)
    subscription = node.create_subscription(Int32, "n")
    node.create_subscription(Int32, "n").destroy()
    for number in (1, 5):
        reader_of(subscription).deliver(Int32(), b"x" * 16, number, 0)
    assert waiting(subscription.events, QoSMessageLostInfo) == [QoSMessageLostInfo(3, 3)]
    assert waiting(publisher.events, MatchedInfo) == [MatchedInfo(1, 1, 1, 1)]


async def test_streams_end_with_their_endpoint(node: Node) -> None:
    """Earlier events can still be read; a stream created later is empty."""
    publisher = node.create_publisher(Int32, "n", 10)
    subscription = node.create_subscription(Int32, "n")
    seen: list[Any] = []

    async def watch() -> None:
        seen.extend([event async for event in publisher.events])

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(watch())
        await settle()
        subscription.destroy()
        publisher.destroy()
    assert seen == [MatchedInfo(1, 1, 1, 1), MatchedInfo(1, 0, 0, -1)]
    assert [event async for event in subscription.events] == []


async def test_a_stream_that_is_not_read_keeps_the_newest_and_counts_the_others(node: Node) -> None:
    """It is bounded, like everything that waits."""
    publisher = node.create_publisher(Int32, "n", 10)
    events = publisher.events
    for _ in range(EVENTS_KEPT):
        node.create_subscription(Int32, "n").destroy()
    kept = waiting(events, MatchedInfo)
    assert len(kept) == EVENTS_KEPT
    assert kept[-1] == MatchedInfo(EVENTS_KEPT, 0, 0, -1)
    assert events.dropped == EVENTS_KEPT


async def test_cancelling_a_wait_loses_no_event(node: Node) -> None:
    """A timeout around it is the usual way to limit it."""
    publisher = node.create_publisher(Int32, "n", 10)
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0):
            await anext(publisher.events)
    node.create_subscription(Int32, "n")
    assert await anext(publisher.events) == MatchedInfo(1, 1, 1, 1)


async def test_an_exception_in_an_event_callback_ends_the_node() -> None:
    """No caller waits for an answer, as with a subscription's callback."""

    def fail(event: MatchedInfo) -> None:
        raise ValueError(f"{event.current_count} is too many")

    with pytest.raises(ExceptionGroup) as failed:  # noqa: PT012  # the node raises it at its end
        async with local_context() as context, Node("node", context=context) as node:
            node.create_publisher(
                Int32, "n", 10, event_callbacks=PublisherEventCallbacks(matched=fail)
            )
            node.create_subscription(Int32, "n")
            await node.until_destroyed()
    assert "1 is too many" in str(failed.value.exceptions)


async def test_callbacks_are_checked_when_they_are_given(node: Node) -> None:
    """With the event that they are for."""
    with pytest.raises(CallbackSignatureError, match="event callback matched"):
        node.create_publisher(
            Int32,
            "n",
            10,
            event_callbacks=PublisherEventCallbacks(matched=lambda: None),  # type: ignore[arg-type,misc]  # the mistake
        )
    with pytest.raises(TypeError, match=r"give a SubscriptionEventCallbacks"):
        node.create_subscription(
            Int32,
            "n",
            event_callbacks=PublisherEventCallbacks(),  # type: ignore[call-overload]  # the mistake
        )
    assert node.count_publishers("n") == node.count_subscribers("n") == 0


@pytest.mark.parametrize(
    ("callbacks", "warned"),
    [
        (None, True),
        (SubscriptionEventCallbacks(), True),
        (SubscriptionEventCallbacks(use_default_callbacks=False), False),
        (SubscriptionEventCallbacks(incompatible_qos=lambda event: None), False),
        (SubscriptionEventCallbacks(incompatible_type=lambda event: None), True),
    ],
)
async def test_the_default_for_an_incompatible_profile_is_a_warning(
    node: Node,
    caplog: pytest.LogCaptureFixture,
    callbacks: SubscriptionEventCallbacks | None,
    warned: bool,
) -> None:
    """Rclpy's rule: a callback takes its place, or the program wants neither."""
    node.create_subscription(Int32, "n", event_callbacks=callbacks)
    node.create_publisher(
        Int32,
        "n",
        BEST_EFFORT,
        event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
    )
    assert any("incompatible QoS" in record.getMessage() for record in caplog.records) == warned


async def test_events_of_a_publisher_without_policies_cost_no_message_anything(node: Node) -> None:
    """Messages that no policy concerns are not delayed."""
    publisher = node.create_publisher(Int32, "n", 10)
    subscription = node.create_subscription(Int32, "n")
    assert len(writers_of(publisher)) == len(node.context.transports)
    assert reader_of(subscription).on_arrival is None


async def test_a_message_that_does_not_fit_is_no_sign_of_life(
    node: Node, manual_clock: ManualClock
) -> None:
    """It was not published, whether anybody listens or not."""
    profile = QoSProfile(depth=1, deadline=Duration(seconds=1))
    publisher = node.create_publisher(Int32, "n", profile)
    with pytest.raises(ValueError, match="data"):
        publisher.publish(Int32(data="no"))  # type: ignore[arg-type]  # the mistake
    await manual_clock.advance(2.0)
    assert waiting(publisher.events, QoSOfferedDeadlineMissedInfo) == []
