"""Log lines about repeated events: the first one, and then how many more."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Final, Generic, TypeVar

from msgspec import Struct

from aionode._process.recent import Recent

__all__ = ["MAX_WAIT_NS", "WAIT_NS", "RatedLines"]

K = TypeVar("K", bound=Hashable)

WAIT_NS: Final = 10_000_000_000
"""The time between two lines about the same subject; it doubles while the events continue."""

MAX_WAIT_NS: Final = 640_000_000_000


class Line(Struct):
    """The log lines about one subject: when it may be logged again, and the number not logged."""

    due_ns: int
    wait_ns: int = WAIT_NS
    unsaid: int = 0


class RatedLines(Generic[K]):
    """Limits log lines about events that others cause, so that nobody can fill the log.

    The first event of each subject is logged, and then how many more there were: after 10 s, 20 s
    and so on. A subject that was quiet for longer starts over.

    Any thread may record an event. If two are recorded at the same moment, one may not be counted,
    which does no harm.

    Args:
        now_ns: Returns the time of a steady clock, in nanoseconds.
        max_subjects: Number of subjects that are remembered, since others may invent any.
    """

    def __init__(self, now_ns: Callable[[], int], max_subjects: int = 1_000) -> None:
        self._now_ns = now_ns
        self._lines: Recent[K, Line] = Recent(max_subjects)

    def note(
        self, subject: K, count: int = 1, *, has_room: Callable[[], bool] | None = None
    ) -> str | None:
        """Return the end of the line to log now about a subject; None for no line.

        Args:
            subject: What the line is about.
            count: How many events happened at once.
            has_room: Called before a line is logged; if it returns false, the line is omitted, and
                a new subject is not remembered.
        """
        now_ns, line = self._now_ns(), self._lines.get(subject)
        if line is not None and now_ns < line.due_ns:
            line.unsaid += count
            return None
        if has_room is not None and not has_room():
            if line is not None:
                line.unsaid += count
            return None
        if line is None:
            self._lines.put(subject, Line(now_ns + WAIT_NS))
            return f" ({count} at once)" if count > 1 else ""
        more = line.unsaid + count - 1
        is_over = now_ns > line.due_ns + line.wait_ns
        line.wait_ns = WAIT_NS if is_over else min(2 * line.wait_ns, MAX_WAIT_NS)
        line.due_ns, line.unsaid = now_ns + line.wait_ns, 0
        return f" ({more} more since the last line)" if more else ""
