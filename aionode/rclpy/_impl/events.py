"""What happens to publishers and subscriptions: matches, missed deadlines, lost messages.

The statuses are counted in the thread of the context, which also keeps the time of deadlines and
leases; executors take them as those of other waitables.
"""

from __future__ import annotations

from dataclasses import fields, replace
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from aionode.clock import SilenceAlarm
from aionode.endpoints.events import (
    IncompatibleTypeInfo,
    MatchedInfo,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSMessageLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
)
from aionode.graph import EndpointKind
from aionode.qos import LivelinessPolicy, QoSPolicyKind, is_unlimited
from aionode.rclpy._impl.destroyable import Destroyable
from aionode.rclpy._impl.topics import PublisherHandle, SubscriptionHandle

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Duration
    from aionode.graph import EndpointInfo
    from aionode.transport.base import SampleInfo

__all__ = ["EventHandle", "PublisherEventType", "SubscriptionEventType"]


class PublisherEventType(IntEnum):
    """What can happen to a publisher."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class SubscriptionEventType(IntEnum):
    """What can happen to a subscription."""

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
        """Return whether something has happened that was not taken."""
        return self._watch.changed and not self._unwanted

    def take_event(self) -> Any:
        """Return the status; its changes count from now on."""
        return self._io.call(self._watch.take)

    def _destroy(self) -> None:
        if hasattr(self, "_watch"):
            self._io.post(self._watch.stop)


class rmw_qos_policy_kind_t(IntEnum):  # noqa: N801  # rmw's name, which its text shows
    """The kinds of policies, as events name them."""

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

    def __str__(self) -> str:
        return f"{type(self).__name__}.{self.name}"


class Watch:
    """Counts one kind of event; lives in the thread of the context."""

    empty: Any = None

    def __init__(
        self, parent: PublisherHandle | SubscriptionHandle, notify: Callable[[], None]
    ) -> None:
        # Not the handle itself, which is garbage once its user has dropped it.
        self.bare = parent.bare
        self.feed = parent.feed
        self.assertions = parent.assertions
        self.graph = parent.io.context.graph
        self.io = parent.io
        self.endpoint = parent.endpoint
        self.changed = False
        self.status = self.empty
        self._notify = notify

    def start(self) -> None:
        """Begin to watch."""

    def stop(self) -> None:
        """Watch no longer."""

    def count(self, **changes: int | QoSPolicyKind) -> None:
        """Change the status: counts by these numbers, other attributes to these values."""
        values: dict[str, Any] = {}
        for name, value in changes.items():
            if isinstance(value, QoSPolicyKind):
                values[name] = value
                continue
            values[name] = getattr(self.status, name) + value
            values[f"{name}_change"] = getattr(self.status, f"{name}_change") + value
        self.status = replace(self.status, **values)
        self.changed = True
        self._notify()

    def alarm(self, longest: Duration, on_silence: Callable[[int], bool]) -> SilenceAlarm:
        """Return an alarm that runs: `on_silence` gets the periods that have passed."""
        alarm = SilenceAlarm(self.io.context.time_base, longest.nanoseconds, on_silence)
        alarm.start()
        return alarm

    def take(self) -> Any:
        """Return the status, and reset its changes."""
        status = self.status
        zeros = {each.name: 0 for each in fields(status) if each.name.endswith("_change")}
        self.status = replace(status, **zeros)
        self.changed = False
        return status


class MatchedWatch(Watch):
    """Counts matched endpoints."""

    empty = MatchedInfo(0, 0, 0, 0)

    def start(self) -> None:
        """Begin to watch."""
        self._matched: set[EndpointInfo] = set()
        self.io.watch_graph(self.look)
        self.look()

    def stop(self) -> None:
        """Watch no longer."""
        self.io.unwatch_graph(self.look)

    def look(self) -> None:
        """Compare what is matched now with what was."""
        matched = set(self.bare.matched())
        new = len(matched - self._matched)
        change = len(matched) - len(self._matched)
        self._matched = matched
        if new or change:
            self.count(total_count=new, current_count=change)


class MismatchWatch(Watch):
    """Counts endpoints that cannot be matched."""

    aspects: tuple[str, ...] = ()

    def start(self) -> None:
        """Begin to watch."""
        self._seen: set[EndpointInfo] = set()
        unreported = self.graph.unreported
        unreported[self.endpoint] = {*unreported.get(self.endpoint, ()), *self.aspects}
        self.io.watch_graph(self.look)
        self.look()

    def stop(self) -> None:
        """Watch no longer."""
        self.graph.unreported.pop(self.endpoint, None)
        self.io.unwatch_graph(self.look)

    def look(self) -> None:
        """Count endpoints that are new."""
        for other in self.graph.endpoints(self.endpoint.kind.opposite, name=self.endpoint.name):
            if other in self._seen or self.endpoint.matches(other):
                continue
            self._seen.add(other)
            found = self.endpoint.compare(other)
            if found is not None and found.aspect in self.aspects:
                self.note(found.policy)

    def note(self, policy: QoSPolicyKind) -> None:
        """Count one."""
        self.count(total_count=1)


class IncompatibleQoSWatch(MismatchWatch):
    """Counts endpoints whose QoS does not fit."""

    aspects = ("qos",)
    empty = QoSRequestedIncompatibleQoSInfo(0, 0, QoSPolicyKind.INVALID)

    def note(self, policy: QoSPolicyKind) -> None:
        """Count one."""
        self.count(total_count=1, last_policy_kind=policy)

    def take(self) -> Any:
        """Return the status, with the kind of policy as ROS 2 prints it."""
        status = super().take()
        return replace(status, last_policy_kind=rmw_qos_policy_kind_t(status.last_policy_kind))


class IncompatibleTypeWatch(MismatchWatch):
    """Counts endpoints of another type."""

    aspects = ("type", "definition")
    empty = IncompatibleTypeInfo(0, 0)


class DeadlineWatch(Watch):
    """Counts the periods without a message, from the first message on."""

    empty: Any = QoSRequestedDeadlineMissedInfo(0, 0)

    def start(self) -> None:
        """Begin to watch."""
        deadline = self.endpoint.qos.deadline
        self._alarm: SilenceAlarm | None = None
        if not is_unlimited(deadline):
            self._alarm = self.alarm(deadline, self._on_silence)
            self.feed.append(self._on_message)

    def _on_message(self, sample_info: SampleInfo | None) -> None:
        if self._alarm is not None:
            self._alarm.note()

    def _on_silence(self, periods: int) -> bool:
        self.count(total_count=periods)
        return True

    def stop(self) -> None:
        """Watch no longer."""
        if self._alarm is not None:
            self._alarm.stop()
            self.feed.remove(self._on_message)


class OfferedDeadlineWatch(DeadlineWatch):
    """Counts the periods in which nothing was published."""

    empty = QoSOfferedDeadlineMissedInfo(0, 0)


class LivelinessLostWatch(Watch):
    """Counts the leases that a publisher has let pass; asserting or publishing renews them."""

    empty = QoSLivelinessLostInfo(0, 0)

    def start(self) -> None:
        """Begin to watch."""
        qos = self.endpoint.qos
        self._alarm: SilenceAlarm | None = None
        if is_manual(self.endpoint):
            self._alarm = self.alarm(qos.liveliness_lease_duration, self._on_lapse)
            self._alarm.note()
            self.feed.append(self._on_sign)

    def _on_sign(self, sample_info: SampleInfo | None) -> None:
        if self._alarm is not None:
            self._alarm.note()

    def _on_lapse(self, periods: int) -> bool:
        self.count(total_count=1)
        return False  # once, until the next sign

    def stop(self) -> None:
        """Watch no longer."""
        if self._alarm is not None:
            self._alarm.stop()
            self.feed.remove(self._on_sign)


class LivelinessChangedWatch(Watch):
    """Counts the publishers that are alive, and those that let their lease pass.

    A publisher shows that it is alive by being there, or, with a manual policy, by its messages
    and assertions.
    """

    empty = QoSLivelinessChangedInfo(0, 0, 0, 0)

    def start(self) -> None:
        """Begin to watch."""
        self._publishers: dict[bytes, SilenceAlarm | None] = {}
        self._lapsed: set[bytes] = set()
        self.feed.append(self._on_message)
        self.assertions.append(self._on_sign)
        self.io.watch_graph(self.look)
        self.look()

    def look(self) -> None:
        """Compare the publishers with those that were there."""
        matched = {publisher.gid: publisher for publisher in self.bare.matched()}
        for gid, publisher in matched.items():
            if gid not in self._publishers:
                self._publishers[gid] = self._alarm_of(publisher)
                self.count(alive_count=1)
        for gid in [gid for gid in self._publishers if gid not in matched]:
            alarm = self._publishers.pop(gid)
            if alarm is not None:
                alarm.stop()
            if gid in self._lapsed:
                self._lapsed.discard(gid)
                self.count(not_alive_count=-1)
            else:
                self.count(alive_count=-1)

    def _alarm_of(self, publisher: EndpointInfo) -> SilenceAlarm | None:
        if not is_manual(publisher):
            return None
        lease = publisher.qos.liveliness_lease_duration
        alarm = self.alarm(lease, lambda _: self._on_lapse(publisher.gid))
        alarm.note()
        return alarm

    def _on_lapse(self, gid: bytes) -> bool:
        self._lapsed.add(gid)
        self.count(alive_count=-1, not_alive_count=1)
        return False  # once, until the next sign

    def _on_message(self, sample_info: SampleInfo | None) -> None:
        if sample_info is not None:
            self._on_sign(sample_info.gid)

    def _on_sign(self, gid: bytes) -> None:
        alarm = self._publishers.get(gid)
        if alarm is not None:
            alarm.note()
        if gid in self._lapsed:
            self._lapsed.discard(gid)
            self.count(alive_count=1, not_alive_count=-1)

    def stop(self) -> None:
        """Watch no longer."""
        self.io.unwatch_graph(self.look)
        self.feed.remove(self._on_message)
        self.assertions.remove(self._on_sign)
        for alarm in self._publishers.values():
            if alarm is not None:
                alarm.stop()


class MessageLostWatch(Watch):
    """Counts the gaps in what each publisher has numbered."""

    empty = QoSMessageLostInfo(0, 0)

    def start(self) -> None:
        """Begin to watch."""
        self._last: dict[bytes, int] = {}
        self.feed.append(self._on_message)

    def _on_message(self, sample_info: SampleInfo | None) -> None:
        if sample_info is None:
            return
        last = self._last.get(sample_info.gid)
        self._last[sample_info.gid] = sample_info.sequence
        if last is not None and sample_info.sequence > last + 1:
            self.count(total_count=sample_info.sequence - last - 1)

    def stop(self) -> None:
        """Watch no longer."""
        self.feed.remove(self._on_message)


def is_manual(publisher: EndpointInfo) -> bool:
    """Whether a publisher has to show now and then that it is alive."""
    qos = publisher.qos
    return (
        publisher.kind is EndpointKind.PUBLISHER
        and qos.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
        and not is_unlimited(qos.liveliness_lease_duration)
    )


PUBLISHER_WATCHES: dict[int, type[Watch]] = {
    PublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: OfferedDeadlineWatch,
    PublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST: LivelinessLostWatch,
    PublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: IncompatibleQoSWatch,
    PublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE: IncompatibleTypeWatch,
    PublisherEventType.RCL_PUBLISHER_MATCHED: MatchedWatch,
}
SUBSCRIPTION_WATCHES: dict[int, type[Watch]] = {
    SubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: DeadlineWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: LivelinessChangedWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: IncompatibleQoSWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST: MessageLostWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: IncompatibleTypeWatch,
    SubscriptionEventType.RCL_SUBSCRIPTION_MATCHED: MatchedWatch,
}
