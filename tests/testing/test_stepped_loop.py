"""A loop whose time is that of a manual clock, and whose threads end in order."""

from __future__ import annotations

import asyncio
import threading

import pytest

from aionode.testing import ManualClock, SteppedLoop

SECOND = 1_000_000_000


@pytest.fixture
def clock() -> ManualClock:
    """A clock that stands at 0."""
    return ManualClock()


async def test_sleeps_and_timeouts_follow_the_clock(clock: ManualClock) -> None:
    """Nodes may use asyncio's own functions, and aionode's calls with a time limit do."""
    seen: list[tuple[str, int]] = []

    async def sleep(seconds: float) -> None:
        await asyncio.sleep(seconds)  # noqa: TID251  # it is what is tested
        seen.append(("slept", clock.steady_ns()))

    async def give_up() -> None:
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(2.5):
                await asyncio.Event().wait()
        seen.append(("gave up", clock.steady_ns()))

    async with asyncio.TaskGroup() as tasks:
        with SteppedLoop(clock) as stepped:
            tasks.create_task(sleep(3))
            tasks.create_task(sleep(1))
            tasks.create_task(give_up())
            await stepped.settle()
            await stepped.walk_to(4 * SECOND)

    assert seen == [("slept", SECOND), ("gave up", 5 * SECOND // 2), ("slept", 3 * SECOND)]


async def test_threads_end_in_the_order_in_which_they_began(clock: ManualClock) -> None:
    """Which thread is faster depends on the machine, so it must not decide what runs next."""
    seen: list[str] = []
    second_has_ended = threading.Event()

    async def call(name: str, wait_for: threading.Event | None) -> None:
        await asyncio.to_thread(lambda: wait_for.wait() if wait_for else second_has_ended.set())
        seen.append(name)

    async with asyncio.TaskGroup() as tasks:
        with SteppedLoop(clock) as stepped:
            tasks.create_task(call("first", second_has_ended))
            tasks.create_task(call("second", None))
            await stepped.settle()

    assert seen == ["first", "second"]


async def test_an_error_in_a_thread_reaches_the_task_that_awaits_it(clock: ManualClock) -> None:
    """Holding a result back changes nothing else."""

    async def call() -> None:
        with pytest.raises(ZeroDivisionError):
            await asyncio.to_thread(lambda: 1 / 0)

    async with asyncio.TaskGroup() as tasks:
        with SteppedLoop(clock) as stepped:
            task = tasks.create_task(call())
            await stepped.settle()
            assert task.done()


async def test_a_limit_of_the_test_itself_is_in_real_time(clock: ManualClock) -> None:
    """A test that hangs must end, however little time passes for the nodes."""
    with SteppedLoop(clock), pytest.raises(TimeoutError):
        async with asyncio.timeout(0.01):
            await asyncio.Event().wait()


async def test_what_still_sleeps_at_the_end_goes_on_in_real_time(clock: ManualClock) -> None:
    """The ends of nodes wait with limits, and nobody moves the clock then."""
    async with asyncio.TaskGroup() as tasks:
        with SteppedLoop(clock) as stepped:
            task = tasks.create_task(asyncio.sleep(0.01))  # noqa: TID251  # as above
            await stepped.settle()
        await task


async def test_a_cancelled_sleep_leaves_nothing_behind(clock: ManualClock) -> None:
    """A timer that is cancelled is forgotten by the clock."""
    async with asyncio.TaskGroup() as tasks:
        with SteppedLoop(clock) as stepped:
            task = tasks.create_task(asyncio.sleep(1))  # noqa: TID251  # as above
            await stepped.settle()
            task.cancel()
            await asyncio.wait([task])
            assert "waiting=0" in repr(clock)
