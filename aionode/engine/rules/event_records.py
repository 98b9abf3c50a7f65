"""Events of publishers and subscriptions as values, with the names of `rclpy.event_handler`.

An event contains the change since the previous one (``…_change``), and the total since the endpoint
was created.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from aionode.qos import QoSPolicyKind

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = [
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


class QoSOfferedDeadlineMissedInfo(Struct, frozen=True):
    """A publisher did not publish within its deadline.

    Attributes:
        total_count: Number of such periods.
        total_count_change: Number of new ones.
    """

    total_count: int
    total_count_change: int


class QoSRequestedDeadlineMissedInfo(Struct, frozen=True):
    """A subscription did not receive anything within its deadline.

    Attributes:
        total_count: Number of such periods.
        total_count_change: Number of new ones.
    """

    total_count: int
    total_count_change: int


class QoSLivelinessLostInfo(Struct, frozen=True):
    """A publisher with liveliness MANUAL_BY_TOPIC did not assert it within its lease.

    Attributes:
        total_count: How often that has happened.
        total_count_change: How often it happened since the last event.
    """

    total_count: int
    total_count_change: int


class QoSLivelinessChangedInfo(Struct, frozen=True):
    """A publisher of the topic became alive, lost its liveliness, or left.

    Attributes:
        alive_count: Number of matched publishers that are alive.
        not_alive_count: Number of those that were silent for longer than the subscription's lease.
        alive_count_change: Change of `alive_count`; negative if it fell.
        not_alive_count_change: Change of `not_alive_count`.
    """

    alive_count: int
    not_alive_count: int
    alive_count_change: int
    not_alive_count_change: int


class QoSMessageLostInfo(Struct, frozen=True):
    """Gaps in the sequence numbers of a publisher show lost messages.

    Attributes:
        total_count: Total number of lost messages.
        total_count_change: Number of new ones.
    """

    total_count: int
    total_count_change: int


class QoSRequestedIncompatibleQoSInfo(Struct, frozen=True):
    """An endpoint with incompatible QoS appeared.

    Attributes:
        total_count: Number of such endpoints.
        total_count_change: Number of new ones.
        last_policy_kind: An incompatible policy; the last one, if there are several.
    """

    total_count: int
    total_count_change: int
    last_policy_kind: QoSPolicyKind


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo


class IncompatibleTypeInfo(Struct, frozen=True):
    """An endpoint appeared with another type, or another definition of the same type.

    Attributes:
        total_count: Number of such endpoints.
        total_count_change: Number of new ones.
    """

    total_count: int
    total_count_change: int


class MatchedInfo(Struct, frozen=True):
    """A counterpart was matched, or left.

    Attributes:
        total_count: Number of counterparts ever matched.
        total_count_change: Number of new ones.
        current_count: Number of counterparts matched now.
        current_count_change: Change of `current_count`; negative if it fell.
    """

    total_count: int
    total_count_change: int
    current_count: int
    current_count_change: int


QoSSubscriptionMatchedInfo = MatchedInfo
QoSPublisherMatchedInfo = MatchedInfo

PublisherEvent = (
    QoSOfferedDeadlineMissedInfo
    | QoSLivelinessLostInfo
    | QoSRequestedIncompatibleQoSInfo
    | IncompatibleTypeInfo
    | MatchedInfo
)
"""The events that `Publisher.events` yields."""

SubscriptionEvent = (
    QoSRequestedDeadlineMissedInfo
    | QoSLivelinessChangedInfo
    | QoSMessageLostInfo
    | QoSRequestedIncompatibleQoSInfo
    | IncompatibleTypeInfo
    | MatchedInfo
)
"""The events that `Subscription.events` yields."""


# Callbacks, to be called by either API


class PublisherEventCallbacks:
    """Callbacks for the events of a publisher, sync or async, each with one argument.

    An exception in one of them ends the node, as in a subscription's callback.

    Args:
        deadline: Called when nothing was published within the deadline.
        liveliness: Called when the publisher did not assert its liveliness within its lease.
        incompatible_qos: Called when a subscription requests more than the publisher offers.
        incompatible_type: Called when a subscription of the topic has another type.
        matched: Called when a subscription is matched, or leaves.
        use_default_callbacks: Whether to log a warning for incompatible subscriptions for which no
            callback is given.
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
    """Callbacks for the events of a subscription, sync or async, each with one argument.

    An exception in one of them ends the node, as in the subscription's own callback.

    Args:
        deadline: Called when nothing was received within the deadline.
        incompatible_qos: Called when a publisher offers less than the subscription requests.
        liveliness: Called when a publisher becomes alive, loses its liveliness, or leaves.
        message_lost: Called when a gap in a publisher's sequence numbers shows lost messages.
        incompatible_type: Called when a publisher of the topic has another type.
        matched: Called when a publisher is matched, or leaves.
        use_default_callbacks: Whether to log a warning for incompatible publishers for which no
            callback is given.
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
