"""Small tools for asyncio, and `wait_all_tasks_blocked`, which lets tests wait without sleeping.

That reads the event loop's queue of ready callbacks; work in threads is counted, because all of it
goes through `run_in_thread`.
"""

from __future__ import annotations

import asyncio
import gc
from collections import deque
from contextvars import copy_context
from functools import partial
from types import coroutine
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar
from weakref import WeakKeyDictionary

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator, Sized

__all__ = [
    "SLICE_NS",
    "Activity",
    "activity",
    "checkpoint",
    "run_in_thread",
    "to_the_end",
    "wait_all_tasks_blocked",
]

P = ParamSpec("P")
T = TypeVar("T")

BLIND_TURNS = 5
"""For how many iterations every task has to be blocked, on a loop whose queue cannot be read."""


async def wait_all_tasks_blocked() -> None:
    """Wait until no callback can run: all wait for time, for input, or for each other.

    This includes callbacks that aionode runs in threads, but not input from outside, such as a
    socket's. It never returns while something is always ready, such as a task that awaits nothing
    but ``asyncio.sleep(0)``.
    """
    await activity().wait_all_tasks_blocked()


@coroutine
def checkpoint() -> Generator[None, None, None]:
    """Let everything else that is ready run once."""
    yield


async def run_in_thread(callback: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run `callback` in a thread and return its result; `wait_all_tasks_blocked` waits for it.

    A thread cannot be stopped, so cancelling waits until `callback` has returned before it raises
    CancelledError. Cancelling once more abandons the thread.
    """
    with activity():
        loop = asyncio.get_running_loop()
        work = partial(copy_context().run, callback, *args, **kwargs)
        running = loop.run_in_executor(None, work)
        try:
            return await asyncio.shield(running)
        except asyncio.CancelledError:
            # Retrieves the exception, so that asyncio does not report it.
            running.add_done_callback(lambda done: done.cancelled() or done.exception())
            await asyncio.wait([running])
            raise


async def to_the_end(work: Coroutine[Any, Any, T]) -> T:
    """Return the result of `work`, which goes on even if the caller is cancelled.

    For what has to finish however a task ends, such as closing connections.

    Raises:
        CancelledError: the caller was cancelled; raised after `work` has finished.
        Exception: what `work` raised.
    """
    cancelled: asyncio.CancelledError | None = None
    outcome: asyncio.Future[T] = asyncio.get_running_loop().create_future()

    async def run() -> None:
        try:
            outcome.set_result(await work)
        except BaseException as error:  # noqa: BLE001  # raised below
            outcome.set_exception(error)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(run())
        while not outcome.done():
            try:
                await asyncio.wait([outcome])
            except asyncio.CancelledError as error:
                cancelled = error
    result = outcome.result()
    if cancelled is not None:
        raise cancelled
    return result


class Activity:
    """Tracks what is running in one event loop. As a context manager: work in a thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._ready = ready_queue(loop)
        self._in_threads = 0
        self._thread_waits: list[asyncio.Future[None]] = []  # done when no thread is at work
        self._waiters = 0  # how many `_until_only_waiters` are running

    def __enter__(self) -> None:
        self._in_threads += 1

    def __exit__(self, *_: object) -> None:
        self._in_threads -= 1
        if self._in_threads == 0:
            waits, self._thread_waits = self._thread_waits, []
            for future in waits:
                if not future.done():
                    future.set_result(None)

    async def wait_all_tasks_blocked(self) -> None:
        """Wait until no callback of this loop can run; see the function."""
        while True:
            if self._ready is None:
                await blind_turns()
            else:
                await self._until_only_waiters(self._ready)
            if not self._in_threads:
                return
            future = asyncio.get_running_loop().create_future()
            self._thread_waits.append(future)
            await future

    async def _until_only_waiters(self, ready: Sized) -> None:
        """Let the loop run until its queue holds only other calls of this method."""
        self._waiters += 1
        try:
            await checkpoint()
            while len(ready) >= self._waiters:
                await checkpoint()
        finally:
            self._waiters -= 1


ACTIVITIES: WeakKeyDictionary[asyncio.AbstractEventLoop, Activity] = WeakKeyDictionary()


def activity() -> Activity:
    """Return the activity of the running loop."""
    loop = asyncio.get_running_loop()
    known = ACTIVITIES.get(loop)
    if known is None:
        known = ACTIVITIES[loop] = Activity(loop)
    return known


def ready_queue(loop: asyncio.AbstractEventLoop) -> Sized | None:
    """Return the queue of callbacks that `loop` is about to run, or None if it cannot be found.

    asyncio's own loops keep it in `_ready`. In uvloop it is not an attribute that Python code can
    read, but it is the only deque that the loop object refers to.
    """
    queue = getattr(loop, "_ready", None)
    if isinstance(queue, deque):
        return queue
    deques = [held for held in gc.get_referents(loop) if isinstance(held, deque)]
    return deques[0] if len(deques) == 1 else None


async def blind_turns() -> None:
    """Let the loop run until every other task was blocked for `BLIND_TURNS` iterations in a row."""
    quiet_turns = 0
    while quiet_turns < BLIND_TURNS:
        await checkpoint()
        this = asyncio.current_task()
        blocked = all(task is this or is_blocked(task) for task in asyncio.all_tasks())
        quiet_turns = quiet_turns + 1 if blocked else 0


def is_blocked(task: asyncio.Task[Any]) -> bool:
    """Return whether `task` waits for a future that is not done."""
    waits_for = getattr(task, "_fut_waiter", None)
    return waits_for is not None and not waits_for.done()


SLICE_NS = 1_000_000
"""How long a queue is emptied before timers, I/O and other callbacks get to run."""
