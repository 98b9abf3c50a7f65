"""When messages were published, on this host's steady clock."""

from __future__ import annotations

from aionode._process.recent import Recent
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS

__all__ = ["PublicationTimes"]

MIN_NS = 500_000
"""Messages published closer together than this say nothing about the pace of arrivals."""

SYNCHRONIZED_NS = 50_000_000
"""Clocks that seem to be closer than this count as equal: hosts with NTP are closer."""

DRIFT = 10_000
"""The clocks of two hosts drift apart by less than one part in this many."""


class PublicationTimes:
    """Distinguishes messages that were delayed on the way from freshly published ones.

    A message is stamped with its publication time by the clock of the publisher's host, which may
    differ from the clock here by any amount. The offset is unknown, but no message arrives before
    it is published: the smallest difference between an arrival and the stamp is the best estimate.
    It is too late by the shortest transit time, mostly less than a millisecond.

    A publisher all of whose messages were delayed would seem to have a slow clock. So a new
    publisher's clock is assumed to be synchronized, as it is on the same host, until two messages
    have arrived at the pace of their publication: delayed messages arrive all at once.
    """

    def __init__(self) -> None:
        # By gid, longest known first.
        self._clocks: Recent[bytes, PublisherClock] = Recent(REMEMBERED_PUBLISHERS)

    def published_ns(
        self, gid: bytes, source_ns: int, arrived_ns: int, system_began_ns: int
    ) -> int:
        """Return when a message was published, but not later than its arrival.

        Args:
            gid: Its publisher, whose messages must be passed in the order of arrival.
            source_ns: Its stamp, in nanoseconds since 1970; 0 if it has none and so counts as
                published on arrival.
            arrived_ns: When it arrived, by the steady clock.
            system_began_ns: The steady time at which the local system clock showed 0.
        """
        if not source_ns:
            return arrived_ns
        clock = self._clocks.get(gid)
        if (
            clock is None or source_ns < clock.source_ns
        ):  # a new publisher, or its clock was set back
            clock = PublisherClock(system_began_ns)
            self._clocks.put(gid, clock)
        clock.note(source_ns, arrived_ns)
        if clock.began_ns - SYNCHRONIZED_NS <= system_began_ns <= clock.began_ns:
            return source_ns + system_began_ns
        return source_ns + clock.began_ns


class PublisherClock:
    """What is known about the clock of one publisher's host.

    Attributes:
        began_ns: An estimate of the local steady time at which that clock showed 0.
        source_ns: The stamp of the newest message.
    """

    __slots__ = ("_arrived_ns", "_is_proven", "began_ns", "source_ns")

    def __init__(self, began_ns: int) -> None:
        self.began_ns = began_ns
        self.source_ns = 0
        self._arrived_ns = 0
        self._is_proven = False  # whether messages have arrived at the pace of their publication

    def note(self, source_ns: int, arrived_ns: int) -> None:
        """Update the estimate from a message."""
        latest_ns = arrived_ns - source_ns
        if self.source_ns:
            before_ns = self._arrived_ns - self.source_ns
            passed_ns = arrived_ns - self._arrived_ns
            apart_ns = source_ns - self.source_ns
            if self._is_proven:
                self.began_ns += max(passed_ns, 0) // DRIFT
            elif apart_ns >= MIN_NS and 2 * passed_ns >= apart_ns:
                self._is_proven = True
                self.began_ns = before_ns
        self.began_ns = min(self.began_ns, latest_ns)
        self.source_ns, self._arrived_ns = source_ns, arrived_ns
