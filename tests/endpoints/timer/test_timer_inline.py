"""Timers on the machine's clocks: calls within the alarm, and what stays the same."""

from __future__ import annotations

import asyncio
import errno
import os
import sys
from contextvars import ContextVar
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from aionode.clock import S_TO_NS
from aionode.clock import _timerfd as timerfd
from aionode.endpoints.timer import Timer
from aionode.node import Node
from aionode.testing import local_context, settle

if TYPE_CHECKING:
    from collections.abc import Awaitable

PERIOD_S = 0.002

place: ContextVar[str] = ContextVar("place", default="nowhere")


class Calls:
    """A callback that records the tasks that it runs in, and can be awaited."""

    def __init__(self) -> None:
        self.tasks: list[asyncio.Task[Any] | None] = []
        self._called = asyncio.Event()

    def __call__(self) -> None:
        """Record a call."""
        self.tasks.append(asyncio.current_task())
        self._called.set()

    async def have(self, count: int) -> None:
        """Wait until there were `count` calls."""
        async with asyncio.timeout(20):
            while len(self.tasks) < count:
                self._called.clear()
                await self._called.wait()


async def test_a_sync_callback_is_called_without_waking_a_task(node: Node) -> None:
    """The alarm itself makes the call, again and again, on the grid of the timer."""
    calls = Calls()
    timer = node.create_timer(PERIOD_S, calls)
    await calls.have(5)
    assert None in calls.tasks
    assert timer.stats.received == timer.stats.queue_wait.count == len(calls.tasks)


async def test_a_call_has_the_context_of_its_timer_not_of_the_alarm(node: Node) -> None:
    """All timers share one alarm, which the first has set up."""
    first = Calls()
    node.create_timer(PERIOD_S, first)
    await first.have(2)
    found: list[str] = []
    second = Calls()

    def call() -> None:
        found.append(place.get())
        second()

    token = place.set("here")
    node.create_timer(PERIOD_S, call)
    place.reset(token)
    await second.have(4)
    assert set(found) == {"here"}


async def test_what_a_sync_callback_returns_is_awaited_before_the_next_call(node: Node) -> None:
    """A callback that only turns out to wait does not overlap itself."""
    begun = 0
    ended = Calls()
    go_on = asyncio.Event()

    async def wait() -> None:
        await go_on.wait()
        ended()

    def call() -> Awaitable[None]:
        nonlocal begun
        begun += 1
        return wait()

    node.create_timer(PERIOD_S, call)
    others = Calls()
    node.create_timer(PERIOD_S, others)
    await others.have(5)
    assert (begun, len(ended.tasks)) == (1, 0)
    go_on.set()
    await ended.have(3)


@pytest.mark.parametrize("end", [Timer.cancel, Timer.destroy])
async def test_a_callback_may_end_its_own_timer(node: Node, end: Any) -> None:
    """The call that does it is the last."""
    calls = Calls()

    def call() -> None:
        calls()
        if len(calls.tasks) == 3:
            end(timer)

    timer = node.create_timer(PERIOD_S, call)
    await calls.have(3)
    others = Calls()
    node.create_timer(PERIOD_S, others)
    await others.have(5)
    assert len(calls.tasks) == 3


async def test_a_callback_may_reset_its_own_timer(node: Node) -> None:
    """Calls go on, a period after each reset."""
    calls = Calls()

    def call() -> None:
        calls()
        timer.reset()

    timer = node.create_timer(PERIOD_S, call)
    await calls.have(4)
    assert not timer.is_canceled()


async def test_an_error_that_is_logged_leaves_the_timer_running(node: Node) -> None:
    """As when the task makes the call."""
    calls = Calls()

    def call() -> None:
        calls()
        raise ValueError("no")

    timer = node.create_timer(PERIOD_S, call, on_error="log")
    await calls.have(4)
    assert timer.stats.errors == len(calls.tasks)


async def test_an_error_ends_the_node_of_the_timer() -> None:
    """It comes out where the node is awaited."""

    def call() -> None:
        raise ValueError("broken")

    async def run() -> None:
        async with local_context() as context, Node("node", context=context) as node:
            node.create_timer(PERIOD_S, call)
            await asyncio.Event().wait()

    with pytest.raises(ExceptionGroup) as caught:
        await run()
    assert caught.group_contains(ValueError, match="broken")


@pytest.mark.parametrize("action", ["cancel", "destroy", "reset", "cancel and fail"])
async def test_a_sync_callback_may_end_its_own_timer(node: Node, action: str) -> None:
    """Every one-shot timer does; the alarm must not set a future that is done."""
    problems: list[dict[str, Any]] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, about: problems.append(about))
    calls: list[int] = []
    may_end = asyncio.Event()

    def once() -> None:
        calls.append(1)
        if action == "destroy":
            timer.destroy()
        elif action == "reset":
            timer.reset()
        else:
            timer.cancel()
        if len(calls) == 2 or action != "reset":
            may_end.set()
        if action == "cancel and fail":
            raise ValueError("broken")

    timer = node.create_timer(PERIOD_S, once, on_error="log")
    async with asyncio.timeout(20):
        await may_end.wait()
    await settle()

    assert not problems
    if action.startswith("cancel"):
        may_end.clear()
        timer.reset()
        async with asyncio.timeout(20):
            await may_end.wait()
        assert len(calls) == 2
    node.destroy_node()


async def test_a_new_period_is_kept_by_an_alarm_that_goes_on_by_itself(node: Node) -> None:
    """The kernel knows the period as well, and has to learn of the new one."""
    calls = Calls()
    timer = node.create_timer(PERIOD_S, calls)
    await calls.have(3)
    timer.timer_period_ns = 3_600 * S_TO_NS
    count = len(calls.tasks)
    others = Calls()
    node.create_timer(PERIOD_S, others)
    await others.have(5)
    assert len(calls.tasks) <= count + 1  # the one that was planned
    left_ns = timer.time_until_next_call()
    assert left_ns is not None
    assert left_ns > 3_000 * S_TO_NS


@pytest.mark.skipif(sys.platform != "linux", reason="timerfd is Linux's")
async def test_setting_the_system_clock_leaves_a_timer_running(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The kernel says so with an error, whatever it is set to; the timer looks and goes on."""
    calls = Calls()
    timer = node.create_timer(PERIOD_S, calls)
    await calls.have(2)
    left = 3

    def read(fd: int, size: int) -> bytes:
        nonlocal left
        data = os.read(fd, size)
        left -= 1
        if left >= 0:
            raise OSError(errno.ECANCELED, "set")
        return data

    with monkeypatch.context() as patch:
        flags = {"O_NONBLOCK": os.O_NONBLOCK, "O_CLOEXEC": os.O_CLOEXEC}
        patch.setattr(
            timerfd, "os", SimpleNamespace(read=read, close=os.close, getpid=os.getpid, **flags)
        )
        await calls.have(len(calls.tasks) + 5)
    assert left < 0
    assert not timer.is_canceled()


async def test_more_timers_than_there_are_files_for_share_one(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program with a thousand timers has to keep files for its sockets."""
    monkeypatch.setattr(timerfd, "MAX_PERIODIC", timerfd.PeriodicAlarm.count)
    calls = Calls()
    node.create_timer(PERIOD_S, calls)
    await calls.have(5)
    assert None in calls.tasks


@pytest.mark.parametrize("end", [Timer.cancel, Timer.destroy])
async def test_a_timer_gives_its_file_back(node: Node, end: Any) -> None:
    """It does so even when no timer will ring again."""
    before = timerfd.PeriodicAlarm.count
    calls = Calls()
    timer = node.create_timer(PERIOD_S, calls)
    await calls.have(2)
    end(timer)
    await settle()
    assert timerfd.PeriodicAlarm.count == before


@pytest.mark.skipif(sys.platform != "linux", reason="timerfd is Linux's")
async def test_a_forked_child_leaves_the_timers_of_its_parent_running() -> None:
    """The two share what the loop waits with, and the child's end cancels what it has inherited."""
    rung = asyncio.Event()
    alarm = timerfd.PeriodicAlarm(1, 1_000_000, rung.set, system=False)
    child = os.fork()
    if not child:
        alarm.cancel()
        os._exit(0)
    os.waitpid(child, 0)  # noqa: ASYNC222  # it ends at once
    for _ in range(3):
        rung.clear()
        async with asyncio.timeout(20):
            await rung.wait()
    alarm.cancel()
