"""Events of publishers and subscriptions: deadlines, liveliness, matches, and what is lost.

The names and fields are those of `rclpy.event_handler`. An event tells what has changed since the
one before it (``…_change``), and the total since the endpoint was created.

There are two ways to get them: callbacks, given when the endpoint is created, and
``async for event in publisher.events``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

from aionode.endpoints.core.message_queue import MessageQueue
from aionode.endpoints.stats import CallbackStats
from aionode.engine.rules.event_records import (
    IncompatibleTypeInfo,
    MatchedInfo,
    PublisherEvent,
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
)

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

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
"""Most events that wait for a callback or a reader; beyond, the oldest is dropped and counted."""


# Callbacks


class PublisherEventCallbacks:
    """Functions that a publisher calls with its events, sync or async, each of one argument.

    An exception in one ends the node, as in the callback of a subscription.

    Args:
        deadline: Called when nothing was published for as long as the deadline.
        liveliness: Called when the publisher gave no sign of life within its lease.
        incompatible_qos: Called when a subscription requests more than the publisher offers.
        incompatible_type: Called when a subscription of the topic has another type.
        matched: Called when a subscription is matched, or has gone.
        use_default_callbacks: Whether the log gets a warning for each incompatible subscription
            that no callback is given for.
    """

    def __init__(
        self,
        *,
        deadline: Callable[[QoSOfferedDeadlineMissedInfo], object] | None = None,
        liveliness: Callable[[QoSLivelinessLostInfo], object] | None = None,
        incompatible_qos: Callable[[QoSOfferedIncompatibleQoSInfo], object] | None = None,
        incompatible_type: Callable[[IncompatibleTypeInfo], object] | None = None,
        matched: Callable[[QoSPublisherMatchedInfo], object] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline = deadline
        self.liveliness = liveliness
        self.incompatible_qos = incompatible_qos
        self.incompatible_type = incompatible_type
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks


class SubscriptionEventCallbacks:
    """Functions that a subscription calls with its events, sync or async, each of one argument.

    An exception in one ends the node, as in the callback of the subscription itself.

    Args:
        deadline: Called when nothing was received for as long as the deadline.
        incompatible_qos: Called when a publisher offers less than the subscription requests.
        liveliness: Called when a publisher comes to life, loses its liveliness, or goes.
        message_lost: Called when messages are missing in the numbers of a publisher.
        incompatible_type: Called when a publisher of the topic has another type.
        matched: Called when a publisher is matched, or has gone.
        use_default_callbacks: Whether the log gets a warning for each incompatible publisher that
            no callback is given for.
    """

    def __init__(
        self,
        *,
        deadline: Callable[[QoSRequestedDeadlineMissedInfo], object] | None = None,
        incompatible_qos: Callable[[QoSRequestedIncompatibleQoSInfo], object] | None = None,
        liveliness: Callable[[QoSLivelinessChangedInfo], object] | None = None,
        message_lost: Callable[[QoSMessageLostInfo], object] | None = None,
        incompatible_type: Callable[[IncompatibleTypeInfo], object] | None = None,
        matched: Callable[[QoSSubscriptionMatchedInfo], object] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline = deadline
        self.incompatible_qos = incompatible_qos
        self.liveliness = liveliness
        self.message_lost = message_lost
        self.incompatible_type = incompatible_type
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks


# The asyncio form


class EventStream(Generic[EventT]):
    """The events of one endpoint, as an async iterator: ``async for event in publisher.events``.

    It begins with what has happened since the endpoint was created, as one event of each kind, and
    ends when the endpoint is destroyed. It keeps the newest hundred events. If several tasks read
    it, each event goes to one of them.
    """

    def __init__(self) -> None:
        self._queue: MessageQueue[EventT] = MessageQueue(EVENTS_KEPT, CallbackStats())
        self._ended = False

    @property
    def dropped(self) -> int:
        """The number of events that were dropped because they were not read in time."""
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
        """End the iteration once what has happened was read."""
        self._ended = True
        self._queue.wake()
