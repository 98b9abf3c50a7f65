"""The alarm that deadlines and leases are made of."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from aionode.clock import MachineTime, SilenceAlarm
from aionode.testing import ManualClock

if TYPE_CHECKING:
    from collections.abc import Callable


@pytest.fixture
def clock() -> ManualClock:
    """The time, which tests step."""
    return ManualClock()


def counting(found: list[int], *, again: bool) -> Callable[[int], bool]:
    """Return a function that notes the periods of each call."""

    def note(periods: int) -> bool:
        found.append(periods)
        return again

    return note


async def test_it_counts_from_the_last_sign(clock: ManualClock) -> None:
    """However often it has rung since."""
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
    """A lease is lost once."""
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
    """After a stall of the loop the alarm rings first, and then what waits in sockets is read."""
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
    """Not even when the alarm has rung already, and is about to be judged."""
    found: list[int] = []
    alarm = SilenceAlarm(clock, 10**9, counting(found, again=True))
    alarm.start()
    alarm.note()
    clock.call_at(10**9, alarm.stop)
    await clock.advance(5)
    assert found == []
    assert not clock._timer_heap


async def test_it_works_on_the_time_of_the_machine() -> None:
    """Where no test steps it."""
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
