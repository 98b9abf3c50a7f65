"""A publisher's node and a subscription's node, over every transport, with time that is stepped."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Any, NamedTuple, TypeVar

import pytest

from aionode.clock import Time
from aionode.endpoints.events import EventStream
from aionode.endpoints.publisher import Publisher
from aionode.endpoints.subscription import Subscription
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from aionode.testing import ManualClock
from tests.support.links import folder
from tests.support.peers import contexts_over, isolated_environment, quiet_node

__all__ = ["folder"]  # a fixture

EventT = TypeVar("EventT")


class Pair(NamedTuple):
    """Two nodes connected over one transport, and their time.

    Attributes:
        talker: The node of publishers.
        listener: The node of subscriptions.
        clock: The time of both.
        transport: ``local``, ``link`` or ``zenoh``.
    """

    talker: Node
    listener: Node
    clock: ManualClock
    transport: str

    async def joined(
        self,
        offered: Any,
        requested: Any,
        *,
        publisher_events: Any = None,
        subscription_events: Any = None,
    ) -> tuple[Publisher[Int32], Subscription[Int32]]:
        """Return a publisher and a subscription that have found each other."""
        subscription = self.listener.create_subscription(
            Int32, "n", None, requested, event_callbacks=subscription_events
        )
        publisher = self.talker.create_publisher(
            Int32, "n", offered, event_callbacks=publisher_events
        )
        await self.know_each_other(publisher, subscription)
        return publisher, subscription

    async def joined_by_name(
        self, offered: Any, requested: Any
    ) -> tuple[Publisher[Int32], Subscription[Int32]]:
        """Return two that are in each other's graph, matched or not."""
        subscription = self.listener.create_subscription(Int32, "n", None, requested)
        publisher = self.talker.create_publisher(Int32, "n", offered)
        await self.talker.graph.until(lambda: self.talker.count_subscribers("n") == 1)
        await self.listener.graph.until(lambda: self.listener.count_publishers("n") == 1)
        return publisher, subscription

    async def know_each_other(
        self, publisher: Publisher[Any], subscription: Subscription[Any]
    ) -> None:
        """Wait until both are matched."""
        await publisher.wait_for_subscribers()
        await self.listener.graph.until(lambda: subscription.get_publisher_count() > 0)

    async def send(
        self, publisher: Publisher[Int32], subscription: Subscription[Int32], number: int = 0
    ) -> None:
        """Publish a number, and receive it."""
        publisher.publish(Int32(data=number))
        assert (await subscription.receive()).data == number


@pytest.fixture(params=["local", "link", "zenoh"])
async def pair(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[Pair]:
    """Two nodes of one context, or of two that a link or Zenoh connects."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    clock = ManualClock(Time(seconds=1000))
    async with (
        contexts_over(request.param, clock=clock) as (first, second),
        quiet_node("talker", first) as talker,
        quiet_node("listener", second) as listener,
    ):
        yield Pair(talker, listener, clock, request.param)


async def next_of(stream: EventStream[Any], kind: type[EventT]) -> EventT:
    """Wait for the next event of a kind, ignoring others."""
    async with asyncio.timeout(10):
        async for event in stream:
            if isinstance(event, kind):
                return event
    raise AssertionError(f"the stream ended before a {kind.__name__}")


def waiting(stream: EventStream[Any], kind: type[EventT]) -> list[EventT]:
    """Take what waits in a stream, and return the events of a kind."""
    found = []
    queue = stream._queue
    while queue:
        event = queue.pop()[1]
        if isinstance(event, kind):
            found.append(event)
    return found
