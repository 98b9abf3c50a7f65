"""Callbacks for events of publishers and subscriptions themselves."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from aionode.endpoints import events
from aionode.endpoints.events import (
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
from aionode.rclpy._impl.errors import UnsupportedEventTypeError
from aionode.rclpy._impl.events import EventHandle, PublisherEventType, SubscriptionEventType
from aionode.rclpy.waitable import NumberOfEntities, Waitable

if TYPE_CHECKING:
    from collections.abc import Callable
    from enum import IntEnum

    from aionode.rclpy._impl.topics import PublisherHandle, SubscriptionHandle
    from aionode.rclpy._impl.wait_set import WaitSet
    from aionode.rclpy.callback_groups import CallbackGroup

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

PUBLISHER_KINDS: dict[str, IntEnum] = {
    "deadline": PublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED,
    "liveliness": PublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST,
    "incompatible_qos": PublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS,
    "incompatible_type": PublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE,
    "matched": PublisherEventType.RCL_PUBLISHER_MATCHED,
}

SUBSCRIPTION_KINDS: dict[str, IntEnum] = {
    "deadline": SubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED,
    "incompatible_qos": SubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS,
    "liveliness": SubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED,
    "message_lost": SubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST,
    "incompatible_type": SubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE,
    "matched": SubscriptionEventType.RCL_SUBSCRIPTION_MATCHED,
}

WITH_DEFAULTS = ("incompatible_qos", "incompatible_type")
"""The events that are logged where no callback is given for them."""


class EventHandler(Waitable[Any]):
    """Has an executor call `callback` when something has happened.

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
        self._index: int | None = None
        self._ready_to_take_data = False

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Return whether something has happened."""
        if self._index is not None and wait_set.is_ready("event", self._index):
            self._ready_to_take_data = True
        return self._ready_to_take_data

    def take_data(self) -> Any:
        """Return the status, or None if nothing has happened."""
        if not self._ready_to_take_data:
            return None
        self._ready_to_take_data = False
        with self._event:
            return self._event.take_event()

    async def execute(self, taken_data: Any) -> None:
        """Call the callback."""
        if taken_data is not None:
            result = self.callback(taken_data)
            if hasattr(result, "__await__"):
                await result

    def get_num_entities(self) -> NumberOfEntities:
        """Return how many handles it adds to a wait set: one."""
        return NumberOfEntities(num_events=1)

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Add its handle."""
        with self._event:
            self._index = wait_set.add_event(self._event)

    def __enter__(self) -> None:
        self._event.__enter__()

    def __exit__(self, *exc: object) -> None:
        self._event.__exit__(*exc)

    def destroy(self) -> None:
        """Destroy it; its publisher or subscription does that."""
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
    """Stands for a default callback, which logs that types or QoS do not fit.

    The context itself reports that, once for each pair of endpoints, so no executor waits for it.
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
    kinds: dict[str, IntEnum],
) -> list[EventHandler]:
    """Return a handler for each callback that is given, or has a default.

    Args:
        group: The group of the callbacks.
        parent: What the events happen to.
        callbacks: What a program gave for them.
        kinds: The kind of event that each attribute of `callbacks` is called for.
    """
    made: list[EventHandler] = []
    for name, event_type in kinds.items():
        callback = getattr(callbacks, name)
        if callback:
            made.append(
                EventHandler(
                    callback_group=group,
                    callback=callback,
                    event_type=event_type,
                    parent_impl=parent,
                )
            )
        elif callbacks.use_default_callbacks and name in WITH_DEFAULTS:
            made.append(DefaultHandler(event_type))
    return made


class SubscriptionEventCallbacks(events.SubscriptionEventCallbacks):
    """Callbacks for the events of a subscription; each gets a status."""

    def create_event_handlers(
        self, callback_group: CallbackGroup, subscription: SubscriptionHandle, topic_name: str
    ) -> list[EventHandler]:
        """Return the handlers of a subscription."""
        return create_handlers(callback_group, subscription, self, SUBSCRIPTION_KINDS)


class PublisherEventCallbacks(events.PublisherEventCallbacks):
    """Callbacks for the events of a publisher; each gets a status."""

    def create_event_handlers(
        self, callback_group: CallbackGroup, publisher: PublisherHandle, topic_name: str
    ) -> list[EventHandler]:
        """Return the handlers of a publisher."""
        return create_handlers(callback_group, publisher, self, PUBLISHER_KINDS)
