"""Callbacks for events of publishers and subscriptions themselves."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from aionode.engine.rules import event_records as events
from aionode.engine.rules.event_records import (
    IncompatibleTypeInfo,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSOfferedIncompatibleQoSInfo,
    QoSPublisherMatchedInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
    QoSSubscriptionMatchedInfo,
)
from rclpy._impl.errors import UnsupportedEventTypeError
from rclpy._impl.events import (
    PUBLISHER_WATCHES,
    SUBSCRIPTION_WATCHES,
    EventHandle,
    PublisherEventType,
    SubscriptionEventType,
)
from rclpy.waitable import NumberOfEntities, Waitable

if TYPE_CHECKING:
    from collections.abc import Callable
    from enum import IntEnum

    from rclpy._impl.events import Watch
    from rclpy._impl.topics import PublisherHandle, SubscriptionHandle
    from rclpy._impl.wait_set import WaitSet
    from rclpy.callback_groups import CallbackGroup

__all__ = [
    "EventHandler",
    "IncompatibleTypeInfo",
    "PublisherEventCallbacks",
    "QoSEventHandler",
    "QoSLivelinessChangedInfo",
    "QoSLivelinessLostInfo",
    "QoSMessageLostInfo",
    "QoSOfferedDeadlineMissedInfo",
    "QoSOfferedIncompatibleQoSInfo",
    "QoSPublisherEventType",
    "QoSPublisherMatchedInfo",
    "QoSRequestedDeadlineMissedInfo",
    "QoSRequestedIncompatibleQoSInfo",
    "QoSSubscriptionEventType",
    "QoSSubscriptionMatchedInfo",
    "SubscriptionEventCallbacks",
    "UnsupportedEventTypeError",
]

QoSPublisherEventType = PublisherEventType
QoSSubscriptionEventType = SubscriptionEventType


class EventHandler(Waitable[Any]):
    """Makes an executor call `callback` when an event has happened.

    Attributes:
        event_type: What.
        callback: Called with its status.
    """

    def __init__(
        self,
        *,
        callback_group: CallbackGroup,
        callback: Callable[..., Any],
        event_type: IntEnum,
        parent_impl: PublisherHandle | SubscriptionHandle,
    ) -> None:
        super().__init__(callback_group)
        self.event_type = event_type
        self.callback = callback
        with parent_impl:
            self._event = EventHandle(parent_impl, event_type)

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Return whether an event has happened."""
        return self._event.ready()

    def take_data(self) -> Any:
        """Return the status, or None if no event has happened."""
        with self._event:
            return self._event.take_event() if self._event.ready() else None

    async def execute(self, taken_data: Any) -> None:
        """Call the callback."""
        if taken_data is not None:
            result = self.callback(taken_data)
            if hasattr(result, "__await__"):
                await result

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of handles that it adds to a wait set: one."""
        return NumberOfEntities(num_events=1)

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Add its handle."""
        with self._event:
            wait_set.add_event(self._event)

    def __enter__(self) -> None:
        self._event.__enter__()

    def __exit__(self, *exc: object) -> None:
        self._event.__exit__(*exc)

    def destroy(self) -> None:
        """Destroy it; called by its publisher or subscription."""
        self._event.destroy_when_not_in_use()


class QoSEventHandler(EventHandler):
    """The former name of `EventHandler`."""

    def __init__(self, **options: Any) -> None:
        warnings.warn(
            "QoSEventHandler is deprecated, use EventHandler instead.",
            DeprecationWarning,
            stacklevel=2,
        )
        super().__init__(**options)


class DefaultHandler(EventHandler):
    """Stands for a default callback, which logs that types or QoS are incompatible.

    The context itself reports this, once for each pair of endpoints, so no executor waits for it.
    """

    def __init__(self, event_type: IntEnum) -> None:
        self.event_type = event_type
        self.callback = print

    def destroy(self) -> None:
        """Do nothing."""


def create_handlers(
    group: CallbackGroup,
    parent: PublisherHandle | SubscriptionHandle,
    callbacks: Any,
    watches: dict[IntEnum, type[Watch]],
) -> list[EventHandler]:
    """Return a handler for each callback that was given, or has a default.

    Args:
        group: The group of the callbacks.
        parent: What the events happen to.
        callbacks: What a program gave for them.
        watches: The kinds of events of such an endpoint.
    """
    handlers: list[EventHandler] = []
    for event_type, watch in watches.items():
        callback = getattr(callbacks, watch.name)
        if callback:
            handlers.append(
                EventHandler(
                    callback_group=group,
                    callback=callback,
                    event_type=event_type,
                    parent_impl=parent,
                )
            )
        elif callbacks.use_default_callbacks and watch.aspects:
            handlers.append(DefaultHandler(event_type))
    return handlers


class SubscriptionEventCallbacks(events.SubscriptionEventCallbacks):
    """Callbacks for the events of a subscription; each is called with a status."""

    def create_event_handlers(
        self, callback_group: CallbackGroup, subscription: SubscriptionHandle, topic_name: str
    ) -> list[EventHandler]:
        """Return the handlers of a subscription."""
        return create_handlers(callback_group, subscription, self, SUBSCRIPTION_WATCHES)


class PublisherEventCallbacks(events.PublisherEventCallbacks):
    """Callbacks for the events of a publisher; each is called with a status."""

    def create_event_handlers(
        self, callback_group: CallbackGroup, publisher: PublisherHandle, topic_name: str
    ) -> list[EventHandler]:
        """Return the handlers of a publisher."""
        return create_handlers(callback_group, publisher, self, PUBLISHER_WATCHES)
