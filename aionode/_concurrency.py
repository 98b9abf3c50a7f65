"""Helpers for asyncio: a turn of the loop, calls in threads, and uninterruptible work."""

from __future__ import annotations

import asyncio
from contextvars import copy_context
from functools import partial
from types import coroutine
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar
from weakref import WeakKeyDictionary

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator

__all__ = [
    "SLICE_NS",
    "checkpoint",
    "run_in_thread",
    "thread_calls",
    "to_the_end",
]

P = ParamSpec("P")
T = TypeVar("T")

SLICE_NS = 1_000_000
"""How long a queue is drained before timers, I/O and other callbacks get their turn."""

THREAD_CALLS: WeakKeyDictionary[asyncio.AbstractEventLoop, set[asyncio.Future[None]]] = (
    WeakKeyDictionary()
)


@coroutine
def checkpoint() -> Generator[None, None, None]:
    """Wait for one turn of the event loop, in which everything else that is ready runs."""
    yield


def thread_calls(loop: asyncio.AbstractEventLoop) -> set[asyncio.Future[None]]:
    """Return a future for each call of `run_in_thread` in `loop` that has not ended.

    The futures are done when the calls end. Tests wait for them, as the loop does not show them.
    """
    return THREAD_CALLS.setdefault(loop, set())


async def run_in_thread(callback: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run `callback` in a thread and return its result.

    A thread cannot be stopped, so cancelling waits until `callback` has returned and then raises
    CancelledError; cancelling once more abandons the thread.
    """
    loop = asyncio.get_running_loop()
    calls = thread_calls(loop)
    ended: asyncio.Future[None] = loop.create_future()
    calls.add(ended)
    try:
        work = partial(copy_context().run, callback, *args, **kwargs)
        running = loop.run_in_executor(None, work)
        try:
            return await asyncio.shield(running)
        except asyncio.CancelledError:
            # Retrieve its exception, or asyncio would report it as never retrieved.
            running.add_done_callback(lambda done: done.cancelled() or done.exception())
            await asyncio.wait([running])
            raise
    finally:
        calls.discard(ended)
        if not ended.done():
            ended.set_result(None)


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
