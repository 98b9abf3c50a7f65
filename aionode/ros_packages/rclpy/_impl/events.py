"""The events of publishers and subscriptions: matches, missed deadlines, lost messages.

The thread of the context counts the statuses and keeps the time of deadlines and leases; executors
take them like items of other waitables.
"""

from __future__ import annotations

from enum import Enum, IntEnum
from functools import partial
from typing import TYPE_CHECKING, Any

from msgspec import structs

from aionode._process.recent import Recent
from aionode.clock import SilenceAlarm
from aionode.engine.rules.event_records import (
    IncompatibleTypeInfo,
    MatchedInfo,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
)
from aionode.engine.rules.liveliness import PublisherLiveliness
from aionode.engine.rules.matching import Matching
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS, missing_before
from aionode.qos import LivelinessPolicy, QoSPolicyKind, is_unlimited
from rclpy._impl.destroyable import Destroyable
from rclpy._impl.topics import PublisherHandle, SubscriptionHandle

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Duration
    from aionode.engine.transport.base import SampleInfo
    from aionode.graph import EndpointInfo

__all__ = [
    "PUBLISHER_WATCHES",
    "SUBSCRIPTION_WATCHES",
    "EventHandle",
    "PublisherEventType",
    "SubscriptionEventType",
    "Watch",
]


class PublisherEventType(IntEnum):
    """The kinds of events of a publisher."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class SubscriptionEventType(IntEnum):
    """The kinds of events of a subscription."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class EventHandle(Destroyable):
    """One kind of event of a publisher or subscription."""

    def __init__(self, parent: PublisherHandle | SubscriptionHandle, event_type: IntEnum) -> None:
        super().__init__(parent.signal)
        self._io = parent.io
        watches = PUBLISHER_WATCHES if isinstance(parent, PublisherHandle) else SUBSCRIPTION_WATCHES
        self._watch = watches[event_type](parent, self.signal.notify)
        self._io.call(self._watch.start)

    def ready(self) -> bool:
        """Return whether there is an event that was not taken."""
        return self._watch.changed and not self._unwanted

    def take_event(self) -> Any:
        """Return the status; its changes are counted anew from now on."""
        return self._io.call(self._watch.take)

    def _destroy(self) -> None:
        if hasattr(self, "_watch"):
            self._io.post(self._watch.stop)


class rmw_qos_policy_kind_t(IntEnum):  # noqa: N801  # rmw's name, which its text shows
    """The kinds of policies named by events."""

    RMW_QOS_POLICY_INVALID = 1
    RMW_QOS_POLICY_DURABILITY = 2
    RMW_QOS_POLICY_DEADLINE = 4
    RMW_QOS_POLICY_LIVELINESS = 8
    RMW_QOS_POLICY_RELIABILITY = 16
    RMW_QOS_POLICY_HISTORY = 32
    RMW_QOS_POLICY_LIFESPAN = 64
    RMW_QOS_POLICY_DEPTH = 128
    RMW_QOS_POLICY_LIVELINESS_LEASE_DURATION = 256
    RMW_QOS_POLICY_AVOID_ROS_NAMESPACE_CONVENTIONS = 512

    __str__ = Enum.__str__  # as rclpy prints it


class Watch:
    """Keeps the status of one kind of event; used in the thread of the context.

    Attributes:
        name: The kind of event, as named by the arguments of event callbacks.
        empty: The status before anything has happened.
        aspects: The mismatches reported to its callback, or otherwise logged.
    """

    name = ""
    empty: Any = None
    aspects: tuple[str, ...] = ()

    def __init__(
        self, parent: PublisherHandle | SubscriptionHandle, notify: Callable[[], None]
    ) -> None:
        # Not the handle itself, which becomes garbage once its user has dropped it.
        self.feed = parent.feed
        self.assertions = parent.assertions
        self.graph = parent.io.context.graph
        self.time_base = parent.io.context.time_base
        self.endpoint = parent.endpoint
        self.changed = False  # executors read it, to request the status in this thread
        self.status = self.empty
        self.ends: list[Callable[[], object]] = []
        self._notify = notify

    def start(self) -> None:
        """Start to watch, and add the function that ends it to `ends`."""

    def stop(self) -> None:
        """Stop watching."""
        for end in self.ends:
            end()

    def tell(self, event: Any) -> None:
        """Handle an event whose status has its own counts; changes add up until they are taken."""
        added = {
            name: getattr(self.status, name) + getattr(event, name) for name in changes_in(event)
        }
        self.status = structs.replace(event, **added)
        self.changed = True
        self._notify()

    def count(self, more: int) -> None:
        """Handle an event of a status that counts one thing, given the increment."""
        self.tell(type(self.empty)(self.status.total_count + more, more))

    def take(self) -> Any:
        """Return the status, and reset its changes."""
        status = self.status
        self.status = structs.replace(status, **dict.fromkeys(changes_in(status), 0))
        self.changed = False
        return status

    def alarm(self, longest: Duration, on_silence: Callable[[int], bool]) -> SilenceAlarm:
        """Return a running alarm: `on_silence` gets the number of periods that have passed."""
        alarm = SilenceAlarm(self.time_base, longest.nanoseconds, on_silence)
        alarm.start()
        self.ends.append(alarm.stop)
        return alarm

    def listen(self, listeners: list[Any], listener: Callable[[Any], None]) -> None:
        """Report messages or assertions to `listener`."""
        listeners.append(listener)
        self.ends.append(partial(listeners.remove, listener))

    def watch_opposites(self, watcher: Callable[[EndpointInfo, bool], None]) -> None:
        """Call `watcher` when endpoints of the opposite kind appear or leave."""
        endpoint = self.endpoint
        self.ends.append(self.graph.watch(endpoint.kind.opposite, endpoint.name, watcher))


def changes_in(status: Any) -> list[str]:
    """Return the names of the status fields that hold changes."""
    return [name for name in status.__struct_fields__ if name.endswith("_change")]


class MatchedWatch(Watch):
    """Counts the endpoints that match, or are incompatible."""

    name = "matched"
    empty = MatchedInfo(0, 0, 0, 0)

    def start(self) -> None:
        """Start to watch."""
        if self.aspects:
            unreported = self.graph.unreported
            unreported[self.endpoint] = {*unreported.get(self.endpoint, ()), *self.aspects}
            self.ends.append(lambda: unreported.pop(self.endpoint, None))
        self.watch_opposites(Matching(self.endpoint, self._on_event).note)

    def _on_event(self, name: str, event: Any) -> None:
        if name == self.name:
            self.tell(event)


class IncompatibleQoSWatch(MatchedWatch):
    """Counts endpoints with incompatible QoS."""

    name = "incompatible_qos"
    empty: Any = QoSRequestedIncompatibleQoSInfo(0, 0, QoSPolicyKind.INVALID)
    aspects = ("qos",)

    def take(self) -> Any:
        """Return the status, with the kind of policy as ROS 2 prints it."""
        status = super().take()
        return structs.replace(
            status, last_policy_kind=rmw_qos_policy_kind_t(status.last_policy_kind)
        )


class IncompatibleTypeWatch(MatchedWatch):
    """Counts endpoints of another type."""

    name = "incompatible_type"
    empty: Any = IncompatibleTypeInfo(0, 0)
    aspects = ("type", "definition")


class DeadlineWatch(Watch):
    """Counts the periods without a message, from the first message on."""

    name = "deadline"
    empty: Any = QoSRequestedDeadlineMissedInfo(0, 0)

    def start(self) -> None:
        """Start to watch."""
        deadline = self.endpoint.qos.deadline
        if not is_unlimited(deadline):
            alarm = self.alarm(deadline, self._on_silence)
            self.listen(self.feed, lambda _: alarm.note())

    def _on_silence(self, periods: int) -> bool:
        self.count(periods)
        return True


class OfferedDeadlineWatch(DeadlineWatch):
    """Counts the periods in which nothing was published."""

    empty = QoSOfferedDeadlineMissedInfo(0, 0)


class LivelinessLostWatch(Watch):
    """Counts the leases that a publisher has let expire; asserting or publishing renews them."""

    name = "liveliness"
    empty = QoSLivelinessLostInfo(0, 0)

    def start(self) -> None:
        """Start to watch."""
        qos = self.endpoint.qos
        manual = qos.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
        if manual and not is_unlimited(qos.liveliness_lease_duration):
            alarm = self.alarm(qos.liveliness_lease_duration, self._on_lapse)
            alarm.note()
            self.listen(self.feed, lambda _: alarm.note())

    def _on_lapse(self, periods: int) -> bool:
        self.count(1)
        return False  # once, until the next sign of life


class LivelinessChangedWatch(Watch):
    """Counts the publishers that are alive, and those whose lease has expired."""

    name = "liveliness"
    empty = QoSLivelinessChangedInfo(0, 0, 0, 0)

    def start(self) -> None:
        """Start to watch."""
        liveliness = PublisherLiveliness(self.time_base, self.endpoint.qos, self.tell)
        liveliness.start()
        self.ends.append(liveliness.stop)

        def note(publisher: EndpointInfo, present: bool) -> None:
            if self.endpoint.matches(publisher):
                (liveliness.add if present else liveliness.remove)(publisher)

        def note_message(sample_info: SampleInfo) -> None:
            liveliness.note_message(sample_info.gid)

        self.listen(self.feed, note_message)
        self.listen(self.assertions, liveliness.note_assertion)
        self.watch_opposites(note)


class MessageLostWatch(Watch):
    """Counts the gaps in the sequence numbers of each publisher."""

    name = "message_lost"
    empty = QoSMessageLostInfo(0, 0)

    def start(self) -> None:
        """Start to watch."""
        last: Recent[bytes, int] = Recent(REMEMBERED_PUBLISHERS)

        def note(sample_info: SampleInfo) -> None:
            missing = missing_before(last, sample_info.gid, sample_info.sequence)
            if missing:
                self.count(missing)

        self.listen(self.feed, note)


# In the order in which rclpy creates the handlers of one endpoint.
PUBLISHER_WATCHES: dict[IntEnum, type[Watch]] = {
    PublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: OfferedDeadlineWatch,
    PublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST: LivelinessLostWatch,
    PublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: IncompatibleQoSWatch,
    PublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE: IncompatibleTypeWatch,
    PublisherEventType.RCL_PUBLISHER_MATCHED: MatchedWatch,
}
SUBSCRIPTION_WATCHES: dict[IntEnum, type[Watch]] = {
    SubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: DeadlineWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: IncompatibleQoSWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: LivelinessChangedWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST: MessageLostWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: IncompatibleTypeWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_MATCHED: MatchedWatch,
}
