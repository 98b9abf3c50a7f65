"""Lines of the log about what happens again and again: the first one, and then how many more."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Final, Generic, TypeVar

from aionode._process.recent import Recent

__all__ = ["MOST_WAIT_NS", "WAIT_NS", "RatedLines"]

K = TypeVar("K", bound=Hashable)

WAIT_NS: Final = 10_000_000_000
"""The time between two lines about the same subject; while it goes on, it doubles."""

MOST_WAIT_NS: Final = 640_000_000_000


@dataclass(slots=True)
class Line:
    """What was said of one subject: when it may be said again, and how much was not said."""

    due_ns: int
    wait_ns: int = WAIT_NS
    unsaid: int = 0


class RatedLines(Generic[K]):
    """Decides what of something that others cause is logged, so that nobody can fill the log.

    The first of each subject is, and then how many more there were: after 10 s, 20 s and so on. A
    subject that was quiet for longer begins anew.

    Any thread may note something: of two at the same moment one may not be counted, which does no
    harm.

    Args:
        now_ns: Returns the time of a steady clock, in nanoseconds.
        most: How many subjects are remembered: others may invent any.
    """

    def __init__(self, now_ns: Callable[[], int], most: int = 1_000) -> None:
        self._now_ns = now_ns
        self._lines: Recent[K, Line] = Recent(most)

    def note(
        self, subject: K, count: int = 1, *, has_room: Callable[[], bool] | None = None
    ) -> str | None:
        """Return how a line about a subject ends that is to be logged now; None for no line.

        Args:
            subject: What it is about.
            count: How many happened at once.
            has_room: Asked before a line that would be logged; false leaves it out. A new subject
                is not remembered then.
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
        line.wait_ns = WAIT_NS if is_over else min(2 * line.wait_ns, MOST_WAIT_NS)
        line.due_ns, line.unsaid = now_ns + line.wait_ns, 0
        return f" ({more} more since the last line)" if more else ""
