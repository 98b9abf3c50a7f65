"""Tests of waiting until nothing is left to run: `settle`, and what it relies on."""

from __future__ import annotations

import asyncio
import threading

import pytest
import uvloop

from aionode._process.concurrency import checkpoint, run_in_thread
from aionode.clock import Clock, ClockType
from aionode.testing import ManualClock, settle
from aionode.testing import _quiescence as module

LOOPS = {"asyncio": asyncio.new_event_loop, "uvloop": uvloop.new_event_loop}


@pytest.fixture(params=LOOPS)
def runner(request: pytest.FixtureRequest) -> asyncio.Runner:
    """Return a runner for each kind of event loop, since each keeps its queue elsewhere."""
    return asyncio.Runner(loop_factory=LOOPS[request.param])


async def turns(count: int, done: list[int]) -> None:
    """Run some iterations of the loop."""
    for _ in range(count):
        await checkpoint()
    done.append(count)


def test_tasks_run_until_they_wait(runner: asyncio.Runner) -> None:
    """This includes a task that stays ready for many iterations."""

    async def main() -> None:
        done: list[int] = []
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(turns(50, done))
            blocked = tasks.create_task(asyncio.Event().wait())
            await settle()
            assert done == [50]
            blocked.cancel()

    with runner:
        runner.run(main())


def test_chains_of_plain_callbacks_run_to_their_end(runner: asyncio.Runner) -> None:
    """No task represents them; only the loop's queue shows them."""

    async def main() -> None:
        left = 30

        def again() -> None:
            nonlocal left
            left -= 1
            if left:
                asyncio.get_running_loop().call_soon(again)

        again()
        await settle()
        assert left == 0

    with runner:
        runner.run(main())


def test_several_may_settle_at_once(runner: asyncio.Runner) -> None:
    """They do not mistake each other for remaining work."""

    async def main() -> None:
        done: list[int] = []
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(turns(10, done))
            settled = [tasks.create_task(settle()) for _ in range(3)]
            await settle()
            assert done == [10]
        assert all(task.done() for task in settled)

    with runner:
        runner.run(main())


def test_work_in_threads_is_waited_for(runner: asyncio.Runner) -> None:
    """So are the tasks that its result makes ready."""

    async def main() -> None:
        done: list[int] = []
        release = threading.Event()

        async def offload() -> None:
            await run_in_thread(release.wait)
            await turns(10, done)

        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(offload())
            first = tasks.create_task(settle())
            second = tasks.create_task(settle())
            for _ in range(20):
                await checkpoint()
            assert not first.done()
            release.set()
            await settle()
            assert done == [10]
        assert second.done()

    with runner:
        runner.run(main())


def test_a_failing_thread_is_not_waited_for_any_longer(runner: asyncio.Runner) -> None:
    """Its exception propagates to the caller."""

    async def main() -> None:
        with pytest.raises(ZeroDivisionError):
            await run_in_thread(divmod, 1, 0)
        await settle()

    with runner:
        runner.run(main())


def test_time_can_be_stepped_on_every_loop(runner: asyncio.Runner) -> None:
    """The manual clock is built on `settle`."""

    async def main() -> None:
        manual = ManualClock()
        clock = Clock(ClockType.ROS_TIME, time_base=manual)
        seen: list[int] = []

        async def sleeper() -> None:
            while len(seen) < 5:
                await clock.sleep(0.1)
                seen.append(clock.now_ns())

        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(sleeper())
            await manual.advance(1)
        assert seen == [100_000_000 * n for n in range(1, 6)]

    with runner:
        runner.run(main())


async def test_a_loop_whose_queue_is_inaccessible_is_watched_through_its_tasks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Another library's event loop may hide its queue."""
    monkeypatch.setattr(module, "ready_queue", lambda _: None)
    done: list[int] = []
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(turns(50, done))
        blocked = tasks.create_task(asyncio.Event().wait())
        await settle()
        assert done == [50]
        blocked.cancel()
