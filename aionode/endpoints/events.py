"""Events of publishers and subscriptions: deadlines, liveliness, matches, lost messages.

The names and fields are those of `rclpy.event_handler`. An event has the change since the previous
one (``…_change``), and the total since the endpoint was created.

There are two ways to get them: callbacks, passed when the endpoint is created, and ``async for
event in publisher.events``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

from aionode.endpoints.core.message_queue import MessageQueue
from aionode.endpoints.stats import CallbackStats
from aionode.engine.rules.event_records import (
    IncompatibleTypeInfo,
    MatchedInfo,
    PublisherEvent,
    PublisherEventCallbacks,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSOfferedIncompatibleQoSInfo,
    QoSPublisherMatchedInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
    QoSSubscriptionMatchedInfo,
    SubscriptionEvent,
    SubscriptionEventCallbacks,
)

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

__all__ = [
    "EVENTS_KEPT",
    "EventStream",
    "IncompatibleTypeInfo",
    "MatchedInfo",
    "PublisherEvent",
    "PublisherEventCallbacks",
    "QoSLivelinessChangedInfo",
    "QoSLivelinessLostInfo",
    "QoSMessageLostInfo",
    "QoSOfferedDeadlineMissedInfo",
    "QoSOfferedIncompatibleQoSInfo",
    "QoSPublisherMatchedInfo",
    "QoSRequestedDeadlineMissedInfo",
    "QoSRequestedIncompatibleQoSInfo",
    "QoSSubscriptionMatchedInfo",
    "SubscriptionEvent",
    "SubscriptionEventCallbacks",
]

EventT = TypeVar("EventT")

EVENTS_KEPT = 100
"""Maximum events waiting for a callback or reader; then the oldest is dropped and counted."""


# The asyncio API


class EventStream(Generic[EventT]):
    """The events of one endpoint, as an async iterator: ``async for event in publisher.events``.

    It starts with one event of each kind for what has happened since the endpoint was created, and
    ends when the endpoint is destroyed. It keeps the newest 100 events. If several tasks read it,
    each event goes to one of them.
    """

    def __init__(self) -> None:
        self._queue: MessageQueue[EventT] = MessageQueue(EVENTS_KEPT, CallbackStats())
        self._ended = False

    @property
    def dropped(self) -> int:
        """The number of events dropped because they were not read in time."""
        return self._queue.stats.dropped

    def __aiter__(self) -> AsyncIterator[EventT]:
        """Iterate over the events as they happen."""
        return self

    async def __anext__(self) -> EventT:
        """Wait for the next event. Cancelling loses nothing."""
        while not self._queue:
            if self._ended:
                raise StopAsyncIteration
            await self._queue.wait()
        return self._queue.pop()[1]

    # Called by the endpoint

    def _put(self, event: EventT) -> None:
        self._queue.put(event)

    def _end(self) -> None:
        """End the iteration once all events are read."""
        self._ended = True
        self._queue.wake()
