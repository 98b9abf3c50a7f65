"""Time that moves only when a test advances it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.clock import S_TO_NS, Alarm, ClockType, Time, TimeBase
from aionode.clock.timer_heap import TimerHeap
from aionode.testing._quiescence import settle

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

__all__ = ["ManualClock"]


class ManualClock(TimeBase):
    """Time for tests, which passes only in `advance`, `jump` and `stall`; these take no real time.

    Given to a `Context`, it drives the clocks, timers and rates of all its nodes. It drives
    aionode's clocks only: `asyncio.sleep` and `asyncio.timeout` still run in real time.

    Args:
        start: The initial time; 0 by default.
    """

    slice_ns = 0  # callbacks run in the same order however fast the machine is

    def __init__(self, start: Time | None = None) -> None:
        self._now_ns = 0 if start is None else start.nanoseconds
        self._timer_heap = TimerHeap()
        # Callbacks that were due when added, such as those of a timer with period 0. They fire the
        # next time the clock moves; at the same time they would fire endlessly.
        self._overdue = TimerHeap()

    def __repr__(self) -> str:
        return f"<ManualClock now={self._now_ns / S_TO_NS:.9f} waiting={len(self._timer_heap)}>"

    def now(self) -> Time:
        """Return the current time, of type ROS_TIME."""
        return Time(nanoseconds=self._now_ns, clock_type=ClockType.ROS_TIME)

    async def advance(self, seconds: float) -> None:
        """Advance by `seconds`: everything due fires at its own time, in order.

        Before the clock moves, and after each point in time, all callbacks run until they wait for
        something (see `settle`).

        Raises:
            ValueError: `seconds` is negative.
        """
        end_ns = self._now_ns + span_ns(seconds, "advance")
        await settle()
        while (next_ns := self._timer_heap.first_ns()) is not None and next_ns < end_ns:
            self._move(next_ns)
            await settle()
        self._move(end_ns)
        await settle()

    async def jump(self, seconds: float) -> None:
        """Jump by `seconds`, as after a stall: everything due meanwhile fires late.

        A timer that has missed several periods fires once, and keeps its schedule.

        Raises:
            ValueError: `seconds` is negative.
        """
        await settle()
        self._move(self._now_ns + span_ns(seconds, "jump"))
        await settle()

    def stall(self, seconds: float) -> None:
        """Advance by `seconds` like a callback that blocks the event loop: nothing fires yet.

        Everything due meanwhile fires late, when the clock moves next.

        Raises:
            ValueError: `seconds` is negative.
        """
        self._now_ns += span_ns(seconds, "stall")

    async def _walk_to(self, end_ns: int, settled: Callable[[], Awaitable[None]]) -> None:
        """Advance to `end_ns`, if that is later, after everything has settled.

        Args:
            end_ns: The time in nanoseconds.
            settled: Waits until no callback can run; called only after something was due.
        """
        while (next_ns := self._timer_heap.first_ns()) is not None and next_ns <= end_ns:
            self._move(next_ns)
            await settled()
        if self._now_ns < end_ns:
            is_due = bool(self._overdue)
            self._move(end_ns)
            if is_due:
                await settled()

    def _move(self, now_ns: int) -> None:
        self._now_ns = now_ns
        if self._overdue:
            self._overdue.fire(now_ns)
        self._timer_heap.fire(now_ns)

    # The time base of clocks

    def system_ns(self) -> int:
        """Return the current time in nanoseconds."""
        return self._now_ns

    def steady_ns(self) -> int:
        """Return the current time in nanoseconds."""
        return self._now_ns

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call `callback` when the clock next moves to or past `steady_ns`."""
        heap = self._timer_heap if steady_ns > self._now_ns else self._overdue
        return heap.add(steady_ns, callback)


def span_ns(seconds: float, action: str) -> int:
    """Return `seconds` in nanoseconds, rounded to the nearest."""
    if seconds < 0:
        raise ValueError(f"{action}: {seconds} s is negative; time does not go back; use 0 or more")
    return round(seconds * S_TO_NS)
