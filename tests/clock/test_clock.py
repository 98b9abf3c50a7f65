"""Tests of Time, Duration, and the clocks that tell and await time."""

from __future__ import annotations

import asyncio
import errno
import gc
import math
import operator
import sys
import time  # noqa: TID251  # clocks are compared with the machine's
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
import uvloop
from hypothesis import given
from hypothesis import strategies as st

from aionode._process.concurrency import checkpoint
from aionode.clock import (
    Alarm,
    Clock,
    ClockChange,
    ClockType,
    Duration,
    Infinite,
    JumpHandle,
    JumpThreshold,
    MachineTime,
    ROSClock,
    SteadyClock,
    Time,
    TimeBase,
    TimeJump,
)
from aionode.clock import (
    _time_base as time_base,
)
from aionode.clock import (
    _timerfd as timerfd,
)
from aionode.clock.timer_heap import TimerHeap
from aionode.errors import EntityDestroyedError, TimeSourceChangedError
from aionode.testing import ManualClock, settle
from tests.support.living import living

INT64 = st.integers(-(2**63), 2**63 - 1)
STAMP = st.integers(0, 2**63 - 1)
REAL_TYPES = [ClockType.ROS_TIME, ClockType.SYSTEM_TIME, ClockType.STEADY_TIME]


def ros(seconds: float) -> Time:
    """Return a point in ROS time."""
    return Time(seconds=seconds, clock_type=ClockType.ROS_TIME)


# Points and spans


@pytest.mark.parametrize(
    ("seconds", "nanoseconds", "expected"),
    [(0, 0, 0), (1, 0, 10**9), (1.75, 0, 1_750_000_000), (1, 5e8, 1_500_000_000), (0, 1.9, 1)],
)
def test_a_time_is_the_sum_of_its_parts(seconds: float, nanoseconds: float, expected: int) -> None:
    """Fractions of a nanosecond are truncated, as in rclpy."""
    assert Time(seconds=seconds, nanoseconds=nanoseconds).nanoseconds == expected
    assert Duration(seconds=seconds, nanoseconds=nanoseconds).nanoseconds == expected


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda: Time(seconds=-1), ValueError),
        (lambda: Time(nanoseconds=-1), ValueError),
        (lambda: Time(nanoseconds=2**63), OverflowError),
        (lambda: Time(seconds=math.inf), OverflowError),
        (lambda: Time(seconds=math.nan), ValueError),
        (lambda: Time(clock_type="SYSTEM_TIME"), TypeError),  # type: ignore[arg-type]
        (lambda: Time(nanoseconds=2**63 - 1) + Duration(nanoseconds=1), OverflowError),
        (lambda: Duration(nanoseconds=1) + Time(nanoseconds=2**63 - 1), OverflowError),
        (lambda: Time(nanoseconds=1) - Duration(nanoseconds=2), ValueError),
        (lambda: Time(nanoseconds=1) + Time(nanoseconds=1), TypeError),  # type: ignore[operator]
        (lambda: Duration(nanoseconds=1) - Time(nanoseconds=1), TypeError),  # type: ignore[operator]
        (lambda: Time(nanoseconds=1) < Duration(nanoseconds=1), TypeError),
        (lambda: Duration(nanoseconds=1) >= Time(nanoseconds=1), TypeError),
        (lambda: Duration(nanoseconds=2**63), OverflowError),
        (lambda: Duration(nanoseconds=-(2**63) - 1), OverflowError),
        (lambda: Duration(seconds=1) * math.nan, ValueError),
        (lambda: Duration(seconds=1) * -math.inf, ValueError),
        (lambda: Duration(seconds=1) * "2", TypeError),  # type: ignore[operator]
        (lambda: Infinite * 2, OverflowError),
    ],
)
def test_what_makes_no_time_is_refused(make: Callable[[], Any], error: type[Exception]) -> None:
    """The kinds of errors are rclpy's, so code that handles them works with both."""
    with pytest.raises(error):
        make()


@pytest.mark.parametrize(
    "operation",
    [
        lambda a, b: a == b,
        lambda a, b: a != b,
        lambda a, b: a < b,
        lambda a, b: a <= b,
        lambda a, b: a > b,
        lambda a, b: a >= b,
        lambda a, b: a - b,
    ],
)
def test_times_of_different_clocks_do_not_mix(operation: Callable[[Time, Time], Any]) -> None:
    """Any result would be wrong, because their zeros differ."""
    with pytest.raises(TypeError, match="different clock types, STEADY_TIME and ROS_TIME"):
        operation(Time(clock_type=ClockType.STEADY_TIME), ros(0))


def test_a_time_equals_nothing_but_times() -> None:
    """Comparing with a number or a duration is False rather than an error, as in rclpy."""
    assert Time(nanoseconds=1) != 1
    assert Time(nanoseconds=1) != Duration(nanoseconds=1)
    assert Duration(nanoseconds=1) != 1


@given(STAMP, INT64)
def test_taking_away_undoes_adding(stamp_ns: int, span_ns: int) -> None:
    """Arithmetic is exact wherever the result can be represented."""
    start, span = Time(nanoseconds=stamp_ns), Duration(nanoseconds=span_ns)
    if not 0 <= stamp_ns + span_ns < 2**63:
        with pytest.raises((OverflowError, ValueError)):
            start + span
        return
    end = start + span
    assert end == span + start
    assert end - span == start
    assert end - start == span


@given(INT64, INT64)
def test_durations_add_up_as_integers_do(a_ns: int, b_ns: int) -> None:
    """No float is involved."""
    a, b = Duration(nanoseconds=a_ns), Duration(nanoseconds=b_ns)
    if -(2**63) <= a_ns + b_ns < 2**63:
        assert (a + b).nanoseconds == a_ns + b_ns
        assert (a + b) - b == a
    else:
        with pytest.raises(OverflowError):
            a + b


@given(STAMP, STAMP, st.sampled_from(REAL_TYPES))
def test_times_are_ordered_and_hashed_by_their_nanoseconds(
    a_ns: int, b_ns: int, clock_type: ClockType
) -> None:
    """Times can be keys, and can be sorted."""
    a = Time(nanoseconds=a_ns, clock_type=clock_type)
    b = Time(nanoseconds=b_ns, clock_type=clock_type)
    outcomes = (a < b, a <= b, a > b, a >= b, a == b, a != b)
    assert outcomes == (
        a_ns < b_ns,
        a_ns <= b_ns,
        a_ns > b_ns,
        a_ns >= b_ns,
        a_ns == b_ns,
        a_ns != b_ns,
    )
    assert hash(a) == hash(Time(nanoseconds=a_ns, clock_type=clock_type))


@given(INT64, INT64)
def test_durations_are_ordered_and_hashed_by_their_nanoseconds(a_ns: int, b_ns: int) -> None:
    """This includes negative ones."""
    a, b = Duration(nanoseconds=a_ns), Duration(nanoseconds=b_ns)
    assert (a < b, a <= b, a > b, a >= b) == (a_ns < b_ns, a_ns <= b_ns, a_ns > b_ns, a_ns >= b_ns)
    assert (a == b) is (a_ns == b_ns)
    assert hash(a) == hash(Duration(nanoseconds=a_ns))


def test_nothing_else_is_compared_with_or_added_to_a_time() -> None:
    """Both operands are asked first, then it is a TypeError."""
    for value in (Time(nanoseconds=1), Duration(nanoseconds=1)):
        for operation in (operator.add, operator.sub, operator.lt, operator.le, operator.gt):
            with pytest.raises(TypeError):
                operation(value, 1)
    assert repr(TimeJump(ClockChange.ROS_TIME_ACTIVATED, Duration())) == (
        "TimeJump(clock_change=ROS_TIME_ACTIVATED, delta=Duration(nanoseconds=0))"
    )


def test_a_duration_is_stretched_by_numbers() -> None:
    """Times infinity is infinite; integer factors may exceed the range of a float."""
    assert Duration(seconds=2) * 0.5 == Duration(seconds=1)
    assert 3 * Duration(seconds=2) == Duration(seconds=6)
    assert Duration(nanoseconds=2**60 + 1) * 3 == Duration(nanoseconds=3 * 2**60 + 3)
    assert Duration(seconds=1) * math.inf is Infinite
    assert -Duration(seconds=1) == Duration(seconds=-1)


def test_times_say_what_they_are() -> None:
    """The texts are rclpy's, so logs of both look the same."""
    assert repr(ros(1.5)) == "Time(nanoseconds=1500000000, clock_type=ROS_TIME)"
    assert repr(Duration(nanoseconds=7)) == "Duration(nanoseconds=7)"
    assert str(Duration(nanoseconds=7)) == "7 nanoseconds"
    assert str(Infinite) == "Infinite"
    assert Time(nanoseconds=1_500_000_002).seconds_nanoseconds() == (1, 500_000_002)


@given(STAMP.filter(lambda ns: ns < 2**31 * 10**9))
def test_a_stamp_survives_a_message(stamp_ns: int) -> None:
    """A header's stamp keeps every nanosecond."""
    stamp = Time(nanoseconds=stamp_ns, clock_type=ClockType.ROS_TIME)
    assert Time.from_msg(stamp.to_msg()) == stamp


@given(st.integers(-(2**31) * 10**9, (2**31 - 1) * 10**9))
def test_a_duration_survives_a_message(span_ns: int) -> None:
    """A negative one has negative seconds and positive nanoseconds."""
    span = Duration(nanoseconds=span_ns)
    msg = span.to_msg()
    assert 0 <= msg.nanosec < 10**9
    assert Duration.from_msg(msg) == span


def test_a_stamp_is_of_the_clock_one_says() -> None:
    """The default is ROS time, as in rclpy."""
    msg = ros(3).to_msg()
    assert Time.from_msg(msg).clock_type is ClockType.ROS_TIME
    assert Time.from_msg(msg, clock_type=ClockType.SYSTEM_TIME) == Time(seconds=3)


@pytest.mark.parametrize("read", [Time.from_msg, Duration.from_msg])
def test_only_the_fitting_message_is_read(read: Callable[[Any], Any]) -> None:
    """Any other object with a `sec` would give nonsense."""
    with pytest.raises(TypeError, match="builtin_interfaces/msg/"):
        read(12)


# Clocks that tell the time


@pytest.mark.parametrize("clock_type", REAL_TYPES)
def test_a_clock_tells_its_own_time(clock_type: ClockType) -> None:
    """Each type reads its own source."""
    now = Clock(clock_type=clock_type).now()
    real_ns = time.monotonic_ns() if clock_type is ClockType.STEADY_TIME else time.time_ns()
    assert now.clock_type is clock_type
    assert abs(now.nanoseconds - real_ns) < 60e9


def test_a_clock_of_ros_time_is_a_ros_clock() -> None:
    """As in rclpy, this does not depend on how it is created."""
    assert isinstance(Clock(clock_type=ClockType.ROS_TIME), ROSClock)
    assert ROSClock().clock_type is ClockType.ROS_TIME
    assert SteadyClock().clock_type is ClockType.STEADY_TIME
    assert Clock().clock_type is ClockType.SYSTEM_TIME
    assert repr(ROSClock()) == "Clock(clock_type=ROS_TIME)"


@pytest.mark.parametrize(
    ("clock_type", "error"), [("STEADY_TIME", TypeError), (ClockType.UNINITIALIZED, ValueError)]
)
def test_a_clock_needs_a_real_type(clock_type: Any, error: type[Exception]) -> None:
    """There is no clock without one."""
    with pytest.raises(error, match="clock_type"):
        Clock(clock_type=clock_type)


# ROS time


def test_ros_time_starts_at_zero() -> None:
    """Before the first tick of a simulation its time is unknown; system time would be wrong."""
    assert not ROSClock().ros_time_is_active
    clock = ROSClock()
    clock.set_ros_time_active(True)
    assert clock.ros_time_is_active
    assert clock.now() == ros(0)
    clock.set_ros_time_override(ros(12))
    assert clock.now() == ros(12)


def test_ros_time_set_before_it_is_switched_on_is_kept() -> None:
    """Switching off returns to system time, which was not changed."""
    clock = ROSClock(time_base=ManualClock(ros(100)))
    clock.set_ros_time_override(ros(7))
    assert clock.now() == ros(100)
    clock.set_ros_time_active(True)
    assert clock.now() == ros(7)
    clock.set_ros_time_active(False)
    assert clock.now() == ros(100)


@pytest.mark.parametrize("clock", [Clock(), SteadyClock()])
def test_only_ros_time_can_be_set(clock: Clock) -> None:
    """A simulation may not change the machine's time."""
    with pytest.raises(TypeError, match="ROS_TIME"):
        clock.set_ros_time_override(Time())
    with pytest.raises(TypeError, match="ROS_TIME"):
        clock.set_ros_time_active(True)
    assert not clock.ros_time_is_active


def test_ros_time_is_set_with_a_time() -> None:
    """A plain number could mean seconds or nanoseconds."""
    with pytest.raises(TypeError, match="pass a Time"):
        ROSClock().set_ros_time_override(5)  # type: ignore[arg-type]


# Jump callbacks


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"min_forward": Duration(), "min_backward": None}, "min_forward"),
        ({"min_forward": Duration(seconds=-1), "min_backward": None}, "min_forward"),
        ({"min_forward": None, "min_backward": Duration()}, "min_backward"),
        ({"min_forward": None, "min_backward": Duration(seconds=1)}, "min_backward"),
        ({"min_forward": None, "min_backward": None, "on_clock_change": False}, "enabled"),
    ],
)
def test_a_threshold_must_make_sense(arguments: dict[str, Any], text: str) -> None:
    """The sign gives the direction, and a threshold that nothing can meet is a mistake."""
    with pytest.raises(ValueError, match=text):
        JumpThreshold(**arguments)


class Watch:
    """Counts the calls of a pair of jump callbacks."""

    def __init__(self, clock: Clock, forward: float, back: float, *, change: bool) -> None:
        self.jumps: list[TimeJump] = []
        self.before: list[Time] = []
        self.clock = clock
        self.handle = clock.create_jump_callback(
            JumpThreshold(
                min_forward=Duration(seconds=forward) if forward else None,
                min_backward=Duration(seconds=back) if back else None,
                on_clock_change=change,
            ),
            pre_callback=lambda: self.before.append(clock.now()),
            post_callback=self.jumps.append,
        )


@pytest.mark.parametrize(
    ("forward", "back", "change", "to", "called"),
    [
        (1.0, -0.5, False, 1.75, False),
        (0.5, -1.0, False, 1.75, True),
        (0.75, 0, False, 1.75, True),  # a jump of exactly that length meets a threshold
        (1.0, -0.5, False, 0.25, True),
        (0.5, -1.0, False, 0.25, False),
        (0, -0.75, True, 0.25, True),
        (0, -0.1, True, 1.75, False),
        (0.1, -0.1, True, 1.0, False),  # setting the same time is not a jump
        (0, 0, True, 1.75, False),
    ],
)
def test_a_jump_calls_callbacks_whose_threshold_it_meets(
    forward: float, back: float, change: bool, to: float, called: bool
) -> None:
    """The clock starts at 1 s; the first callback sees the old time, the second the distance."""
    clock = ROSClock()
    clock.set_ros_time_override(ros(1))
    clock.set_ros_time_active(True)
    watch = Watch(clock, forward, back, change=change)

    clock.set_ros_time_override(ros(to))

    assert watch.before == ([ros(1)] if called else [])
    assert [jump.delta for jump in watch.jumps] == ([ros(to) - ros(1)] if called else [])
    assert all(j.clock_change is ClockChange.ROS_TIME_NO_CHANGE for j in watch.jumps)


@pytest.mark.parametrize(
    ("forward", "back", "change", "called"),
    [(1, -1, False, False), (0, 0, True, True), (1, -1, True, True)],
)
def test_switching_the_source_calls_callbacks_that_asked_for_it(
    forward: float, back: float, change: bool, called: bool
) -> None:
    """They are called once for each actual switch."""
    clock = ROSClock()
    watch = Watch(clock, forward, back, change=change)
    for active in (True, True, False, False):
        clock.set_ros_time_active(active)
    expected = [ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED]
    assert [jump.clock_change for jump in watch.jumps] == (expected if called else [])


def test_setting_a_clock_that_is_not_driven_is_no_jump() -> None:
    """The time that was set is not visible yet."""
    clock = ROSClock()
    watch = Watch(clock, 0.1, -0.1, change=True)
    clock.set_ros_time_override(ros(50))
    assert watch.jumps == []


def test_an_unregistered_callback_is_not_called() -> None:
    """This holds after `unregister`, which may be called twice, and after the `with` block."""
    clock = ROSClock()
    watch = Watch(clock, 0.1, -0.1, change=True)
    watch.handle.unregister()
    watch.handle.unregister()
    threshold = JumpThreshold(min_forward=None, min_backward=None)
    seen: list[TimeJump] = []
    with clock.create_jump_callback(threshold, post_callback=seen.append) as handle:
        assert isinstance(handle, JumpHandle)
        clock.set_ros_time_active(True)
    clock.set_ros_time_active(False)
    assert len(seen) == 1
    assert watch.jumps == []


def test_a_callback_may_unregister_another() -> None:
    """An entity that a jump destroys is not called any more."""
    clock = ROSClock()
    threshold = JumpThreshold(min_forward=None, min_backward=None)
    seen: list[TimeJump] = []
    clock.create_jump_callback(
        threshold,
        pre_callback=lambda: late.unregister(),  # noqa: PLW0108  # it does not exist yet
    )
    late = clock.create_jump_callback(threshold, post_callback=seen.append)
    clock.set_ros_time_active(True)
    assert seen == []


def test_a_jump_callback_must_be_one() -> None:
    """No callback, or one that is not callable, is a mistake of the caller."""
    threshold = JumpThreshold(min_forward=None, min_backward=None)
    with pytest.raises(ValueError, match="one of pre_callback and post_callback"):
        ROSClock().create_jump_callback(threshold)
    with pytest.raises(ValueError, match="callable"):
        ROSClock().create_jump_callback(threshold, pre_callback=3)  # type: ignore[arg-type]


# Sleeping


@pytest.mark.parametrize("clock_type", REAL_TYPES)
@pytest.mark.parametrize("duration_sec", [0, -1.0, -math.inf])
async def test_sleeping_for_nothing_takes_one_turn(
    clock_type: ClockType, duration_sec: float
) -> None:
    """Other callbacks run, and no time passes."""
    turns: list[int] = []
    asyncio.get_running_loop().call_soon(turns.append, 1)
    await Clock(clock_type=clock_type, time_base=ManualClock()).sleep(duration_sec)
    assert turns == [1]


@pytest.fixture(params=["kernel", "loop"])
def alarms(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Run with the kernel's timers, and as on systems without them."""
    if request.param == "loop":
        monkeypatch.setattr(time_base, "kernel_alarms", lambda *_, **__: None)


@pytest.mark.usefixtures("alarms")
@pytest.mark.parametrize("clock_type", REAL_TYPES)
@pytest.mark.parametrize("duration_ns", [1, 300_000, 1_400_000, 1_600_000])
async def test_a_sleep_is_never_too_short(clock_type: ClockType, duration_ns: int) -> None:
    """Loops round waits, uvloop by half a millisecond, so the clock checks the time again."""
    clock = Clock(clock_type=clock_type)
    began_ns = time.monotonic_ns()
    await clock.sleep(duration_ns / 1e9)
    assert time.monotonic_ns() - began_ns >= duration_ns
    until = clock.now() + Duration(nanoseconds=duration_ns)
    await clock.sleep_until(until)
    assert clock.now() >= until


async def test_sleepers_wake_each_at_its_own_time() -> None:
    """Sleeps on one clock are independent of each other."""
    manual = ManualClock()
    clock = ROSClock(time_base=manual)
    woken: list[tuple[float, int]] = []

    async def sleeper(duration_sec: float) -> None:
        await clock.sleep(duration_sec)
        woken.append((duration_sec, clock.now().nanoseconds))

    async with asyncio.TaskGroup() as tasks:
        for duration_sec in (0.3, 0.1, 0.2):
            tasks.create_task(sleeper(duration_sec))
        await manual.advance(0.25)
        assert woken == [(0.1, 100_000_000), (0.2, 200_000_000)]
        await manual.advance(0.05)
    assert woken[2] == (0.3, 300_000_000)


async def test_a_sleep_in_ros_time_ends_when_the_clock_is_set_past_its_end() -> None:
    """Real time plays no part, and a jump wakes only those whose time has come."""
    manual = ManualClock()
    clock = ROSClock(time_base=manual)
    clock.set_ros_time_active(True)
    clock.set_ros_time_override(ros(10))
    async with asyncio.TaskGroup() as tasks:
        first, second = (tasks.create_task(clock.sleep(span)) for span in (1.0, 5.0))
        third = tasks.create_task(clock.sleep_until(ros(20)))
        await manual.advance(100)
        assert not first.done()
        clock.set_ros_time_override(Time(nanoseconds=10_999_999_999))
        await settle()
        assert not first.done()
        clock.set_ros_time_override(ros(13))
        await settle()
        assert first.done()
        assert not second.done()
        assert not third.done()
        clock.set_ros_time_override(ros(9))
        clock.set_ros_time_override(ros(20))


@pytest.mark.parametrize("active", [True, False])
async def test_switching_ros_time_ends_a_sleep_with_an_error(active: bool) -> None:
    """Its end has lost its meaning: only the sleeper knows how long it still has to wait."""
    clock = ROSClock(time_base=ManualClock())
    clock.set_ros_time_active(not active)
    asyncio.get_running_loop().call_soon(clock.set_ros_time_active, active)
    with pytest.raises(TimeSourceChangedError, match="sleep again") as caught:
        await clock.sleep(999)
    assert caught.value.active is active


async def test_destroying_a_clock_ends_its_sleeps() -> None:
    """Their clock will never be set again."""
    clock = ROSClock(time_base=ManualClock())
    asyncio.get_running_loop().call_soon(clock.destroy)
    with pytest.raises(EntityDestroyedError):
        await clock.sleep(999)


@pytest.mark.parametrize("duration_sec", [0.0, 1.0])
async def test_a_destroyed_clock_refuses_sleepers(duration_sec: float) -> None:
    """It is a RuntimeError, as in rclpy; the time can still be read."""
    clock = ROSClock(time_base=ManualClock(ros(3)))
    clock.destroy()
    with pytest.raises(EntityDestroyedError):
        await clock.sleep(duration_sec)
    with pytest.raises(RuntimeError):
        await clock.sleep_until(ros(9))
    assert clock.now() == ros(3)


async def test_sleep_until_needs_a_time_of_its_own_clock() -> None:
    """It is a ValueError, as in rclpy."""
    with pytest.raises(ValueError, match="clock type does not match"):
        await Clock().sleep_until(ros(1))


async def test_sleep_until_a_time_gone_by_takes_one_turn() -> None:
    """There is nothing to wait for."""
    turns: list[int] = []
    asyncio.get_running_loop().call_soon(turns.append, 1)
    await ROSClock(time_base=ManualClock(ros(5))).sleep_until(ros(5))
    assert turns == [1]


async def test_a_cancelled_sleep_leaves_nothing_behind() -> None:
    """The memory of a program that cancels many sleeps does not grow."""
    manual = ManualClock()
    clock = ROSClock(time_base=manual)
    futures = living(asyncio.Future)
    for active in (False, True) * 50:
        clock.set_ros_time_active(active)
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0):
                await clock.sleep(5)
    assert "waiting=0" in repr(manual)
    assert living(asyncio.Future) < futures + 10


class SettableTime(ManualClock):
    """Represents a machine whose system clock can be set."""

    offset_ns = 0

    def system_ns(self) -> int:
        """Return what the system clock shows."""
        return super().system_ns() + self.offset_ns


async def test_setting_the_system_clock_changes_no_sleep() -> None:
    """A second stays a second, even if NTP sets the clock back by an hour meanwhile."""
    machine = SettableTime(ros(10_000))
    clock = ROSClock(time_base=machine)
    async with asyncio.TaskGroup() as tasks:
        sleep = tasks.create_task(clock.sleep(1))
        until = tasks.create_task(clock.sleep_until(ros(10_001)))
        await settle()
        machine.offset_ns = -3600 * 10**9
        await machine.advance(1)
        assert sleep.done()
        assert not until.done()  # that time is what the clock shows, and it does not show it yet
        await machine.advance(3600)
        assert until.done()


# Alarms


@pytest.mark.usefixtures("alarms")
@pytest.mark.parametrize("machine", [MachineTime(), MachineTime().through_suspend()])
async def test_a_machine_alarm_rings_once_and_not_too_early(machine: TimeBase) -> None:
    """This holds however the loop rounds, and for either steady clock."""
    rung: asyncio.Future[int] = asyncio.get_running_loop().create_future()
    when_ns = machine.steady_ns() + 1_400_000
    machine.call_at(when_ns, lambda: rung.set_result(machine.steady_ns()))
    assert await rung >= when_ns


@pytest.mark.parametrize("base", [MachineTime(), ManualClock()])
async def test_an_alarm_in_the_past_rings_later_all_the_same(
    base: MachineTime | ManualClock,
) -> None:
    """It never rings inside `call_at`: the caller has not finished yet."""
    rung = asyncio.Event()
    alarm: Alarm = base.call_at(base.steady_ns() - 5, rung.set)
    assert not rung.is_set()
    if isinstance(base, ManualClock):
        await base.advance(0)
    await rung.wait()
    alarm.cancel()


@pytest.mark.usefixtures("alarms")
async def test_a_cancelled_alarm_does_not_ring() -> None:
    """This holds even if it is due, but the loop has not reached it yet."""
    machine = MachineTime()
    rung: list[int] = []
    alarm = machine.call_at(machine.steady_ns(), lambda: rung.append(1))
    alarm.cancel()
    alarm.cancel()
    later = asyncio.Event()
    machine.call_at(machine.steady_ns() + 1_000_000, later.set)
    await later.wait()
    assert rung == []


@pytest.mark.skipif(sys.platform != "linux", reason="Linux has timerfd")
async def test_alarms_ring_in_the_order_of_their_times() -> None:
    """The order in which they were set does not matter, even if several are due at once.

    Timers of a loop begin when they are set, so that a pause between two may change their order.
    """
    machine = MachineTime()
    rung: list[int] = []
    done = asyncio.Event()
    now_ns = machine.steady_ns()
    machine.call_at(now_ns + 20_000_000, done.set)
    for delay_ms in (3, 1, 9, 6, -5):
        machine.call_at(now_ns + delay_ms * 1_000_000, partial(rung.append, delay_ms))
    await done.wait()
    assert rung == [-5, 1, 3, 6, 9]


def open_files() -> int:
    """Return how many files this process has open."""
    return len(list(Path("/proc/self/fd").iterdir()))


@pytest.mark.skipif(sys.platform != "linux", reason="Linux has timerfd")
async def test_no_file_is_left_when_no_alarm_waits() -> None:
    """This holds after one has rung, and after the last one was cancelled."""
    before = open_files()
    machine = MachineTime()
    rung = asyncio.Event()
    machine.call_at(machine.steady_ns() + 1_000_000, rung.set)
    cancelled = machine.call_at(machine.steady_ns() + 10**15, rung.set)
    assert open_files() == before + 1
    await rung.wait()
    await settle()
    assert open_files() == before + 1
    cancelled.cancel()
    await settle()
    assert open_files() == before


@pytest.mark.skipif(sys.platform != "linux", reason="Linux has timerfd")
async def test_an_alarm_may_count_what_the_host_is_suspended() -> None:
    """A robot that wakes up has heard nothing meanwhile, and CLOCK_MONOTONIC has stood still."""
    base = MachineTime().through_suspend()
    before = set(timer_clocks())
    alarm = base.call_at(base.steady_ns() + 10**15, print)
    [added] = set(timer_clocks()) - before
    assert added[1] == time.CLOCK_BOOTTIME
    assert abs(base.steady_ns() - time.clock_gettime_ns(time.CLOCK_BOOTTIME)) < 10**9
    assert base.system_ns is MachineTime.system_ns
    alarm.cancel()
    await settle()


def timer_clocks() -> Iterator[tuple[str, int]]:
    """Yield each open timer file, with its clock."""
    for entry in Path("/proc/self/fdinfo").iterdir():
        with suppress(OSError):
            for line in entry.read_text(encoding="ascii").splitlines():
                if line.startswith("clockid:"):
                    yield entry.name, int(line.split()[1])


def test_time_that_is_stepped_is_suspended_with_nothing() -> None:
    """A manual clock is not affected by suspension."""
    clock = ManualClock()
    assert clock.through_suspend() is clock


@pytest.mark.skipif(sys.platform != "linux", reason="Linux has timerfd")
@pytest.mark.parametrize("new_loop", [asyncio.new_event_loop, uvloop.new_event_loop])
def test_no_file_is_left_by_a_loop_that_ends(
    new_loop: Callable[[], asyncio.AbstractEventLoop],
) -> None:
    """This holds even if it is closed while an alarm is waiting."""

    async def main() -> None:
        machine = MachineTime()
        machine.call_at(machine.steady_ns() + 10**15, print)

    gc.collect()
    before = open_files()
    loop = new_loop()
    loop.run_until_complete(main())
    loop.close()
    del loop
    gc.collect()
    assert open_files() == before


@pytest.mark.skipif(sys.platform != "linux", reason="Linux has timerfd")
def test_an_alarm_cancelled_after_its_loop_lets_go_of_the_file() -> None:
    """A program may still cancel alarms after its loop was closed."""

    async def main() -> Alarm:
        machine = MachineTime()
        return machine.call_at(machine.steady_ns() + 10**15, print)

    before = open_files()
    loop = asyncio.new_event_loop()
    alarm = loop.run_until_complete(main())
    loop.close()
    alarm.cancel()
    assert open_files() == before


@pytest.mark.skipif(sys.platform != "linux", reason="Linux has timerfd")
async def test_a_loop_that_cannot_wait_for_files_rings_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It uses its own timers, and does not leave the file open."""

    def refuse(*_: object) -> None:
        raise NotImplementedError

    before = open_files()
    alarms = timerfd.KernelAlarms
    loop = mock.Mock(wraps=asyncio.get_running_loop(), add_reader=refuse)
    monkeypatch.setattr(timerfd, "KernelAlarms", lambda _: alarms(loop))
    machine = MachineTime()
    rung = asyncio.Event()
    machine.call_at(machine.steady_ns() + 1_000_000, rung.set)
    await rung.wait()
    assert open_files() == before


@pytest.mark.skipif(sys.platform != "linux", reason="Linux has timerfd")
async def test_a_false_alarm_calls_nothing() -> None:
    """The file may be reported as readable, and be set to another time before it is read."""
    rung = asyncio.Event()
    alarms = timerfd.KernelAlarms(asyncio.get_running_loop())
    alarm = alarms.add(10**18, rung.set)
    alarms._expired()
    assert not rung.is_set()
    assert len(alarms) == 1
    alarm.cancel()
    await settle()


@pytest.mark.parametrize("broken", ["libc", "open_timer"])
async def test_without_the_kernels_timers_the_loop_rings(
    broken: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A system without them, or without a free descriptor, is less exact but works."""

    def fail(*_: object) -> None:
        raise OSError(errno.EMFILE, "too many")

    machine = MachineTime()
    monkeypatch.setattr(timerfd, broken, fail)
    rung = asyncio.Event()
    machine.call_at(machine.steady_ns() + 1_000_000, rung.set)
    await rung.wait()


async def test_a_failing_alarm_does_not_silence_the_others() -> None:
    """The loop reports its error; other alarms due at the same time still ring."""

    def fail() -> None:
        raise ZeroDivisionError

    reported: list[Any] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, context: reported.append(context))
    machine = MachineTime()
    rung = asyncio.Event()
    when_ns = machine.steady_ns() + 1_000_000
    machine.call_at(when_ns, fail)
    machine.call_at(when_ns, rung.set)
    await rung.wait()
    assert isinstance(reported[0]["exception"], ZeroDivisionError)


# The timer heap


@given(st.lists(st.tuples(st.integers(0, 20), st.booleans())), st.integers(0, 20))
def test_a_timer_heap_calls_what_is_due_in_order(entries: list[tuple[int, bool]], now: int) -> None:
    """The order is by time, then by arrival; cancelled entries are skipped, others stay."""
    heap = TimerHeap()
    called: list[tuple[int, int]] = []
    for number, (when, cancelled) in enumerate(entries):
        item = (when, number)
        entry = heap.add(when, lambda item=item: called.append(item))  # type: ignore[misc]
        if cancelled:
            entry.cancel()
            entry.cancel()
    alive = sorted((when, n) for n, (when, cancelled) in enumerate(entries) if not cancelled)
    assert len(heap) == len(alive)
    assert heap.first_ns() == (alive[0][0] if alive else None)

    heap.fire(now)

    assert called == [item for item in alive if item[0] <= now]
    assert len(heap) == len(alive) - len(called)


def test_a_timer_heap_forgets_cancelled_entries() -> None:
    """A timer that is reset again and again must not fill the memory."""
    heap = TimerHeap()
    keep = heap.add(1, lambda: None)
    entries = living(type(keep))
    for _ in range(1000):
        heap.add(5, lambda: None).cancel()
    assert len(heap) == 1
    assert living(type(keep)) < entries + 200
    keep.cancel()
    assert heap.first_ns() is None


def test_what_a_callback_adds_waits_for_the_next_round() -> None:
    """Otherwise a period of 0 would never end a round; a callback may also cancel another."""
    heap = TimerHeap()
    called: list[str] = []

    def first() -> None:
        called.append("first")
        heap.add(0, lambda: called.append("added"))
        second.cancel()

    heap.add(0, first)
    second = heap.add(0, lambda: called.append("second"))
    heap.fire(0)
    assert called == ["first"]
    heap.fire(0)
    assert called == ["first", "added"]
    assert len(heap) == 0


# Manual time


async def test_manual_time_stands_still() -> None:
    """Its type is ROS_TIME, like a node's clock, and it begins where the test says."""
    assert ManualClock().now() == ros(0)
    manual = ManualClock(ros(5))
    assert manual.now() == ros(5)
    await manual.advance(1.5)
    assert manual.now() == ros(6.5)
    await manual.jump(0.5)
    assert manual.now() == ros(7)
    assert repr(manual) == "<ManualClock now=7.000000000 waiting=0>"


@pytest.mark.parametrize("move", [ManualClock.advance, ManualClock.jump])
async def test_manual_time_does_not_go_back(move: Any) -> None:
    """Jumps back are made with `set_ros_time_override`."""
    with pytest.raises(ValueError, match="does not go back"):
        await move(ManualClock(), -1)


async def test_advance_walks_and_jump_leaps() -> None:
    """Callbacks see each step of `advance`, but only the end of a `jump`."""
    manual = ManualClock()
    clock = ROSClock(time_base=manual)
    seen: list[float] = []

    async def stepper() -> None:
        for _ in range(4):
            await clock.sleep(1)
            seen.append(clock.now().nanoseconds / 1e9)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(stepper())
        await manual.advance(2.5)
        assert seen == [1, 2]
        await manual.jump(10)
        assert seen == [1, 2, 12.5]
        await manual.advance(1)
    assert seen == [1, 2, 12.5, 13.5]


async def test_advance_settles_between_two_points_in_time() -> None:
    """A chain of callbacks ends before time moves on, however many iterations it takes."""
    manual = ManualClock()
    clock = ROSClock(time_base=manual)
    seen: list[tuple[str, float]] = []

    async def chain() -> None:
        await clock.sleep(1)
        for _ in range(50):
            await checkpoint()
        seen.append(("chain", clock.now().nanoseconds / 1e9))

    async def other() -> None:
        await clock.sleep(1.001)
        seen.append(("other", clock.now().nanoseconds / 1e9))

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(chain())
        tasks.create_task(other())
        await manual.advance(2)
    assert seen == [("chain", 1.0), ("other", 1.001)]


def test_the_type_of_a_clock_is_printed_by_name() -> None:
    """Of an `IntEnum`, Python prints the number; rclpy's type is another class."""
    assert f"{ClockType.ROS_TIME}" == "ClockType.ROS_TIME"
    assert int(ClockType.ROS_TIME) == 1
