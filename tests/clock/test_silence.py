"""Tests of the alarm on which deadlines and leases are built."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from aionode.clock import MachineTime, ROSClock, SilenceAlarm, SteadyClock, Time
from aionode.testing import ManualClock

if TYPE_CHECKING:
    from collections.abc import Callable


@pytest.fixture
def clock() -> ManualClock:
    """Return the time, which tests step."""
    return ManualClock()


def counting(found: list[int], *, again: bool) -> Callable[[int], bool]:
    """Return a function that records the periods of each call."""

    def note(periods: int) -> bool:
        found.append(periods)
        return again

    return note


async def test_it_counts_from_the_last_sign(clock: ManualClock) -> None:
    """This does not depend on how often it has rung since."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=True))
    alarm.start()
    await clock.advance(5)
    alarm.note()
    await clock.advance(0.9)
    alarm.note()
    await clock.advance(0.9)
    assert found == []
    await clock.advance(0.1)
    assert found == [1]
    await clock.advance(1)
    assert found == [1, 1]


async def test_it_may_wait_for_the_next_sign(clock: ManualClock) -> None:
    """A lease is lost only once."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=False))
    alarm.start()
    alarm.note()
    await clock.advance(5)
    assert found == [1]
    alarm.note()
    await clock.advance(5)
    assert found == [1, 1]


async def test_a_sign_that_was_read_late_counts(clock: ManualClock) -> None:
    """After a stall of the loop, the alarm rings before the sockets are read."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=True))
    alarm.start()
    alarm.note()

    def read_soon() -> None:
        asyncio.get_running_loop().call_soon(alarm.note)

    clock.call_at(10**9, read_soon)
    await clock.jump(1.5)
    assert found == []


async def test_nothing_rings_after_the_end(clock: ManualClock) -> None:
    """This holds even if the alarm has rung and is about to be judged."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=True))
    alarm.start()
    alarm.note()
    clock.call_at(10**9, alarm.stop)
    await clock.advance(5)
    assert found == []
    assert "waiting=0" in repr(clock)


async def test_it_works_on_the_time_of_the_machine() -> None:
    """Here no test steps the time."""
    rung = asyncio.Event()

    def ring(periods: int) -> bool:
        assert periods >= 1
        rung.set()
        return False

    alarm = SilenceAlarm(MachineTime(), 1_000_000, ring)
    alarm.start()
    alarm.note()
    await rung.wait()
    alarm.stop()


async def test_a_sign_may_be_forgotten(clock: ManualClock) -> None:
    """Then it waits for the next sign as for the first, even if it has just rung."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=False))
    alarm.start()
    alarm.note()
    assert alarm.periods() == 0
    clock.call_at(10**9, alarm.forget)
    await clock.advance(5)
    assert found == []
    assert alarm.periods() == 0
    alarm.note()
    await clock.advance(1)
    assert found == [1]


# By ROS time


@pytest.fixture
def ros_clock(clock: ManualClock) -> ROSClock:
    """Return a clock that a simulation sets."""
    one = ROSClock(time_base=clock)
    one.set_ros_time_active(True)
    one.set_ros_time_override(Time(seconds=100))
    return one


def set_to(ros_clock: ROSClock, seconds: float) -> None:
    """Set the clock as a message on /clock does."""
    ros_clock.set_ros_time_override(Time(nanoseconds=round(seconds * 1e9)))


async def test_a_slow_simulation_has_its_own_seconds(
    clock: ManualClock, ros_clock: ROSClock
) -> None:
    """Ten seconds in which the simulation advances by 0.9 s are less than a second."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=False), ros_clock)
    alarm.start()
    alarm.note()
    for step in range(1, 10):
        await clock.advance(0.9)
        set_to(ros_clock, 100 + step * 0.1)
    assert found == []
    set_to(ros_clock, 101.0)
    await clock.advance(0)
    assert found == [1]


async def test_a_fast_simulation_has_its_own_seconds(
    clock: ManualClock, ros_clock: ROSClock
) -> None:
    """Nothing is measured by the steady clock."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=False), ros_clock)
    alarm.start()
    alarm.note()
    set_to(ros_clock, 103)
    await clock.advance(0)
    assert found == [3]


async def test_a_clock_that_stands_still_is_silent_too(
    clock: ManualClock, ros_clock: ROSClock
) -> None:
    """A simulation that is paused or gone controls nothing."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=False), ros_clock)
    alarm.start()
    alarm.note()
    await clock.advance(0.5)
    set_to(ros_clock, 100.1)
    await clock.advance(0.9)
    assert found == []
    await clock.advance(0.1)
    assert found == [1]


async def test_a_jump_back_lengthens_nothing(clock: ManualClock, ros_clock: ROSClock) -> None:
    """A simulation that is reset 0.4 s before the end leaves 0.4 s."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=False), ros_clock)
    alarm.start()
    alarm.note()
    set_to(ros_clock, 100.6)
    set_to(ros_clock, 0)
    set_to(ros_clock, 0.3)
    await clock.advance(0)
    assert found == []
    set_to(ros_clock, 0.4)
    await clock.advance(0)
    assert found == [1]
    alarm.note()
    alarm.stop()
    set_to(ros_clock, 9)
    await clock.advance(9)
    assert found == [1]


async def test_a_clock_that_nobody_sets_counts_as_the_steady_one(clock: ManualClock) -> None:
    """Examples are ROS time without a simulation, and the machine's clocks."""
    found: list[int] = []
    for one in (ROSClock(time_base=clock), SteadyClock(time_base=clock)):
        alarm = SilenceAlarm(clock, 10**9, counting(found, again=False), one)
        alarm.start()
        alarm.note()
    await clock.advance(0.99)
    assert found == []
    await clock.advance(0.01)
    assert found == [1, 1]
