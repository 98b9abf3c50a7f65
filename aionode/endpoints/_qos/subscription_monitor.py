"""Monitors the QoS that a subscription requests: deadline, lifespan, liveliness of publishers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from aionode._process.recent import Recent
from aionode.clock import SilenceAlarm
from aionode.endpoints._qos.event_hub import EventHub
from aionode.endpoints.events import (
    QoSMessageLostInfo,
    QoSRequestedDeadlineMissedInfo,
    SubscriptionEventCallbacks,
)
from aionode.engine.rules.lifespan import NEVER_NS, ExpiringItems, expires_ns
from aionode.engine.rules.liveliness import PublisherLiveliness
from aionode.engine.rules.matching import Matching
from aionode.qos import is_unlimited

if TYPE_CHECKING:
    from collections import deque
    from collections.abc import Callable

    from aionode.clock import Alarm, Duration, TimeBase
    from aionode.endpoints.core.endpoint import Endpoint
    from aionode.endpoints.events import EventStream
    from aionode.endpoints.stats import CallbackStats
    from aionode.engine.transport.base import SampleInfo
    from aionode.graph import EndpointInfo

__all__ = ["MonitoredReader", "SubscriptionMonitor"]

REMEMBERED_LIFESPANS = 1024
"""Maximum number of publishers whose lifespan a subscription remembers."""


class MonitoredReader(Protocol):
    """The queue of a subscription, as its monitor uses it."""

    stats: CallbackStats
    items: deque[tuple[int, Any]]
    keep_all: bool
    on_arrival: Callable[[SampleInfo], bool] | None
    on_lost: Callable[[int], None] | None

    def wake_writers(self) -> None:
        """Wake writers that wait for room."""


class SubscriptionMonitor(EventHub):
    """Monitors the publishers and messages of one subscription, and emits its events.

    It intercepts messages only if a policy requires it: the subscription's own deadline, lease or
    lifespan, or the lifespan of a publisher.

    Args:
        entity: The subscription.
        reader: Its queue.
        time_base: The source of time.
        event_callbacks: The event callbacks that the program passed.

    Raises:
        TypeError: `event_callbacks` is of another class, or a function in it takes other arguments.
    """

    __slots__ = (
        "_deadline",
        "_endpoint",
        "_entity",
        "_items",
        "_lifespans_ns",
        "_liveliness",
        "_matching",
        "_missed",
        "_now_ns",
        "_own_lifespan_ns",
        "_purge",
        "_reader",
        "_runs",
        "_time_base",
    )

    def __init__(
        self,
        entity: Endpoint,
        reader: MonitoredReader,
        time_base: TimeBase,
        event_callbacks: SubscriptionEventCallbacks | None,
    ) -> None:
        super().__init__(entity, event_callbacks, SubscriptionEventCallbacks)
        self._entity = entity
        self._endpoint = entity._endpoint
        self._reader = reader
        self._time_base = time_base
        self._now_ns = time_base.system_ns
        self._runs = False
        self._missed = 0
        qos = self._endpoint.qos
        self._deadline: SilenceAlarm | None = None
        if not is_unlimited(qos.deadline):
            self._deadline = SilenceAlarm(
                time_base, qos.deadline.nanoseconds, self._on_deadline_missed
            )
        self._liveliness: PublisherLiveliness | None = None
        if not is_unlimited(qos.liveliness_lease_duration) or self.calls("liveliness"):
            self._watch_liveliness()
        self._own_lifespan_ns = lifespan_ns(qos.lifespan)
        # Lifespans by gid, of publishers that limit it. They outlive the publisher, whose messages
        # may still be on their way; the longest known one is first.
        self._lifespans_ns: Recent[bytes, int] = Recent(REMEMBERED_LIFESPANS)
        self._items: ExpiringItems | None = None
        self._purge: Alarm | None = None
        if self._own_lifespan_ns != NEVER_NS:
            self._expire()
        self._matching: Matching | None = None
        if self.has_listeners:
            self._watch_matches()
        entity._watch(self._note_publisher)
        if self._deadline is not None or not is_unlimited(qos.liveliness_lease_duration):
            reader.on_arrival = self._on_arrival

    def events(self) -> EventStream[Any]:
        """Return the stream of all events."""
        self._watch_matches()
        if self._liveliness is None:
            self._watch_liveliness()
            for publisher in self._entity._matched():
                self._note_publisher(publisher, present=True)
        return self.stream()

    def start(self) -> None:
        """Start monitoring; the node runs now."""
        self._runs = True
        if self._deadline is not None:
            self._deadline.start()
        if self._liveliness is not None:
            self._liveliness.start()

    def close(self) -> None:
        """Stop monitoring."""
        self._runs = False
        if self._deadline is not None:
            self._deadline.stop()
        if self._liveliness is not None:
            self._liveliness.stop()
        if self._purge is not None:
            self._purge.cancel()
        super().close()

    def note_alive(self, gid: bytes) -> None:
        """Record that a publisher asserted its liveliness."""
        if self._liveliness is not None:
            self._liveliness.note_assertion(gid)

    def note_filtered(self, gid: bytes) -> None:
        """Record a message that is not delivered, as a sign of life of its publisher."""
        if self._liveliness is not None:
            self._liveliness.note_message(gid)

    # Publishers

    def _watch_matches(self) -> None:
        if self._matching is None:
            self._matching = Matching(self._endpoint, self.emit)
            self._entity._watch(self._matching.note)
            self._reader.on_lost = self._on_lost
            if self._reader.stats.lost:
                self._on_lost(self._reader.stats.lost)

    def _watch_liveliness(self) -> None:
        self._liveliness = PublisherLiveliness(
            self._time_base, self._endpoint.qos, self.emitter("liveliness")
        )
        if self._runs:
            self._liveliness.start()

    def _note_publisher(self, publisher: EndpointInfo, present: bool) -> None:
        if not self._endpoint.matches(publisher):
            return
        if self._liveliness is not None:
            (self._liveliness.add if present else self._liveliness.remove)(publisher)
        limit_ns = lifespan_ns(publisher.qos.lifespan)
        if present and limit_ns < self._own_lifespan_ns:
            self._lifespans_ns.put(publisher.gid, limit_ns)
            self._expire()

    # Messages

    def _on_arrival(self, sample_info: SampleInfo) -> bool:
        """Record a message; return whether to deliver it."""
        if self._liveliness is not None:
            self._liveliness.note_message(sample_info.gid)
        if self._items is not None and not self._is_fresh(self._items, sample_info):
            return False
        if self._deadline is not None:
            self._deadline.note()
        return True

    def _on_lost(self, count: int) -> None:
        self.emit("message_lost", QoSMessageLostInfo(self._reader.stats.lost, count))

    def _on_deadline_missed(self, periods: int) -> bool:
        self._missed += periods
        self.emit("deadline", QoSRequestedDeadlineMissedInfo(self._missed, periods))
        return True

    # Lifespan

    def _expire(self) -> None:
        """From now on, drop messages when they expire, even while queued."""
        if self._items is None:
            reader = self._reader
            queued = list(reader.items)
            reader.items.clear()  # the consumer may be about to read it
            self._items = reader.items = ExpiringItems(queued, self._now_ns, self._on_expired)
            reader.on_arrival = self._on_arrival

    def _is_fresh(self, items: ExpiringItems, sample_info: SampleInfo) -> bool:
        limit_ns = self._lifespans_ns.get(sample_info.gid, self._own_lifespan_ns)
        if limit_ns == NEVER_NS:
            items.next_expires_ns = NEVER_NS
            return True
        now_ns = self._now_ns()
        arrived_ns = sample_info.arrived_ns or now_ns
        items.next_expires_ns = expires_ns(sample_info.source_ns, arrived_ns, limit_ns)
        if items.next_expires_ns <= now_ns:
            self._reader.stats.expired += 1
            return False
        if self._reader.keep_all and self._runs and self._purge is None:
            self._purge_at(items.next_expires_ns)
        return True

    def _on_expired(self, count: int) -> None:
        self._reader.stats.expired += count
        self._reader.wake_writers()

    def _purge_at(self, expires_ns: int) -> None:
        """Make room in a KEEP_ALL queue when messages expire, as publishers may wait for it."""
        left_ns = max(0, expires_ns - self._now_ns())
        self._purge = self._time_base.call_at(self._time_base.steady_ns() + left_ns, self._on_purge)

    def _on_purge(self) -> None:
        self._purge = None
        # Reading the length drops expired messages.
        if self._items and self._items.earliest_ns != NEVER_NS:
            self._purge_at(self._items.earliest_ns)


def lifespan_ns(lifespan: Duration) -> int:
    """Return a lifespan in nanoseconds; `NEVER_NS` if unlimited."""
    return NEVER_NS if is_unlimited(lifespan) else lifespan.nanoseconds
