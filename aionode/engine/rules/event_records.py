"""Events of publishers and subscriptions, as values: the names and fields of `rclpy.event_handler`.

An event tells what has changed since the one before it (``…_change``), and the total since the
endpoint was created.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

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


@dataclass(frozen=True, slots=True)
class QoSOfferedDeadlineMissedInfo:
    """A publisher published nothing for as long as its deadline.

    Attributes:
        total_count: How many such periods there were.
        total_count_change: How many of them are new.
    """

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSRequestedDeadlineMissedInfo:
    """A subscription received nothing for as long as its deadline.

    Attributes:
        total_count: How many such periods there were.
        total_count_change: How many of them are new.
    """

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSLivelinessLostInfo:
    """A publisher with liveliness MANUAL_BY_TOPIC gave no sign of life within its lease.

    Attributes:
        total_count: How often that happened.
        total_count_change: How often it happened since the last event.
    """

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSLivelinessChangedInfo:
    """A publisher of the topic came to life, lost its liveliness, or has gone.

    Attributes:
        alive_count: How many matched publishers are alive.
        not_alive_count: How many gave no sign of life within the lease of the subscription.
        alive_count_change: By how much `alive_count` has changed; negative if it fell.
        not_alive_count_change: By how much `not_alive_count` has changed.
    """

    alive_count: int
    not_alive_count: int
    alive_count_change: int
    not_alive_count_change: int


@dataclass(frozen=True, slots=True)
class QoSMessageLostInfo:
    """Messages are missing in the sequence numbers of a publisher.

    Attributes:
        total_count: How many are missing in all.
        total_count_change: How many of them are new.
    """

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class QoSRequestedIncompatibleQoSInfo:
    """An endpoint appeared whose QoS does not fit.

    Attributes:
        total_count: How many there were.
        total_count_change: How many of them are new.
        last_policy_kind: A policy that does not fit; the last one, if there are several.
    """

    total_count: int
    total_count_change: int
    last_policy_kind: QoSPolicyKind


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo


@dataclass(frozen=True, slots=True)
class IncompatibleTypeInfo:
    """An endpoint appeared whose type is another, or another definition of the same name.

    Attributes:
        total_count: How many there were.
        total_count_change: How many of them are new.
    """

    total_count: int
    total_count_change: int


@dataclass(frozen=True, slots=True)
class MatchedInfo:
    """A counterpart was matched, or has gone.

    Attributes:
        total_count: How many have been matched in all.
        total_count_change: How many of them are new.
        current_count: How many are matched now.
        current_count_change: By how much `current_count` has changed; negative if it fell.
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


# Callbacks, which a face calls


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
