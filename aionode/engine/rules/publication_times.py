"""When messages were published, by the steady clock of this host."""

from __future__ import annotations

from aionode._process.recent import Recent
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS

__all__ = ["PublicationTimes"]

SHORTEST_NS = 500_000
"""Messages that were published in a shorter time say nothing about the pace at which they came."""

SYNCHRONIZED_NS = 50_000_000
"""Clocks that seem to be less far apart count as the same: hosts that use NTP are closer."""

DRIFT = 10_000
"""Clocks of two hosts drift apart by less than one part in so many."""


class PublicationTimes:
    """Tells messages that were held back on their way from those that were just published.

    A message has the time of its publication by the clock of its publisher's host, and that clock
    may be any time apart from the one here. The difference is not known, but no message arrives
    before it is published: the smallest difference between an arrival and the stamp is the best
    estimate, and it is too late by the shortest time on the way, below a millisecond mostly.

    A publisher that has shown only messages that were held back would seem to have a slow clock. So
    the clocks of a new publisher are taken for synchronized, as on one host they are, until two
    messages have come at the pace at which they were published: what was held back comes at once.
    """

    def __init__(self) -> None:
        # By gid; the one known for longest is first.
        self._clocks: Recent[bytes, PublisherClock] = Recent(REMEMBERED_PUBLISHERS)

    def published_ns(
        self, gid: bytes, source_ns: int, arrived_ns: int, system_began_ns: int
    ) -> int:
        """Return when a message was published, at most when it arrived.

        Args:
            gid: Its publisher, whose messages are shown in the order of their arrival.
            source_ns: Its stamp, in nanoseconds since 1970; 0 if it has none: then it counts as
                published when it arrived.
            arrived_ns: When it arrived, by the steady clock.
            system_began_ns: What the steady clock showed when the system clock here showed 0.
        """
        if not source_ns:
            return arrived_ns
        clock = self._clocks.get(gid)
        if clock is None or source_ns < clock.source_ns:  # a new one, or its clock was set back
            clock = PublisherClock(system_began_ns)
            self._clocks.put(gid, clock)
        clock.note(source_ns, arrived_ns)
        if clock.began_ns - SYNCHRONIZED_NS <= system_began_ns <= clock.began_ns:
            return source_ns + system_began_ns
        return source_ns + clock.began_ns


class PublisherClock:
    """The clock of one publisher's host, as far as it is known.

    Attributes:
        began_ns: What the steady clock here showed when that clock showed 0, as an estimate.
        source_ns: The stamp of the newest message.
    """

    __slots__ = ("_arrived_ns", "_is_proven", "began_ns", "source_ns")

    def __init__(self, began_ns: int) -> None:
        self.began_ns = began_ns
        self.source_ns = 0
        self._arrived_ns = 0
        self._is_proven = False  # whether messages have come at the pace of their publication

    def note(self, source_ns: int, arrived_ns: int) -> None:
        """Learn from a message."""
        latest_ns = arrived_ns - source_ns
        if self.source_ns:
            before_ns = self._arrived_ns - self.source_ns
            passed_ns = arrived_ns - self._arrived_ns
            apart_ns = source_ns - self.source_ns
            if self._is_proven:
                self.began_ns += max(passed_ns, 0) // DRIFT
            elif apart_ns >= SHORTEST_NS and 2 * passed_ns >= apart_ns:
                self._is_proven = True
                self.began_ns = before_ns
        self.began_ns = min(self.began_ns, latest_ns)
        self.source_ns, self._arrived_ns = source_ns, arrived_ns
