"""Loops on a grid of times."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from aionode.clock import ROSClock, Time
from aionode.endpoints.timer import Rate
from aionode.engine.rules.schedule import Ticker
from aionode.errors import EntityDestroyedError
from aionode.testing import ManualClock, settle
from tests.support.living import living

MS = 1_000_000


def make() -> tuple[ManualClock, ROSClock, Rate]:
    """Return a rate of 10 Hz on a clock that is stepped."""
    manual = ManualClock()
    clock = ROSClock(time_base=manual)
    return manual, clock, Rate(10, clock)


async def test_sleeps_end_on_the_grid() -> None:
    """However long the loop's body takes, as long as it is less than a period."""
    manual, clock, rate = make()
    turns: list[int] = []

    async def loop() -> None:
        for _ in range(3):
            await rate.sleep()
            turns.append(clock.now_ns())
            await clock.sleep(0.07)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(loop())
        await manual.advance(0.5)
    assert turns == [100 * MS, 200 * MS, 300 * MS]


async def test_a_slow_loop_turns_at_once_and_skips_what_it_missed() -> None:
    """Then it is on the grid again; nothing piles up."""
    manual, clock, rate = make()
    turns: list[int] = []

    async def loop() -> None:
        async for _ in rate:
            turns.append(clock.now_ns())
            if len(turns) == 1:
                await clock.sleep(0.35)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(loop())
        await manual.advance(0.61)
        rate.destroy()
    assert turns == [100 * MS, 450 * MS, 500 * MS, 600 * MS]
    assert repr(rate) == "<Rate 10 Hz skipped=2>"


async def test_several_tasks_share_each_turn() -> None:
    """No task takes a turn away from another."""
    manual, clock, rate = make()
    turns: list[int] = []

    async def loop() -> None:
        for _ in range(2):
            await rate.sleep()
            turns.append(clock.now_ns())

    async with asyncio.TaskGroup() as tasks:
        for _ in range(3):
            tasks.create_task(loop())
        await manual.advance(0.2)
    assert turns == [100 * MS] * 3 + [200 * MS] * 3


async def test_destroying_a_rate_ends_a_sleep_and_ends_an_iteration() -> None:
    """Later sleeps are refused, later iterations are empty."""
    _, _, rate = make()
    ended: list[str] = []

    async def iterate() -> None:
        assert [turn async for turn in rate] == []
        ended.append("iteration")

    async def sleep() -> None:
        with pytest.raises(EntityDestroyedError):
            await rate.sleep()
        ended.append("sleep")

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(iterate())
        tasks.create_task(sleep())
        await settle()
        rate.destroy()
        rate.destroy()
    assert ended == ["iteration", "sleep"]
    with pytest.raises(EntityDestroyedError):
        await rate.sleep()
    assert [turn async for turn in rate] == []


async def test_a_clock_knows_no_rate_that_was_destroyed() -> None:
    """A clock lives longer than the rates of a day."""
    tickers = living(Ticker)
    _, clock, rate = make()
    rate.destroy()
    del rate
    assert clock.ros_time_is_active is False
    assert living(Ticker) <= tickers


async def test_a_cancelled_sleep_takes_no_turn_away() -> None:
    """The next one still ends at it."""
    manual, clock, rate = make()
    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0):
            await rate.sleep()
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(rate.sleep())
        await manual.advance(0.1)
    assert clock.now_ns() == 100 * MS


async def test_a_rate_on_ros_time_follows_the_clock() -> None:
    """Even if it is set back."""
    _, clock, _ = make()
    clock.set_ros_time_override(Time(seconds=50))
    clock.set_ros_time_active(True)
    rate = Rate(1, clock)
    async with asyncio.TaskGroup() as tasks:
        first = tasks.create_task(rate.sleep())
        await settle()
        clock.set_ros_time_override(Time(seconds=3))
        await settle()
        assert not first.done()
        clock.set_ros_time_override(Time(seconds=4))
    assert first.done()


@pytest.mark.parametrize(
    ("frequency", "error"),
    [(None, TypeError), ("10", TypeError), (0.0, ValueError), (-1, ValueError)]
    + [(float(text), ValueError) for text in ("inf", "nan")],
)
def test_what_is_no_frequency_is_refused(frequency: Any, error: type[Exception]) -> None:
    """As in rclpy, where it is given."""
    with pytest.raises(error, match="rate"):
        Rate(frequency, ROSClock())
