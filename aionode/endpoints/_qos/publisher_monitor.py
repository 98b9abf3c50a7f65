"""Enforces a publisher's QoS: asserts its liveliness, and notices missed deadlines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.clock import SilenceAlarm
from aionode.endpoints._qos.event_hub import EventHub
from aionode.endpoints.events import (
    PublisherEventCallbacks,
    QoSLivelinessLostInfo,
    QoSOfferedDeadlineMissedInfo,
)
from aionode.engine.rules.matching import Matching
from aionode.qos import LivelinessPolicy, is_unlimited

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.clock import Alarm, TimeBase
    from aionode.endpoints.core.endpoint import Endpoint
    from aionode.endpoints.events import EventStream
    from aionode.engine.transport.base import Writer

__all__ = ["PublisherMonitor"]

ASSERTIONS_IN_LEASE = 3
"""Assertions of AUTOMATIC liveliness per lease: two may be lost."""


class PublisherMonitor(EventHub):
    """Monitors one publisher, and emits its events.

    Args:
        entity: The publisher.
        time_base: The source of time.
        event_callbacks: The event callbacks that the program passed.

    Raises:
        TypeError: `event_callbacks` is of another class, or a function in it takes other arguments.
    """

    __slots__ = (
        "_alarms",
        "_entity",
        "_heartbeat",
        "_lease_alarm",
        "_lease_ns",
        "_lost",
        "_manual",
        "_missed",
        "_time_base",
        "_watches_matches",
        "_writers",
    )

    def __init__(
        self,
        entity: Endpoint,
        time_base: TimeBase,
        event_callbacks: PublisherEventCallbacks | None,
    ) -> None:
        super().__init__(entity, event_callbacks, PublisherEventCallbacks)
        self._entity = entity
        self._time_base = time_base
        self._writers: Sequence[Writer] = ()  # its writers in the transports
        self._missed = 0
        self._lost = 0
        qos = entity.qos_profile
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

    def note_message(self, sequence: int) -> None:  # noqa: ARG002  # as a `NotingWriter` calls it
        """Count a published message as a sign of life."""
        for alarm in self._alarms:
            alarm.note()

    def events(self) -> EventStream[Any]:
        """Return the stream of all events."""
        self._watch_matches()
        return self.stream()

    def start(self, writers: Sequence[Writer]) -> None:
        """Start monitoring, and asserting AUTOMATIC liveliness through `writers`."""
        self._writers = writers
        for alarm in self._alarms:
            alarm.start()
        if self._lease_ns and not self._manual:
            self._beat()

    def renew_lease(self) -> None:
        """Record that the program asserts the publisher's liveliness."""
        if self._lease_alarm is not None:
            self._lease_alarm.note()

    def close(self) -> None:
        """Stop monitoring."""
        for alarm in self._alarms:
            alarm.stop()
        if self._heartbeat is not None:
            self._heartbeat.cancel()
        super().close()

    def _watch_matches(self) -> None:
        if not self._watches_matches:
            self._watches_matches = True
            self._entity._watch(Matching(self._entity._endpoint, self.emit).note)

    def _beat(self) -> None:
        """Assert AUTOMATIC liveliness periodically."""
        for writer in self._writers:
            writer.assert_liveliness()
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
