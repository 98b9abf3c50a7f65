"""A schedule on a clock: something to await."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode.clock import ClockChange, ClockType, Duration, JumpThreshold
from aionode.endpoints.timer._schedule import Schedule

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Clock, TimeJump
    from aionode.clock._time_base import Alarm

__all__ = ["ClockedSchedule", "Ticker"]

# Jumps forward need no callback: they end the waits for what has become due.
JUMPS = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1))


class ClockedSchedule:
    """A schedule that goes by a clock, through jumps of ROS time and changes of its source.

    Args:
        clock: The clock.
        period_ns: From one call to the next.
        autostart: Whether it starts now.
        jumps: The jumps of ROS time after which `wake` is called.

    Attributes:
        clock: The clock.
        schedule: What is due when, in the time of the clock.
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
        """Have those that wait look again, because the schedule has changed."""

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
        """Go on by another source of time."""
        self.schedule.carry_over(old_now_ns, new_now_ns)


class Ticker(ClockedSchedule):
    """A schedule by a clock that tasks wait for."""

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
            on_ring: Called when the alarm rings, on a clock that follows the machine's. If it
                returns True, it has made the call, and the wait continues until the next is due.
        """
        waiter = asyncio.get_running_loop().create_future()
        schedule = self.schedule
        alarm: Alarm | None = None
        period_ns = 0  # of the alarm, if it goes on by itself

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
        """Have `ring` called when the next call is due; return how often after that, 0 for never.

        With `repeat` it may go on by itself, which the kernel does for less than setting it again.
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
