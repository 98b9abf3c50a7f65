"""When a timer is due: a grid of times, without a clock and without waiting.

The rules are rcl's (rcl/src/rcl/timer.c). The first call is due one period after the start, and
each later one a period after the time *planned* for the one before, so delays do not add up. A
timer that is late by whole periods is called once, and continues at the next point of its grid.
"""

from __future__ import annotations

__all__ = ["Schedule"]


class Schedule:
    """The grid of one timer. All times are nanoseconds of one clock, which the caller reads.

    Attributes:
        period_ns: From one call to the next. Changing it does not move the call already planned.
        next_ns: When the next call is planned.
        last_ns: When the last call was made; before the first, when the schedule started.
        calls: How many calls were made.
        skipped: How many were skipped because they would have been too late.
        canceled: Whether nothing is due until `reset`.

    Raises:
        ValueError: The period is negative.
    """

    __slots__ = ("calls", "canceled", "last_ns", "next_ns", "period_ns", "skipped")

    def __init__(self, period_ns: int, now_ns: int, *, autostart: bool = True) -> None:
        self.period_ns = checked_period(period_ns)
        self.next_ns = now_ns + period_ns
        self.last_ns = now_ns
        self.calls = 0
        self.skipped = 0
        self.canceled = not autostart

    def is_ready(self, now_ns: int) -> bool:
        """Return whether a call is due."""
        return now_ns >= self.next_ns and not self.canceled

    def call(self, now_ns: int) -> int:
        """Record that the call is made now, and plan the next; return when this one was planned.

        Raises:
            RuntimeError: The timer is canceled.
        """
        if self.canceled:
            raise RuntimeError("timer: it is canceled and cannot be called; call reset() first")
        expected_ns = self.next_ns
        period_ns = self.period_ns
        next_ns = expected_ns + period_ns
        if next_ns <= now_ns:
            if period_ns == 0:
                next_ns = now_ns
            else:
                missed = (now_ns - next_ns) // period_ns + 1
                next_ns += missed * period_ns
                self.skipped += missed
        self.next_ns = next_ns
        self.last_ns = now_ns
        self.calls += 1
        return expected_ns

    def cancel(self) -> None:
        """Plan nothing until `reset`."""
        self.canceled = True

    def reset(self, now_ns: int) -> None:
        """Start over: the next call is one period from now."""
        self.next_ns = now_ns + self.period_ns
        self.canceled = False

    def change_period(self, period_ns: int) -> None:
        """Use another period after the call that is planned already.

        Raises:
            ValueError: The period is negative.
        """
        self.period_ns = checked_period(period_ns)

    def until_next_ns(self, now_ns: int) -> int | None:
        """Return how long it is to the next call, negative when it is late; None if canceled."""
        return None if self.canceled else self.next_ns - now_ns

    def since_last_ns(self, now_ns: int) -> int:
        """Return how long ago the last call was, or the start if there was none."""
        return now_ns - self.last_ns

    def look_back(self, now_ns: int) -> None:
        """Start over if the clock was set back to before the last call; else change nothing."""
        if now_ns < self.last_ns:
            self.next_ns = now_ns + self.period_ns
            self.last_ns = now_ns

    def carry_over(self, old_now_ns: int, new_now_ns: int) -> None:
        """Keep the rest of the period when the clock switches to another source of time."""
        left_ns = self.next_ns - old_now_ns
        self.next_ns = new_now_ns + max(left_ns, 0)
        self.last_ns = new_now_ns + left_ns - self.period_ns  # as rcl, also after a reset


def checked_period(period_ns: int) -> int:
    """Return `period_ns` if it is not negative."""
    if period_ns < 0:
        raise ValueError(f"timer: its period is {period_ns} ns; use 0 or more (0 is always ready)")
    return period_ns
