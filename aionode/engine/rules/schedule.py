"""The due times of a timer (`Schedule`), and waiting for them (`Ticker`).

The rules are rcl's (rcl/src/rcl/timer.c). The first call is due one period after the start, and
each later one a period after the *planned* time of the previous one, so delays do not accumulate. A
timer that is late by whole periods is called once, and continues at the next point of its grid.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode._process.concurrency import running_loop
from aionode.clock import ClockChange, ClockType, Duration, JumpThreshold

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Alarm, Clock, TimeJump

__all__ = ["ClockedSchedule", "Schedule", "Ticker"]

# Jumps forward need no callback: they end the waits for what has become due.
JUMPS = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1))


class Schedule:
    """The due times of one timer, in nanoseconds of a clock that the caller reads.

    Attributes:
        period_ns: The period. Changing it does not move the call that is already planned.
        next_ns: When the next call is planned.
        last_ns: When the last call was made; initially, when the schedule started.
        calls: Number of calls made.
        skipped: Number of calls skipped because they were too late.
        canceled: Whether nothing is due until `reset`.

    Raises:
        ValueError: the period is negative.
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
            RuntimeError: the timer is canceled.
        """
        if self.canceled:
            raise RuntimeError("timer: canceled timers cannot be called; call reset() first")
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
        """Use another period after the call that is already planned.

        Raises:
            ValueError: the period is negative.
        """
        self.period_ns = checked_period(period_ns)

    def until_next_ns(self, now_ns: int) -> int | None:
        """Return the time until the next call, negative if it is late; None if canceled."""
        return None if self.canceled else self.next_ns - now_ns

    def since_last_ns(self, now_ns: int) -> int:
        """Return the time since the last call, or since the start if there was none."""
        return now_ns - self.last_ns

    def look_back(self, now_ns: int) -> None:
        """Start over if the clock was set back to before the last call; otherwise do nothing."""
        if now_ns < self.last_ns:
            self.next_ns = now_ns + self.period_ns
            self.last_ns = now_ns

    def carry_over(self, old_now_ns: int, new_now_ns: int) -> None:
        """Keep the rest of the period when the clock switches to another time source."""
        left_ns = self.next_ns - old_now_ns
        self.next_ns = new_now_ns + max(left_ns, 0)
        self.last_ns = new_now_ns + left_ns - self.period_ns  # as in rcl, even after a reset


class ClockedSchedule:
    """A schedule that follows a clock through jumps of ROS time and changes of its source.

    Args:
        clock: The clock.
        period_ns: The period.
        autostart: Whether to start now.
        jumps: The jumps of ROS time after which `wake` is called.

    Attributes:
        clock: The clock.
        schedule: The due times, in the time of the clock.
    """

    __slots__ = ("_before_jump_ns", "_jumps", "clock", "schedule")

    def __init__(
        self,
        clock: Clock,
        period_ns: int,
        *,
        autostart: bool = True,
        jumps: JumpThreshold = JUMPS,
    ) -> None:
        self.clock = clock
        self.schedule = Schedule(period_ns, clock.now_ns(), autostart=autostart)
        self._before_jump_ns = 0
        self._jumps = (
            clock.create_jump_callback(
                jumps, pre_callback=self._before_jump, post_callback=self._after_jump
            )
            if clock.clock_type is ClockType.ROS_TIME
            else None
        )

    def wake(self) -> None:
        """Wake those who wait, because the schedule has changed."""

    def close(self) -> None:
        """Stop following the clock."""
        if self._jumps is not None:
            self._jumps.unregister()
        self.wake()

    def _before_jump(self) -> None:
        self._before_jump_ns = self.clock.now_ns()

    def _after_jump(self, jump: TimeJump) -> None:
        now_ns = self.clock.now_ns()
        if jump.clock_change is ClockChange.ROS_TIME_NO_CHANGE:
            self.schedule.look_back(now_ns)
        else:
            self._switch(self._before_jump_ns, now_ns)
        self.wake()

    def _switch(self, old_now_ns: int, new_now_ns: int) -> None:
        """Continue with another time source."""
        self.schedule.carry_over(old_now_ns, new_now_ns)


class Ticker(ClockedSchedule):
    """A clocked schedule that tasks can wait for."""

    __slots__ = ("_waiters",)

    def __init__(self, clock: Clock, period_ns: int, *, autostart: bool = True) -> None:
        super().__init__(clock, period_ns, autostart=autostart)
        self._waiters: dict[asyncio.Future[None], None] = {}  # a dict, to wake them in order

    def is_ready(self) -> bool:
        """Return whether a call is due."""
        return self.schedule.is_ready(self.clock.now_ns())

    async def wait(self, on_ring: Callable[[], bool] | None = None) -> None:
        """Wait until a call is probably due, or `wake` is called; then check the schedule.

        While the schedule is canceled, only `wake` ends the wait. Cancelling is safe. Nothing is
        lost between two waits, because the schedule records what is due.

        Args:
            on_ring: Called when the alarm rings, if the clock follows the machine's. If it returns
                True, it has made the call, and the wait continues until the next one is due.
        """
        waiter = running_loop().create_future()
        schedule = self.schedule
        alarm: Alarm | None = None
        period_ns = 0  # of a periodic alarm

        def ring() -> None:
            nonlocal alarm, period_ns
            if waiter.done():
                return
            called = on_ring is not None and on_ring()
            if waiter.done():
                return  # the call has woken or cancelled this wait
            if not called:
                waiter.set_result(None)
            elif period_ns != schedule.period_ns:
                if alarm is not None:
                    alarm.cancel()
                alarm, period_ns = self._set_alarm(ring, repeat=True)

        if not schedule.canceled:
            alarm, period_ns = self._set_alarm(ring, repeat=on_ring is not None)
        self._waiters[waiter] = None
        try:
            await waiter
        finally:
            del self._waiters[waiter]
            if alarm is not None:
                alarm.cancel()
        schedule.look_back(self.clock.now_ns())  # the machine's clock may have been set back

    def _set_alarm(self, ring: Callable[[], None], *, repeat: bool) -> tuple[Alarm, int]:
        """Call `ring` when the next call is due; return the alarm's period, or 0 if it has none.

        With `repeat`, the kernel may repeat the alarm, which is cheaper than setting it again.
        """
        schedule = self.schedule
        if repeat and schedule.period_ns:
            alarm = self.clock.call_every(schedule.next_ns, schedule.period_ns, ring)
            if alarm is not None:
                return alarm, schedule.period_ns
        return self.clock.call_at(schedule.next_ns, ring), 0

    def wake(self) -> None:
        """End all waits, because the schedule has changed."""
        for waiter in self._waiters:
            if not waiter.done():
                waiter.set_result(None)


def checked_period(period_ns: int) -> int:
    """Validate that `period_ns` is not negative, and return it."""
    if period_ns < 0:
        raise ValueError(
            f"timer: the period is {period_ns} ns; it must be 0 or more (0 is always ready)"
        )
    return period_ns
