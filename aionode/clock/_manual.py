"""Time that stands still until a test moves it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._concurrency import activity
from aionode.clock._time_base import Alarm, TimeBase
from aionode.clock._timer_heap import TimerHeap
from aionode.clock._values import S_TO_NS, ClockType, Time, time_at

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["ManualTime"]


class ManualTime(TimeBase):
    """Time for tests: it passes only in `advance` and `jump`, and takes no real time to do so.

    Given to a `Context`, it drives the clocks, timers and rates of all its nodes. Only time on
    aionode's clocks is stepped: `asyncio.sleep` and `asyncio.timeout` go on in real time.

    Args:
        start: The time it shows first, 0 unless given.
    """

    def __init__(self, start: Time | None = None) -> None:
        self._now_ns = 0 if start is None else start.nanoseconds
        self._timer_heap = TimerHeap()
        # What was due when it was added, such as a timer of period 0, has its turn when time is
        # moved the next time: at the same time it would come again and again.
        self._overdue = TimerHeap()

    def __repr__(self) -> str:
        # the name that users know it by, in aionode.testing
        return f"<ManualClock now={self._now_ns / S_TO_NS:.9f} waiting={len(self._timer_heap)}>"

    def now(self) -> Time:
        """Return the current time, of type ROS_TIME."""
        return time_at(self._now_ns, ClockType.ROS_TIME)

    async def advance(self, seconds: float) -> None:
        """Let `seconds` pass: everything due fires at its own time, one after the other.

        Between two points in time all callbacks run until each of them waits for something; so they
        do before the first. Returns when that is so after the last.

        Raises:
            ValueError: `seconds` is negative.
        """
        end_ns = self._now_ns + span_ns(seconds, "advance")
        running = activity()
        await running.wait_all_tasks_blocked()
        while (next_ns := self._timer_heap.first_ns()) is not None and next_ns < end_ns:
            self._move(next_ns)
            await running.wait_all_tasks_blocked()
        self._move(end_ns)
        await running.wait_all_tasks_blocked()

    async def jump(self, seconds: float) -> None:
        """Let `seconds` pass at once, as after a stall: what was due meanwhile fires late.

        A timer that has missed several of its times fires once, and keeps its grid.

        Raises:
            ValueError: `seconds` is negative.
        """
        running = activity()
        await running.wait_all_tasks_blocked()
        self._move(self._now_ns + span_ns(seconds, "jump"))
        await running.wait_all_tasks_blocked()

    def _move(self, now_ns: int) -> None:
        self._now_ns = now_ns
        if self._overdue:
            self._overdue.fire(now_ns)
        self._timer_heap.fire(now_ns)

    # What clocks ask for.

    def system_ns(self) -> int:
        """Return the current time in nanoseconds."""
        return self._now_ns

    def steady_ns(self) -> int:
        """Return the current time in nanoseconds."""
        return self._now_ns

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Have `callback` called the next time that time is moved and `steady_ns` is reached."""
        heap = self._timer_heap if steady_ns > self._now_ns else self._overdue
        return heap.add(steady_ns, callback)


def span_ns(seconds: float, action: str) -> int:
    """Return `seconds` in nanoseconds, rounded to the nearest."""
    if seconds < 0:
        raise ValueError(f"{action}: {seconds} s; time does not go back, so use 0 or more")
    return round(seconds * S_TO_NS)
