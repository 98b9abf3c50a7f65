"""Timers, which call a callback on a grid of times computed by `engine/rules/schedule.py`."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any

from aionode._process.concurrency import checkpoint
from aionode.clock import S_TO_NS, Time, perf_ns
from aionode.endpoints.core.callback_runner import accepts
from aionode.endpoints.core.entity import Entity
from aionode.endpoints.core.inline_call import InlineCall
from aionode.endpoints.stats import CallbackStats
from aionode.engine.causes import acting_for
from aionode.engine.rules.schedule import Ticker
from aionode.errors import brief

if TYPE_CHECKING:
    from aionode.clock import Clock, ClockType
    from aionode.endpoints.core.callback_runner import CallbackRunner
    from aionode.engine.causes import CauseLog, Party

__all__ = [
    "RunnerFactory",
    "Timer",
    "TimerCallback",
    "TimerInfo",
    "to_period_ns",
]


class TimerInfo:
    """The planned and the actual time of a timer's call.

    Attributes:
        expected_call_time: The due time on the timer's grid, by its clock.
        actual_call_time: When the call was made, by the same clock.
    """

    __slots__ = ("actual_call_time", "expected_call_time")

    def __init__(
        self, *, expected_call_time: int, actual_call_time: int, clock_type: ClockType
    ) -> None:
        self.expected_call_time = Time(nanoseconds=expected_call_time, clock_type=clock_type)
        self.actual_call_time = Time(nanoseconds=actual_call_time, clock_type=clock_type)

    def __repr__(self) -> str:
        return (
            f"TimerInfo(expected_call_time={self.expected_call_time!r}, "
            f"actual_call_time={self.actual_call_time!r})"
        )


TimerCallback = Callable[[], object] | Callable[[TimerInfo], object]
"""The callback of a timer, sync or async; an awaitable result is awaited."""

TimerCall = Callable[[int, int], Coroutine[Any, Any, None] | None]
"""Makes a call, given when it was due and when it is made; returns what is left to await."""

RunnerFactory = Callable[[TimerCallback, "Timer", CallbackStats], "CallbackRunner"]
"""Creates the runner of a timer's callback, with the options passed to `create_timer`."""


class TimerCauses:
    """Notes what started a timer, and its calls.

    Args:
        log: Where they are kept.
        party: The timer.

    Attributes:
        party: The timer.
    """

    def __init__(self, log: CauseLog, party: Party) -> None:
        self._log = log
        self.party = party
        self._started = 0  # the number of the last start that a callback has caused

    def note_start(self) -> None:
        """Note that the timer starts, if a callback other than its own has caused it."""
        causes = acting_for()
        if any(run.party is not self.party for run in causes):
            self._started += 1
            self._log.note("timer", self.party, self._started)

    def noting(self, call: TimerCall) -> TimerCall:
        """Return a function that makes a call of the timer and notes it."""

        def make_call(expected_ns: int, now_ns: int) -> Coroutine[Any, Any, None] | None:
            due_ns = perf_ns() - (now_ns - expected_ns)
            run = self._log.begin(self.party, "timer", self.party.gid, self._started, due_ns)
            rest = None
            try:
                rest = call(expected_ns, now_ns)
            finally:
                if rest is None:
                    run.end(perf_ns())
            return rest

        return make_call


class Timer(Entity):
    """Calls a function periodically. Created by `Node.create_timer`.

    The first call comes one period after the creation or the last `reset`; the others follow on a
    grid from there, without drift. A callback never overlaps itself: if it takes longer than the
    period, or the loop was blocked, missed calls are skipped and the next one is on the grid. A
    timer with period 0 is always ready; on a clock that is set externally, it is called whenever
    the clock is set.

    Time is that of its clock: a timer on ROS time follows `/clock` while simulated time is in use.

    Attributes:
        stats: Statistics of its calls: `received` counts the calls made, `dropped` those skipped,
            and `queue_wait` is how late they were by the timer's clock.
    """

    def __init__(
        self,
        callback: TimerCallback,
        timer_period_ns: int,
        clock: Clock,
        make_runner: RunnerFactory,
        *,
        autostart: bool = True,
        causes: tuple[CauseLog, Party] | None = None,
    ) -> None:
        super().__init__(f"timer of {timer_period_ns / S_TO_NS:g} s")
        self.stats = CallbackStats()
        self._wants_info = self._wants_info_of(callback)
        self._make_runner = make_runner
        self._runner = make_runner(callback, self, self.stats)
        self._ticker = Ticker(clock, timer_period_ns, autostart=autostart)
        self._inline_call = InlineCall()
        self._causes: TimerCauses | None = None
        self._make_call: TimerCall = self._call
        if causes is not None:
            self._causes = noted = TimerCauses(*causes)
            self._make_call = noted.noting(self._call)
            noted.party.callback = self._runner.naming()
            noted.note_start()

    def __repr__(self) -> str:
        schedule = self._ticker.schedule
        state = "destroyed" if self.destroyed else "canceled" if schedule.canceled else "running"
        return (
            f"<Timer {schedule.period_ns / S_TO_NS:g} s {state} "
            f"calls={self.stats.received} skipped={self.stats.dropped}>"
        )

    @property
    def clock(self) -> Clock:
        """The clock that decides when calls are due."""
        return self._ticker.clock

    @property
    def callback(self) -> TimerCallback:
        """The function that is called: without arguments, or with a `TimerInfo` if it requires one.

        A new one applies from the next call on.
        """
        return self._runner.callback

    @callback.setter
    def callback(self, callback: TimerCallback) -> None:
        wants_info = self._wants_info_of(callback)
        self._runner = self._make_runner(callback, self, self.stats)
        self._wants_info = wants_info
        if self._causes is not None:
            self._causes.party.callback = self._runner.naming()

    @property
    def timer_period_ns(self) -> int:
        """The period in nanoseconds.

        Changing it does not move the next call, which is already scheduled; `reset()` does.
        """
        return self._ticker.schedule.period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        self._ticker.schedule.change_period(int(value))

    def cancel(self) -> None:
        """Make no more calls until `reset()`. A running callback is not interrupted."""
        self._ticker.schedule.cancel()
        self._ticker.wake()

    def reset(self) -> None:
        """Make the next call one period from now, even if the timer was canceled.

        Raises:
            EntityDestroyedError: The timer or its node was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("reset timer")
        if self._causes is not None:
            self._causes.note_start()
        self._ticker.schedule.reset(self.clock.now_ns())
        self._ticker.wake()

    def is_canceled(self) -> bool:
        """Return whether the timer is canceled: it makes no calls until `reset()`."""
        return self._ticker.schedule.canceled

    def is_ready(self) -> bool:
        """Return whether a call is due now."""
        return self._ticker.is_ready()

    def time_until_next_call(self) -> int | None:
        """Return the nanoseconds until the next call, negative if late; None if canceled."""
        return self._ticker.schedule.until_next_ns(self.clock.now_ns())

    def time_since_last_call(self) -> int:
        """Return the nanoseconds since the last call, or since the creation if there was none."""
        return self._ticker.schedule.since_last_ns(self.clock.now_ns())

    # Work

    async def _run(self) -> None:
        """Make the calls, until cancelled."""
        ticker = self._ticker
        schedule = ticker.schedule
        self._inline_call.prepare()
        while True:
            now_ns = ticker.clock.now_ns()
            if not schedule.is_ready(now_ns):
                if ticker.clock.follows_machine and self._runner.is_sync:
                    await self._inline_call.after(ticker.wait(self._call_inline))
                else:
                    await ticker.wait()
                continue
            expected_ns = schedule.call(now_ns)
            rest = self._make_call(expected_ns, now_ns)
            if rest is not None:
                await rest
            if schedule.period_ns == 0:
                await ticker.wait()
            elif ticker.is_ready():
                await checkpoint()  # already late again: let others run

    def _call_inline(self) -> bool:
        """Make the due call within the alarm's callback; return whether it has finished.

        Waking this timer's task takes another iteration of the loop, a third of the cost of a call.
        """
        schedule = self._ticker.schedule
        now_ns = self.clock.now_ns()
        if not (self._runner.is_sync and schedule.is_ready(now_ns) and schedule.period_ns):
            return False
        call = self._inline_call
        done = call.context.run(call.run, self._make_call, schedule.call(now_ns), now_ns)
        return done and not schedule.canceled

    def _call(self, expected_ns: int, now_ns: int) -> Coroutine[Any, Any, None] | None:
        self.stats.dropped = self._ticker.schedule.skipped
        entered_ns = perf_ns() - (now_ns - expected_ns)
        if not self._wants_info:
            return self._runner.receive(entered_ns)
        return self._runner.receive(
            entered_ns,
            TimerInfo(
                expected_call_time=expected_ns,
                actual_call_time=now_ns,
                clock_type=self.clock.clock_type,
            ),
        )

    def _close(self) -> None:
        """End the waits, and stop following the clock."""
        self._ticker.close()

    def _wants_info_of(self, callback: TimerCallback) -> bool:
        wants = accepts(callback, 0, 1, subject=self._subject, wanted="() or (info: TimerInfo)")
        return wants == 1


def to_period_ns(seconds: float) -> int:
    """Convert a period to nanoseconds, rounded to the nearest.

    Raises:
        TypeError: `seconds` is not a number.
        ValueError: It is negative, or not finite.
    """
    if not isinstance(seconds, int | float):
        raise TypeError(f"period: got {brief(seconds)}; a number of seconds is needed")
    if not 0 <= seconds < 2**63 / S_TO_NS:
        raise ValueError(f"period: got {seconds} s; it must be finite, and 0 or more")
    return round(seconds * S_TO_NS)
