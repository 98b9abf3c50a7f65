"""Wait until nothing is left to run, so that a test can check results without sleeping.

The event loop knows which callbacks are ready; calls in threads are known because they all go
through `run_in_thread`.
"""

from __future__ import annotations

import asyncio
import gc
from collections import deque
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from aionode._process.concurrency import checkpoint, thread_calls

if TYPE_CHECKING:
    from collections.abc import Sized

__all__ = ["settle"]

IDLE_TURNS = 5
"""Consecutive iterations in which every task must be blocked, if the queue is inaccessible."""

SETTLING: WeakKeyDictionary[asyncio.AbstractEventLoop, int] = WeakKeyDictionary()
"""The number of `settle` calls running in each loop; each is ready in every iteration."""


async def settle() -> None:
    """Wait until no callback can run: all wait for time, for input, or for each other.

    It waits for ready callbacks, for those that they make ready, and for callbacks that aionode
    runs in threads. It does not wait for outside input, such as a socket's. A task that is always
    ready, because it only awaits ``asyncio.sleep(0)``, keeps it from ever returning.
    """
    loop = asyncio.get_running_loop()
    ready = ready_queue(loop)
    while True:
        if ready is None:
            await turn_until_tasks_block()
        else:
            await turn_until_empty(loop, ready)
        calls = list(thread_calls(loop))
        if not calls:
            return
        await asyncio.wait(calls)


def ready_queue(loop: asyncio.AbstractEventLoop) -> Sized | None:
    """Return the queue of callbacks that `loop` is about to run, or None if it is inaccessible.

    asyncio's own loops keep it in `_ready`. uvloop has no attribute for it, but it is the only
    deque that the loop object refers to.
    """
    queue = getattr(loop, "_ready", None)
    if isinstance(queue, deque):
        return queue
    deques = [held for held in gc.get_referents(loop) if isinstance(held, deque)]
    return deques[0] if len(deques) == 1 else None


async def turn_until_empty(loop: asyncio.AbstractEventLoop, ready: Sized) -> None:
    """Run `loop` until its queue contains only other calls of this function."""
    SETTLING[loop] = SETTLING.get(loop, 0) + 1
    try:
        await checkpoint()
        while len(ready) >= SETTLING[loop]:
            await checkpoint()
    finally:
        SETTLING[loop] -= 1


async def turn_until_tasks_block() -> None:
    """Run the loop until every other task has been blocked for some consecutive iterations."""
    idle_turns = 0
    while idle_turns < IDLE_TURNS:
        await checkpoint()
        this = asyncio.current_task()
        blocked = all(task is this or is_blocked(task) for task in asyncio.all_tasks())
        idle_turns = idle_turns + 1 if blocked else 0


def is_blocked(task: asyncio.Task[Any]) -> bool:
    """Return whether `task` waits for a future that is not done."""
    waits_for = getattr(task, "_fut_waiter", None)
    return waits_for is not None and not waits_for.done()
