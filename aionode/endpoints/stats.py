"""Counters and timings of each entity.

All durations are real time in nanoseconds, even if a test steps the clock: they are what the
machine spent, not what passed on the program's clock.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.engine.transport.base import Writer
    from aionode.graph import EndpointInfo

__all__ = ["CallbackStats", "ClientStats", "Distribution", "PublisherStats"]

ID_DIGITS: Final = 8
"""Number of hexadecimal digits of an id that are shown; enough to tell endpoints apart."""

NOTED_CALLS: Final = 256
"""Number of calls recorded at once, which takes a tenth of the time of recording them one by one,
and keeps that code out of the CPU caches.
"""


# A bucket is one sixteenth of a power of two, so a percentile is off by at most 3 %. The offset
# gives the smallest values their own buckets.
_SUB_BUCKETS_LOG2 = 4
_OFFSET = 1 << _SUB_BUCKETS_LOG2
_NO_WAIT = _OFFSET  # the bucket of 0 ns


class Distribution:
    """A histogram of durations, in constant memory.

    Args:
        before_reading: Called before anything is read, to flush buffered values.
    """

    __slots__ = ("_before_reading", "_buckets", "_max_ns", "_noted")

    def __init__(self, before_reading: Callable[[], None] | None = None) -> None:
        self._buckets: dict[int, int] = {}
        self._max_ns = 0
        self._noted: list[int] = []  # durations that are not in the buckets yet
        self._before_reading = before_reading

    def __repr__(self) -> str:
        return (
            f"Distribution(count={self.count}, p50_ns={self.p50_ns}, "
            f"p99_ns={self.p99_ns}, max_ns={self.max_ns})"
        )

    @classmethod
    def of(cls, buckets: dict[int, int], max_ns: int) -> Distribution:
        """Create one from the buckets of another process, and the longest duration there."""
        distribution = cls()
        distribution._merge(buckets, max_ns)
        return distribution

    @property
    def buckets(self) -> dict[int, int]:
        """The number of durations in each bucket, by bucket number, to be sent elsewhere."""
        return dict(self._read())

    def record(self, duration_ns: int) -> None:
        """Add one duration, which must not be negative."""
        noted = self._noted
        noted.append(duration_ns)
        if len(noted) >= NOTED_CALLS:
            self._count_noted()

    def _count_noted(self) -> None:
        noted, self._noted = self._noted, []
        self._record_all(noted)

    def _record_all(self, durations_ns: Sequence[int], *others: Distribution) -> None:
        """Record each duration, in this and in `others`.

        They are sorted, and counted per bucket rather than one by one.
        """
        if not durations_ns:
            return
        ordered = sorted(durations_ns)
        counts: dict[int, int] = {}
        begin, end = 0, len(ordered)
        while begin < end:
            shifted = ordered[begin] + _OFFSET
            octave = shifted.bit_length() - _SUB_BUCKETS_LOG2 - 1
            step = shifted >> octave
            ends_ns = ((step + 1) << octave) - _OFFSET
            following = begin + 1
            if following < end and ordered[following] < ends_ns:
                following = bisect_left(ordered, ends_ns, following)
            counts[(octave << _SUB_BUCKETS_LOG2) + step] = following - begin
            begin = following
        for distribution in (self, *others):
            distribution._merge(counts, ordered[-1])

    def _merge(self, buckets: dict[int, int], longest_ns: int) -> None:
        """Merge buckets that were counted elsewhere."""
        self._max_ns = max(self._max_ns, longest_ns)
        for bucket, count in buckets.items():
            self._buckets[bucket] = self._buckets.get(bucket, 0) + count

    def _read(self) -> dict[int, int]:
        if self._before_reading is not None:
            self._before_reading()
        self._count_noted()
        return self._buckets

    @property
    def max_ns(self) -> int:
        """The longest duration seen, 0 before the first."""
        self._read()
        return self._max_ns

    @property
    def count(self) -> int:
        """The number of durations that have been recorded."""
        return sum(self._read().values())

    @property
    def p50_ns(self) -> int:
        """The median, within 3 %; 0 before the first."""
        return self.percentile_ns(50)

    @property
    def p99_ns(self) -> int:
        """The 99th percentile, within 3 %; 0 before the first."""
        return self.percentile_ns(99)

    def percentile_ns(self, percent: float) -> int:
        """Return the duration that `percent` % of all durations do not exceed, within 3 %."""
        wanted = self.count * percent / 100
        seen = 0
        for bucket in sorted(self._buckets):
            seen += self._buckets[bucket]
            if seen >= wanted:
                return min(_middle_ns(bucket), self._max_ns)
        return 0


def _start_ns(bucket: int) -> int:
    """Return the shortest duration that falls into `bucket`."""
    octave = (bucket >> _SUB_BUCKETS_LOG2) - 1
    return ((bucket - (octave << _SUB_BUCKETS_LOG2)) << octave) - _OFFSET


def _middle_ns(bucket: int) -> int:
    """Return the middle of the durations that fall into `bucket`."""
    octave = (bucket >> _SUB_BUCKETS_LOG2) - 1
    return _start_ns(bucket) + ((1 << octave) >> 1)


class CallbackStats:
    """The outcomes of the messages, requests or ticks of one entity.

    Everything that arrived is in ``received``, ``dropped``, ``expired`` or ``filtered``, or still
    queued.

    Attributes:
        received: How many were passed to a callback or a reader.
        dropped: How many a full queue discarded, or were unread when the entity was destroyed.
        expired: How many exceeded their lifespan on arrival or in the queue.
        errors: How many callbacks raised.
        filtered: How many arrived but did not pass the content filter.
        lost: How many are missing in the sequence numbers of publishers in other processes; not
            counted while there is a content filter.
    """

    __slots__ = (
        "_distributions",
        "_inline_ns",
        "_took_ns",
        "_waited_ns",
        "dropped",
        "errors",
        "expired",
        "filtered",
        "lost",
        "received",
    )

    def __init__(self) -> None:
        self.received = 0
        self.dropped = 0
        self.expired = 0
        self.errors = 0
        self.filtered = 0
        self.lost = 0
        # Waits, runs and blocking stretches; None until something is recorded or read.
        self._distributions: tuple[Distribution, Distribution, Distribution] | None = None
        # Calls since `_record_noted` of callbacks that did not await: the waits of their items and
        # their run times; then the run times of calls whose item did not wait.
        self._waited_ns: list[int] = []
        self._took_ns: list[int] = []
        self._inline_ns: list[int] = []

    @property
    def queue_wait(self) -> Distribution:
        """From arrival to the start of the callback."""
        return self._recorded()[0]

    @property
    def run_time(self) -> Distribution:
        """From the start of the callback to its end, including its awaits."""
        return self._recorded()[1]

    @property
    def blocking(self) -> Distribution:
        """The longest stretch of each callback without an await, which blocks the loop."""
        return self._recorded()[2]

    def _recorded(self) -> tuple[Distribution, Distribution, Distribution]:
        distributions = self._distributions
        if distributions is None:
            note = self._record_noted
            distributions = Distribution(note), Distribution(note), Distribution(note)
            self._distributions = distributions
        return distributions

    def _record_call(self, waited_ns: int, took_ns: int) -> None:
        """Record a callback that did not await: the wait of its item, and its run time."""
        self._waited_ns.append(waited_ns)
        self._record_took(took_ns)

    def _record_took(self, took_ns: int) -> None:
        """Record the run time of a callback that did not await."""
        took = self._took_ns
        took.append(took_ns)
        if len(took) >= NOTED_CALLS:
            self._record_noted()

    def _record_noted(self) -> None:
        """Record the buffered calls."""
        if not (self._took_ns or self._inline_ns or self._waited_ns):
            return
        queue_wait, run_time, blocking = self._recorded()
        if self._inline_ns:
            queue_wait._merge({_NO_WAIT: len(self._inline_ns)}, 0)
        queue_wait._record_all(self._waited_ns)
        run_time._record_all(self._took_ns + self._inline_ns, blocking)
        for noted in (self._waited_ns, self._took_ns, self._inline_ns):
            noted.clear()

    def __repr__(self) -> str:
        return (
            f"CallbackStats(received={self.received}, dropped={self.dropped}, "
            f"expired={self.expired}, errors={self.errors}, lost={self.lost}, "
            f"queue_wait={self.queue_wait}, run_time={self.run_time}, blocking={self.blocking})"
        )


class PublisherStats:
    """The messages that one publisher sent, by route.

    Attributes:
        published: How many messages were published.
    """

    __slots__ = ("_matched", "_writers", "published")

    def __init__(
        self, writers: Sequence[Writer], matched: Callable[[], list[EndpointInfo]]
    ) -> None:
        self.published = 0
        self._writers = writers
        self._matched = matched

    def __repr__(self) -> str:
        return (
            f"PublisherStats(published={self.published}, dropped={self.dropped}, "
            f"routes={self.routes})"
        )

    @property
    def dropped(self) -> int:
        """The number of messages dropped on the way to other processes, over a slow link or Zenoh.

        Messages that a full subscription drops are counted by the subscription.
        """
        return sum(writer.dropped for writer in self._writers)

    @property
    def routes(self) -> dict[str, str]:
        """The current route of messages to each matched subscription.

        The key is the full name of its node and the first digits of its id, as in ``/listener
        6f00a1c2``. The value is ``local`` within the context, and ``link`` or ``zenoh`` to another
        one. It is ``link and zenoh`` while the publisher has to send both ways, because another
        subscription has no link or this one's link has only just come up.
        """
        return {
            f"{reader.node.fully_qualified_name} {reader.gid.hex()[:ID_DIGITS]}": route
            for reader in self._matched()
            for writer in self._writers
            if (route := writer.route_of(reader)) is not None
        }


class ClientStats:
    """The outcomes of the calls of one client.

    Attributes:
        calls: How many calls were sent.
        errors: How many ended with a `ServiceError` or without a reply.
        run_time: The time from a call to its response.
    """

    __slots__ = ("calls", "errors", "run_time")

    def __init__(self) -> None:
        self.calls = 0
        self.errors = 0
        self.run_time = Distribution()

    def __repr__(self) -> str:
        return f"ClientStats(calls={self.calls}, errors={self.errors}, run_time={self.run_time})"
