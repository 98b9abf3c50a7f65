"""What a publisher has promised: its deadline and its liveliness."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.clock import SilenceAlarm
from aionode.endpoints._qos.event_hub import EventHub
from aionode.endpoints._qos.matching import Matching
from aionode.endpoints.events import (
    PublisherEventCallbacks,
    QoSLivelinessLostInfo,
    QoSOfferedDeadlineMissedInfo,
)
from aionode.qos import LivelinessPolicy, is_unlimited
from aionode.transport.base import Writer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.clock import TimeBase
    from aionode.clock._time_base import Alarm
    from aionode.endpoints._core.graph_entry import GraphEntry
    from aionode.endpoints.events import EventStream

__all__ = ["PublisherMonitor", "SignOfLife"]

ASSERTIONS_IN_LEASE = 3
"""How often AUTOMATIC liveliness is asserted within one lease: two may be lost."""


class SignOfLife(Writer):
    """Stands behind the writers of a publisher, and notes each message that they have taken.

    So publishers without deadline and lease have nothing more to do for each message.

    Args:
        writers: The others.
        check: Checks a message that none of them has use for; raises what `publish` does.
        note: Takes the sign.
    """

    active = True

    def __init__(
        self, writers: Sequence[Writer], check: Callable[[Any], None], note: Callable[[], None]
    ) -> None:
        self._writers = writers
        self._check = check
        self._note = note

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:  # noqa: ARG002  # as every writer
        """Record a message."""
        if not any(writer.active for writer in self._writers):
            self._check(msg)
        self._note()

    def close(self) -> None:
        """There is nothing to withdraw."""


class PublisherMonitor(EventHub):
    """Watches one publisher, and tells of its events.

    Args:
        graph_entry: The publisher.
        time_base: The time.
        event_callbacks: What the program gave for its events.

    Attributes:
        writers: The counterparts of the publisher in the transports.

    Raises:
        TypeError: `event_callbacks` is of another class, or a function in it takes other arguments.
    """

    __slots__ = (
        "_alarms",
        "_graph_entry",
        "_heartbeat",
        "_lease_alarm",
        "_lease_ns",
        "_lost",
        "_manual",
        "_missed",
        "_time_base",
        "_watches_matches",
        "writers",
    )

    def __init__(
        self,
        graph_entry: GraphEntry,
        time_base: TimeBase,
        event_callbacks: PublisherEventCallbacks | None,
    ) -> None:
        super().__init__(graph_entry, event_callbacks, PublisherEventCallbacks)
        self._graph_entry = graph_entry
        self._time_base = time_base
        self.writers: Sequence[Writer] = ()
        self._missed = 0
        self._lost = 0
        qos = graph_entry.endpoint.qos
        self._manual = qos.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
        lease = qos.liveliness_lease_duration
        self._lease_ns = 0 if is_unlimited(lease) else lease.nanoseconds
        self._heartbeat: Alarm | None = None
        self._alarms: list[SilenceAlarm] = []
        if not is_unlimited(qos.deadline):
            self._alarms.append(
                SilenceAlarm(time_base, qos.deadline.nanoseconds, self._on_deadline_missed)
            )
        self._lease_alarm: SilenceAlarm | None = None
        if self._manual and self._lease_ns:
            self._lease_alarm = SilenceAlarm(time_base, self._lease_ns, self._on_lease_over)
            self._alarms.append(self._lease_alarm)
        self._watches_matches = False
        if self.has_listeners:
            self._watch_matches()

    @property
    def needs_signs(self) -> bool:
        """Whether a policy needs `note_message`."""
        return bool(self._alarms)

    def note_message(self) -> None:
        """Take a message as a sign of life."""
        for alarm in self._alarms:
            alarm.note()

    def events(self) -> EventStream[Any]:
        """Return the stream of all events."""
        self._watch_matches()
        return self.stream()

    def start(self) -> None:
        """Begin to watch: the node runs now."""
        for alarm in self._alarms:
            alarm.start()
        if self._lease_ns and not self._manual:
            self._beat()

    def assert_liveliness(self) -> None:
        """Renew the lease, and tell the subscriptions that the publisher is alive."""
        if self._lease_alarm is not None:
            self._lease_alarm.note()
        for writer in self.writers:
            writer.assert_liveliness()

    def close(self) -> None:
        """Watch nothing more."""
        for alarm in self._alarms:
            alarm.stop()
        if self._heartbeat is not None:
            self._heartbeat.cancel()
        super().close()

    def _watch_matches(self) -> None:
        if not self._watches_matches:
            self._watches_matches = True
            self._graph_entry.watch(Matching(self._graph_entry.endpoint, self.emit).note)

    def _beat(self) -> None:
        """Assert AUTOMATIC liveliness, again and again."""
        self.assert_liveliness()
        due_ns = self._time_base.steady_ns() + self._lease_ns // ASSERTIONS_IN_LEASE
        self._heartbeat = self._time_base.call_at(due_ns, self._beat)

    def _on_deadline_missed(self, periods: int) -> bool:
        self._missed += periods
        self.emit("deadline", QoSOfferedDeadlineMissedInfo(self._missed, periods))
        return True

    def _on_lease_over(self, periods: int) -> bool:  # noqa: ARG002  # it is lost once
        self._lost += 1
        self.emit("liveliness", QoSLivelinessLostInfo(self._lost, 1))
        return False
