"""The liveliness of each publisher of a subscription."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from aionode.clock import SilenceAlarm
from aionode.engine.rules.event_records import QoSLivelinessChangedInfo
from aionode.qos import LivelinessPolicy, is_unlimited

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import TimeBase
    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile

__all__ = ["PublisherLiveliness"]


class Lease:
    """One publisher, as seen by a subscription.

    Attributes:
        alarm: Rings when its lease expires; None without a limit.
        manual: Whether messages and assertions are the only signs of its life.
        asserts: Whether it has sent assertions before, so that their absence means something.
        alive: Whether it is alive; None before its first sign of life.
    """

    __slots__ = ("alarm", "alive", "asserts", "manual")

    def __init__(self, alarm: SilenceAlarm | None, *, manual: bool) -> None:
        self.alarm = alarm
        self.manual = manual
        self.asserts = False
        self.alive: bool | None = None


class PublisherLiveliness:
    """Tracks the lease that a subscription requests, for each of its publishers.

    A publisher with liveliness AUTOMATIC is alive while it is in the graph. An aionode publisher
    with a lease of its own is also asserted by its process, and is no longer alive when that stops.
    A publisher with MANUAL_BY_TOPIC becomes alive with its first message or assertion, and must
    send another within the lease. Without a limit, publishers are alive while they are in the
    graph.

    Args:
        time_base: The time base.
        qos: The profile of the subscription.
        emit: Called with each event.
    """

    def __init__(
        self,
        time_base: TimeBase,
        qos: QoSProfile,
        emit: Callable[[QoSLivelinessChangedInfo], None],
    ) -> None:
        lease = qos.liveliness_lease_duration
        self._lease_ns = 0 if is_unlimited(lease) else lease.nanoseconds
        self._time_base = time_base
        self._emit = emit
        self._leases: dict[bytes, Lease] = {}
        self._alive = 0
        self._not_alive = 0
        self._runs = False

    def start(self) -> None:
        """Start to enforce the leases, as an event loop is running now."""
        self._runs = True
        for lease in self._leases.values():
            if lease.alarm is not None:
                lease.alarm.start()

    def stop(self) -> None:
        """Stop enforcing the leases."""
        for lease in self._leases.values():
            if lease.alarm is not None:
                lease.alarm.stop()
        self._leases.clear()

    def add(self, publisher: EndpointInfo) -> None:
        """Watch a matched publisher."""
        if publisher.gid in self._leases:
            return
        alarm = None
        if self._lease_ns:
            on_silence = partial(self._on_silence, publisher.gid)
            alarm = SilenceAlarm(self._time_base, self._lease_ns, on_silence)
            if self._runs:
                alarm.start()
        manual = publisher.qos.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
        lease = self._leases[publisher.gid] = Lease(alarm, manual=manual and alarm is not None)
        if not lease.manual:
            self._set_alive(lease)

    def remove(self, publisher: EndpointInfo) -> None:
        """Forget a publisher that has left."""
        lease = self._leases.pop(publisher.gid, None)
        if lease is None:
            return
        if lease.alarm is not None:
            lease.alarm.stop()
        if lease.alive is not None:
            self._change(-lease.alive, lease.alive - 1)

    def note_message(self, gid: bytes) -> None:
        """Count a message as a sign of life."""
        lease = self._leases.get(gid)
        if lease is not None and (lease.manual or lease.asserts):
            self._renew(lease)

    def note_assertion(self, gid: bytes) -> None:
        """Count an assertion as a sign of life."""
        lease = self._leases.get(gid)
        if lease is not None:
            lease.asserts = True
            self._renew(lease)

    def _renew(self, lease: Lease) -> None:
        if lease.alarm is not None:
            lease.alarm.note()
        if not lease.alive:
            self._set_alive(lease)

    def _set_alive(self, lease: Lease) -> None:
        was_dead = lease.alive is False
        lease.alive = True
        self._change(1, -was_dead)

    def _on_silence(self, gid: bytes, periods: int) -> bool:  # noqa: ARG002  # one is enough
        lease = self._leases.get(gid)
        if lease is not None and lease.alive:
            lease.alive = False
            self._change(-1, 1)
        return False

    def _change(self, alive: int, not_alive: int) -> None:
        self._alive += alive
        self._not_alive += not_alive
        self._emit(QoSLivelinessChangedInfo(self._alive, self._not_alive, alive, not_alive))
