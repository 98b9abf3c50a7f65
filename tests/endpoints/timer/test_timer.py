"""Timers on a manual clock, and on a clock driven from outside."""

from __future__ import annotations

import asyncio
import functools
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from itertools import pairwise
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.clock import Clock, ClockType, ROSClock, Time
from aionode.endpoints.core.callback_runner import CallbackRunner, Callbacks
from aionode.endpoints.stats import CallbackStats
from aionode.endpoints.timer import Timer, TimerInfo
from aionode.endpoints.timer._timer import to_period_ns
from aionode.engine.rules.schedule import Ticker
from aionode.errors import AionodeError, EntityDestroyedError
from aionode.testing import ManualClock, settle
from tests.support.living import living

MS = 1_000_000
S = 1_000_000_000


class Silent:
    """A logger for callbacks that are not reported."""

    def warning(self, text: str) -> None:
        """Fail: no callback here is slow."""
        raise AssertionError(text)


def make_runner(
    callback: Callable[..., Any], timer: Timer, stats: CallbackStats, *, offload: bool = False
) -> CallbackRunner:
    """Run callbacks as a node does, without a node."""
    callbacks = Callbacks("/node", Silent(), budget_ns=60 * S)  # type: ignore[arg-type]
    return CallbackRunner(callback, timer, callbacks, stats, on_error="raise", offload=offload)


class Bench:
    """A manual time, a clock on it, and timers that write down when they were called."""

    def __init__(self, start_s: float = 0, clock_type: ClockType = ClockType.ROS_TIME) -> None:
        self.manual = ManualClock(Time(seconds=start_s, clock_type=ClockType.ROS_TIME))
        self.clock = Clock(clock_type, time_base=self.manual)
        self.calls: list[int] = []

    def note(self) -> None:
        """Write down the time."""
        self.calls.append(self.clock.now_ns())

    def timer(
        self, period_ns: int, callback: Callable[..., Any] | None = None, **options: Any
    ) -> Timer:
        """Make a timer, of the callback that writes down the time unless given."""
        return Timer(callback or self.note, period_ns, self.clock, make_runner, **options)

    def set_ros_time(self, seconds: float) -> None:
        """Drive the clock."""
        self.clock.set_ros_time_override(Time(seconds=seconds))


def start(timer: Timer, tasks: asyncio.TaskGroup) -> None:
    """Do what a node does with its timers when it runs."""
    timer._start(tasks)


@asynccontextmanager
async def running(*timers: Timer) -> AsyncIterator[None]:
    """Run timers for the length of the block."""
    async with asyncio.TaskGroup() as tasks:
        for timer in timers:
            start(timer, tasks)
        await settle()
        yield
        for timer in timers:
            timer.destroy()


async def test_calls_come_on_a_grid_from_the_creation() -> None:
    """First after one period; being started later does not shift the grid (T1)."""
    bench = Bench(start_s=5)
    timer = bench.timer(100 * MS)
    await bench.manual.advance(0.03)
    async with running(timer):
        await bench.manual.advance(0.3)
    assert bench.calls == [5 * S + n * 100 * MS for n in (1, 2, 3)]


async def test_a_stall_costs_one_call_and_keeps_the_grid() -> None:
    """What was missed is left out and counted, and the next call is not late (T2)."""
    bench = Bench()
    timer = bench.timer(100 * MS)
    async with running(timer):
        await bench.manual.jump(0.57)
        await bench.manual.advance(0.1)
    assert bench.calls == [570 * MS, 600 * MS]
    assert (timer.stats.received, timer.stats.dropped) == (2, 4)
    assert repr(timer) == "<Timer 0.1 s destroyed calls=2 skipped=4>"


async def test_a_call_says_when_it_was_planned_and_when_it_came() -> None:
    """On the clock of the timer."""
    bench = Bench()
    infos: list[TimerInfo] = []
    async with running(bench.timer(100 * MS, infos.append)):
        await bench.manual.jump(0.25)
    expected, actual = infos[0].expected_call_time, infos[0].actual_call_time
    assert (expected, actual) == (
        Time(nanoseconds=100 * MS, clock_type=ClockType.ROS_TIME),
        Time(nanoseconds=250 * MS, clock_type=ClockType.ROS_TIME),
    )


async def test_a_timer_that_does_not_start_by_itself_waits_for_reset() -> None:
    """With `autostart=False` it is canceled from the beginning (T1)."""
    bench = Bench()
    timer = bench.timer(100 * MS, autostart=False)
    assert timer.is_canceled()
    async with running(timer):
        await bench.manual.advance(1.05)
        timer.reset()
        await bench.manual.advance(0.1)
    assert bench.calls == [1150 * MS]


async def test_cancel_stops_and_reset_begins_a_new_grid() -> None:
    """A timer waiting for its next call hears of both (T3)."""
    bench = Bench()
    timer = bench.timer(100 * MS)
    async with running(timer):
        await bench.manual.advance(0.15)
        timer.cancel()
        assert timer.is_canceled()
        assert timer.time_until_next_call() is None
        await bench.manual.advance(1.0)
        assert bench.calls == [100 * MS]
        timer.reset()
        assert not timer.is_canceled()
        await bench.manual.advance(0.1)
        timer.reset()  # also without a cancel
        await bench.manual.advance(0.05)
        timer.reset()
        await bench.manual.advance(0.1)
    assert bench.calls == [100 * MS, 1250 * MS, 1400 * MS]


async def test_a_timer_may_cancel_and_destroy_itself() -> None:
    """Its own callback often knows when it is no longer needed."""
    bench = Bench()

    def once() -> None:
        bench.note()
        timer.cancel()

    def last() -> None:
        bench.note()
        other.destroy()

    timer = bench.timer(100 * MS, once)
    other = bench.timer(150 * MS, last)
    async with running(timer, other):
        await bench.manual.advance(1)
    assert bench.calls == [100 * MS, 150 * MS]


async def test_a_new_period_begins_after_the_planned_call() -> None:
    """As in rcl: only `reset` moves what is planned (T3)."""
    bench = Bench()
    timer = bench.timer(100 * MS)
    async with running(timer):
        timer.timer_period_ns = 10 * MS
        assert timer.timer_period_ns == 10 * MS
        await bench.manual.advance(0.12)
    assert bench.calls == [100 * MS, 110 * MS, 120 * MS]
    with pytest.raises(ValueError, match="period"):
        timer.timer_period_ns = -1


async def test_a_timer_tells_where_it_stands() -> None:
    """In nanoseconds, as in rclpy (T3)."""
    bench = Bench()
    timer = bench.timer(100 * MS)
    await bench.manual.advance(0.03)
    assert timer.time_until_next_call() == 70 * MS
    assert timer.time_since_last_call() == 30 * MS
    assert not timer.is_ready()
    await bench.manual.advance(0.1)
    assert timer.time_until_next_call() == -30 * MS
    assert timer.is_ready()
    assert timer.clock is bench.clock
    timer.destroy()


async def test_a_timer_of_period_zero_is_called_whenever_time_moves() -> None:
    """Always ready (T2); but a test that steps time has to come to an end."""
    bench = Bench()
    async with running(bench.timer(0)):
        assert bench.calls == [0]
        await bench.manual.advance(0.5)
        await bench.manual.advance(0)
    assert bench.calls == [0, 500 * MS, 500 * MS]


async def test_a_timer_of_period_zero_leaves_room_for_others() -> None:
    """On the machine's time it runs in each turn of the loop, not in a loop of its own."""
    loop = asyncio.get_running_loop()
    calls: list[int] = []
    turns: list[int] = []
    enough = asyncio.Event()

    def call() -> None:
        calls.append(len(turns))
        if len(calls) == 20:
            enough.set()

    def turn() -> None:
        turns.append(1)
        if not enough.is_set():
            loop.call_soon(turn)

    loop.call_soon(turn)
    async with running_on_machine(Timer(call, 0, ROSClock(), make_runner)):
        await enough.wait()
    assert len(set(calls)) == len(calls)  # each in a turn of its own


@asynccontextmanager
async def running_on_machine(timer: Timer) -> AsyncIterator[None]:
    """Run a timer that never settles."""
    async with asyncio.TaskGroup() as tasks:
        start(timer, tasks)
        yield
        timer.destroy()


async def test_a_callback_does_not_overlap_itself() -> None:
    """It takes 2.5 periods: calls 2 and 3 are left out, the one at 4 comes on time (T5)."""
    bench = Bench()
    active = 0

    async def slow() -> None:
        nonlocal active
        active += 1
        assert active == 1
        bench.note()
        await bench.clock.sleep(0.25)
        active -= 1

    quick: list[int] = []
    timer = bench.timer(100 * MS, slow)
    other = bench.timer(100 * MS, lambda: quick.append(bench.clock.now_ns()))
    async with running(timer, other):
        await bench.manual.advance(0.75)
    # Ready at 0.2 and 0.3, late by whole periods: called once, at the end of the one before.
    assert bench.calls == [100 * MS, 350 * MS, 600 * MS]
    assert quick == [n * 100 * MS for n in range(1, 8)]  # (T5) others are not held up


async def test_a_timer_that_is_always_late_leaves_room_for_others() -> None:
    """A callback slower than its period, on the loop itself, must not starve the rest (T5)."""
    bench = Bench()
    calls = 0

    def too_slow() -> None:
        nonlocal calls
        calls += 1
        bench.manual.stall(0.15)

    async with running(bench.timer(100 * MS, too_slow)):
        bench.manual._move(100 * MS)
        for turn in range(100):
            await checkpoint()
            assert turn <= calls <= turn + 2


@pytest.mark.parametrize("offload", [False, True])
async def test_a_callback_in_a_thread_settles_too(offload: bool) -> None:
    """Stepping time waits for it, so a test of it needs no sleep either."""
    bench = Bench()
    timer = Timer(
        bench.note, 100 * MS, bench.clock, functools.partial(make_runner, offload=offload)
    )
    async with running(timer):
        await bench.manual.advance(0.3)
    assert bench.calls == [100 * MS, 200 * MS, 300 * MS]


async def test_an_error_of_a_callback_comes_out() -> None:
    """Through the TaskGroup of the node."""

    def fail() -> None:
        raise ZeroDivisionError

    bench = Bench()
    errors: list[BaseException] = []
    try:
        async with running(bench.timer(100 * MS, fail)):
            await bench.manual.advance(0.1)
    except* ZeroDivisionError as group:
        errors.extend(group.exceptions)
    assert len(errors) == 1


# Callbacks


def nothing() -> None:
    """Take nothing."""


def info(info: TimerInfo) -> None:
    """Take the info."""


def maybe(info: TimerInfo | None = None) -> None:
    """Take nothing, if nothing is given."""


def two(first: int, second: int) -> None:
    """Take too much."""


def anything(*_: object) -> None:
    """Take whatever comes."""


def keyword(*, name: str) -> None:
    """Take what is not given."""


@pytest.mark.parametrize(
    ("callback", "arguments"),
    [(nothing, 0), (info, 1), (maybe, 0), (anything, 0), (int, 0), ([].append, 1)],
)
async def test_a_callback_gets_the_info_only_if_it_requires_an_argument(
    callback: Callable[..., Any], arguments: int
) -> None:
    """As in rclpy; a callback with a default, or a builtin, is called without."""
    given: list[int] = []

    @functools.wraps(callback, updated=())
    def called(*args: Any) -> Any:
        given.append(len(args))
        return callback(*args)

    bench = Bench()
    async with running(bench.timer(100 * MS, called)):
        await bench.manual.advance(0.1)
    assert given == [arguments]


@pytest.mark.parametrize("callback", [two, keyword, divmod])
def test_a_callback_that_does_not_fit_is_refused_at_once(callback: Callable[..., Any]) -> None:
    """A RuntimeError as in rclpy, saying what fits (T3)."""
    with pytest.raises(RuntimeError, match="TimerInfo") as caught:
        Bench().timer(100 * MS, callback)
    assert isinstance(caught.value, AionodeError)


def test_what_is_no_function_is_refused() -> None:
    """A TypeError where it is given."""
    with pytest.raises(TypeError, match="is not callable"):
        Timer(5, MS, ROSClock(), make_runner)  # type: ignore[arg-type]


async def test_another_callback_can_be_set() -> None:
    """Its arguments are looked at anew; one that does not fit changes nothing."""
    bench = Bench()
    infos: list[TimerInfo] = []
    timer = bench.timer(100 * MS)
    async with running(timer):
        await bench.manual.advance(0.1)
        timer.callback = infos.append
        await bench.manual.advance(0.1)
        with pytest.raises(RuntimeError):
            timer.callback = two  # type: ignore[assignment]
        await bench.manual.advance(0.1)
    assert len(bench.calls) == 1
    assert len(infos) == 2


# Destruction


async def test_destroying_ends_the_callback_that_runs() -> None:
    """The timer forgets its clock. It may be destroyed twice, and cancelled afterwards."""
    tickers = living(Ticker)
    bench = Bench()
    ended: list[str] = []

    async def wait() -> None:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            ended.append("cancelled")
            raise

    timer = bench.timer(100 * MS, wait)
    async with running(timer):
        await bench.manual.advance(0.1)
        timer.destroy()
        await settle()
        assert ended == ["cancelled"]
        timer.destroy()
        timer.cancel()
        with pytest.raises(EntityDestroyedError):
            timer.reset()
    del timer
    assert living(Ticker) <= tickers
    assert "waiting=0" in repr(bench.manual)


# ROS time


async def test_a_timer_on_ros_time_waits_for_the_clock_to_be_set() -> None:
    """Real time plays no part; a leap past several calls makes one (T4)."""
    bench = Bench()
    bench.clock.set_ros_time_active(True)
    async with running(bench.timer(1 * S)):
        await bench.manual.advance(100)
        assert bench.calls == []
        for seconds in (0.5, 0.999, 1.0, 1.5, 2.1, 7.5, 8.0):
            bench.set_ros_time(seconds)
            await settle()
    assert bench.calls == [1 * S, 2_100 * MS, 7_500 * MS, 8 * S]


async def test_a_clock_set_back_does_not_silence_a_timer() -> None:
    """A simulation that starts anew: the next call is one period from there (T4)."""
    bench = Bench()
    bench.set_ros_time(100)
    bench.clock.set_ros_time_active(True)
    async with running(bench.timer(1 * S)):
        bench.set_ros_time(101)
        await settle()
        bench.set_ros_time(3)
        await settle()
        bench.set_ros_time(3.9)
        await settle()
        assert bench.calls == [101 * S]
        bench.set_ros_time(4)
        await settle()
    assert bench.calls == [101 * S, 4 * S]


async def test_switching_the_source_keeps_what_was_waited() -> None:
    """0.7 s of the period are left, whichever clock counts them (T4)."""
    bench = Bench(start_s=1000)
    async with running(bench.timer(1 * S)):
        await bench.manual.advance(0.3)
        bench.set_ros_time(50)
        bench.clock.set_ros_time_active(True)
        await bench.manual.advance(10)
        bench.set_ros_time(50.69)
        await settle()
        assert bench.calls == []
        bench.set_ros_time(50.7)
        await settle()
        assert bench.calls == [50_700 * MS]
        bench.set_ros_time(51)
        bench.clock.set_ros_time_active(False)
        await bench.manual.advance(0.7)
    assert bench.calls == [50_700 * MS, 1011 * S]


class SettableTime(ManualClock):
    """A machine whose system clock can be set."""

    offset_ns = 0

    def system_ns(self) -> int:
        """Return what the system clock shows."""
        return super().system_ns() + self.offset_ns


@pytest.mark.parametrize("step_s", [-3600, -1, 0, 1, 3600])
@pytest.mark.parametrize("clock_type", [ClockType.ROS_TIME, ClockType.SYSTEM_TIME])
async def test_setting_the_system_clock_costs_a_timer_two_periods_at_most(
    step_s: int, clock_type: ClockType
) -> None:
    """The calls go on whatever NTP does, none comes early, and the loop is not flooded."""
    machine = SettableTime(Time(seconds=10_000))
    clock = Clock(clock_type, time_base=machine)
    calls: list[int] = []
    timer = Timer(lambda: calls.append(machine.steady_ns()), 100 * MS, clock, make_runner)
    async with running(timer):
        await machine.advance(1.05)
        machine.offset_ns = step_s * S
        await machine.advance(1)
    gaps = [after - before for before, after in pairwise(calls)]
    assert len(calls) >= 18
    assert min(gaps) >= 99 * MS
    assert max(gaps) <= 200 * MS


async def test_a_steady_timer_does_not_care_for_other_clocks() -> None:
    """Its grid is on the steady clock."""
    bench = Bench(clock_type=ClockType.STEADY_TIME)
    async with running(bench.timer(100 * MS)):
        await bench.manual.advance(0.2)
    assert bench.calls == [100 * MS, 200 * MS]


# Periods


@pytest.mark.parametrize(
    ("seconds", "ns"), [(0, 0), (1, S), (0.1, 100 * MS), (0.29, 290 * MS), (1e-9, 1)]
)
def test_a_period_in_seconds_is_rounded_to_nanoseconds(seconds: float, ns: int) -> None:
    """Cut off, 0.29 s would miss a nanosecond in each turn."""
    assert to_period_ns(seconds) == ns


@pytest.mark.parametrize(
    ("seconds", "error"),
    [
        (-1, ValueError),
        (float("nan"), ValueError),
        (float("inf"), ValueError),
        ("1", TypeError),
        (None, TypeError),
    ],
)
def test_what_is_no_period_is_refused(seconds: Any, error: type[Exception]) -> None:
    """The error comes where it is given."""
    with pytest.raises(error, match="period"):
        to_period_ns(seconds)


# Endurance


@pytest.mark.slow
@pytest.mark.asyncio(loop_factories=["asyncio"])
async def test_a_million_ticks_on_the_manual_clock() -> None:
    """No drift from the first to the millionth, each at its own time, and a stall costs one call.

    Most of the million fall into the stall: what a tick adds to the next one's time is the same for
    all, and `test_a_million_calls_do_not_drift` adds it a million times.
    """
    bench = Bench(start_s=1_700_000_000)
    start = bench.clock.now_ns()
    count = 0
    late = 0

    def check(info: TimerInfo) -> None:
        nonlocal count, late
        count += 1
        assert info.expected_call_time.nanoseconds - start == count * MS
        late += info.actual_call_time != info.expected_call_time

    timer = bench.timer(MS, check)
    async with running(timer):
        await bench.manual.advance(10)
        assert (count, late) == (10_000, 0)
        await bench.manual.jump(980.0005)
        assert (count, late) == (10_001, 1)
        count += 979_999  # left out
        await bench.manual.advance(9.9995)
    assert (count, late) == (1_000_000, 1)
    assert (timer.stats.received, timer.stats.dropped) == (20_001, 979_999)
