"""Detect that something has been silent for too long."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._process.concurrency import running_loop
from aionode.clock._values import ClockType, Duration

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock._clocks import Clock, JumpHandle, TimeJump
    from aionode.clock._time_base import Alarm, TimeBase

__all__ = ["SilenceAlarm"]


class SilenceAlarm:
    """Counts the whole periods since the last sign of life, from the first one on.

    A sign costs only one clock reading: the alarm is rescheduled only when it fires.

    With a `clock` on ROS time, a period is over when that clock has advanced by a period since the
    last sign, or has stood still for a period of steady time, as it does when its publisher is
    lost. A jump back does not undo time that has passed. Any other clock is treated as the steady
    one.

    Args:
        time_base: Provides the steady clock.
        period_ns: The longest silence.
        on_silence: Called with the number of periods since the last sign or call; returns whether
            to go on counting without another sign.
        clock: The clock that measures the period, if not the steady clock.
    """

    __slots__ = (
        "_alarm",
        "_jumps",
        "_on_silence",
        "_passed_ns",
        "_period_ns",
        "_runs",
        "_since_ns",
        "_steady_ns",
        "_time_base",
    )

    def __init__(
        self,
        time_base: TimeBase,
        period_ns: int,
        on_silence: Callable[[int], bool],
        clock: Clock | None = None,
    ) -> None:
        self._time_base = time_base
        self._steady_ns = time_base.steady_ns
        self._period_ns = period_ns
        self._on_silence = on_silence
        # The last sign, the end of the last silent period, or the last movement of the clock.
        self._since_ns: int | None = None
        self._passed_ns = 0  # how far the clock has advanced since the last sign
        self._alarm: Alarm | None = None
        self._runs = False
        self._jumps: JumpHandle | None = None
        if clock is not None and clock.clock_type is ClockType.ROS_TIME:
            from aionode.clock._clocks import JumpThreshold  # rarely needed

            shortest = Duration(nanoseconds=1)
            every = JumpThreshold(min_forward=shortest, min_backward=-shortest)
            self._jumps = clock.create_jump_callback(every, post_callback=self._on_jump)

    def start(self) -> None:
        """Start the alarm, as an event loop is running now; earlier signs count as well."""
        self._runs = True
        if self._alarm is None and self._since_ns is not None:
            self._set()

    def note(self, at_ns: int | None = None) -> None:
        """Record a sign, at the current time or at a given steady time."""
        self._since_ns = self._steady_ns() if at_ns is None else at_ns
        self._passed_ns = 0
        if self._alarm is None and self._runs:
            self._set()

    def left_ns(self) -> int | None:
        """Return at most how much of the first period is left; 0 or less when it is over.

        None before the first sign. May be called from any thread.
        """
        since_ns = self._since_ns
        if since_ns is None:
            return None
        if self._passed_ns >= self._period_ns:
            return 0
        return since_ns + self._period_ns - self._steady_ns()

    def periods(self) -> int:
        """Return the number of whole periods since the last sign; 0 before the first sign."""
        if self._since_ns is None:
            return 0
        return max(self._steady_ns() - self._since_ns, self._passed_ns) // self._period_ns

    def forget(self) -> None:
        """Return to the state before the first sign."""
        self._since_ns = None
        self._cancel()

    def stop(self) -> None:
        """Stop the alarm."""
        self._runs = False
        self._cancel()
        if self._jumps is not None:
            self._jumps.unregister()

    def _on_jump(self, jump: TimeJump) -> None:
        """Record that the clock has moved; ROS time moves only when it is set."""
        if self._since_ns is None or not jump.delta.nanoseconds:
            return  # no sign yet, or a change of the source, which does not move the clock
        self._since_ns = self._steady_ns()
        self._passed_ns += max(jump.delta.nanoseconds, 0)
        if self._passed_ns >= self._period_ns and self._alarm is not None:
            self._ring()

    def _set(self) -> None:
        assert self._since_ns is not None  # noqa: S101  # there was a sign
        self._cancel()
        self._alarm = self._time_base.call_at(self._since_ns + self._period_ns, self._ring)

    def _cancel(self) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def _ring(self) -> None:
        # After a stall of the loop, signs that arrived in time may not be read yet: reading takes
        # one iteration of the loop, and whatever it wakes another one.
        loop = running_loop()
        loop.call_soon(loop.call_soon, self._judge, self._alarm)

    def _judge(self, rung: Alarm | None) -> None:
        if rung is not self._alarm or self._since_ns is None:
            return  # stopped meanwhile, or already judged
        periods = self.periods()
        if periods > 0:
            if self._jumps is None:
                self._since_ns += periods * self._period_ns
            else:
                self._since_ns = self._steady_ns()
                self._passed_ns = max(self._passed_ns - periods * self._period_ns, 0)
            if not self._on_silence(periods):
                self._cancel()  # until the next sign
                return
        if self._runs:
            self._set()
