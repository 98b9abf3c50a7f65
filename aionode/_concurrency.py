"""Knowing when nothing is left to run, so that a test can look at the result without sleeping.

The event loop knows what is ready; work in threads is known because all of it goes through
`run_in_thread`.
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

BLIND_TURNS = 5  # turns of a loop that hides its queue in which every task has to be blocked


async def wait_all_tasks_blocked() -> None:
    """Return when no callback can run: all wait for time, for input, or for each other.

    Waits for callbacks that are ready, for those that they make ready, and for callbacks that
    aionode runs in threads. Input from outside, such as a socket's, is not waited for.
    Something that is always ready, such as a task that never awaits anything but
    ``asyncio.sleep(0)``, keeps it from ever returning.
    """
    await activity().wait_all_tasks_blocked()


@coroutine
def checkpoint() -> Generator[None, None, None]:
    """Let everything else that is ready run once."""
    yield


async def run_in_thread(callback: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run `callback` in a thread and return its result; `wait_all_tasks_blocked` waits for it.

    A thread cannot be stopped. So cancelling waits until `callback` has returned, and raises
    CancelledError then; cancelling once more gives the thread up.
    """
    with activity():
        loop = asyncio.get_running_loop()
        work = partial(copy_context().run, callback, *args, **kwargs)
        running = loop.run_in_executor(None, work)
        try:
            return await asyncio.shield(running)
        except asyncio.CancelledError:
            # Its exception is looked at, so that asyncio does not report it.
            running.add_done_callback(lambda done: done.cancelled() or done.exception())
            await asyncio.wait([running])
            raise


async def to_the_end(work: Coroutine[Any, Any, T]) -> T:
    """Return the result of `work`, which cancelling the caller does not interrupt.

    For what has to be done however a task ends, such as closing connections.

    Raises:
        CancelledError: the caller was cancelled meanwhile; `work` is done all the same.
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
    """What goes on in one event loop. As a context manager: work that the loop cannot see."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._ready = ready_queue(loop)
        self._hidden = 0
        self._quiet: list[asyncio.Future[None]] = []
        self._turning = 0

    def __enter__(self) -> None:
        self._hidden += 1

    def __exit__(self, *_: object) -> None:
        self._hidden -= 1
        if self._hidden == 0:
            quiet, self._quiet = self._quiet, []
            for future in quiet:
                if not future.done():
                    future.set_result(None)

    async def wait_all_tasks_blocked(self) -> None:
        """Return when no callback of this loop can run; see the function."""
        while True:
            if self._ready is None:
                await blind_turns()
            else:
                await self._turns(self._ready)
            if not self._hidden:
                return
            future = asyncio.get_running_loop().create_future()
            self._quiet.append(future)
            await future

    async def _turns(self, ready: Sized) -> None:
        """Let the loop turn until its queue holds nothing but others that do just the same."""
        self._turning += 1
        try:
            await checkpoint()
            while len(ready) >= self._turning:
                await checkpoint()
        finally:
            self._turning -= 1


ACTIVITIES: WeakKeyDictionary[asyncio.AbstractEventLoop, Activity] = WeakKeyDictionary()


def activity() -> Activity:
    """Return the activity of the running loop."""
    loop = asyncio.get_running_loop()
    known = ACTIVITIES.get(loop)
    if known is None:
        known = ACTIVITIES[loop] = Activity(loop)
    return known


def ready_queue(loop: asyncio.AbstractEventLoop) -> Sized | None:
    """Return the queue of callbacks that `loop` is about to run, or None if it hides it.

    asyncio's own loops keep it in `_ready`. uvloop keeps it where Python code cannot name it, but
    it is the only deque that the loop object holds.
    """
    queue = getattr(loop, "_ready", None)
    if isinstance(queue, deque):
        return queue
    deques = [held for held in gc.get_referents(loop) if isinstance(held, deque)]
    return deques[0] if len(deques) == 1 else None


async def blind_turns() -> None:
    """Let the loop turn until every other task was blocked for some turns in a row."""
    quiet_turns = 0
    while quiet_turns < BLIND_TURNS:
        await checkpoint()
        this = asyncio.current_task()
        blocked = all(task is this or is_blocked(task) for task in asyncio.all_tasks())
        quiet_turns = quiet_turns + 1 if blocked else 0


def is_blocked(task: asyncio.Task[Any]) -> bool:
    """Whether `task` waits for a future that is not done."""
    waits_for = getattr(task, "_fut_waiter", None)
    return waits_for is not None and not waits_for.done()


SLICE_NS = 1_000_000
"""How long a queue is emptied before timers, I/O and other callbacks get their turn."""
