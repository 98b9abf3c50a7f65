"""Helpers for asyncio: the loop, yielding to it, calls in threads, and uninterruptible work."""

from __future__ import annotations

import asyncio
import os
import selectors
import threading
from concurrent.futures import Executor, Future
from contextvars import copy_context
from functools import partial
from queue import SimpleQueue
from types import coroutine
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar
from weakref import WeakKeyDictionary

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator

__all__ = [
    "SLICE_NS",
    "DaemonThread",
    "borrowed_loops",
    "checkpoint",
    "is_cancelled_task",
    "run_in_thread",
    "running_loop",
    "spin_before_blocking",
    "thread_calls",
    "to_the_end",
]

P = ParamSpec("P")
T = TypeVar("T")
Call = tuple[Future[Any], "Callable[[], Any]"]

SLICE_NS = 1_000_000
"""How long a queue is drained before timers, I/O and other callbacks get a turn."""

THREAD_CALLS: WeakKeyDictionary[asyncio.AbstractEventLoop, set[asyncio.Future[None]]] = (
    WeakKeyDictionary()
)


borrowed_loops: dict[int, asyncio.AbstractEventLoop] = {}
"""The `LendableLoop` that each thread has borrowed, by the thread's number."""

if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=borrowed_loops.clear)


def running_loop() -> asyncio.AbstractEventLoop:
    """Return the loop that this thread has borrowed, or else the one that it runs.

    For code that a borrower of a `LendableLoop` may reach: telling asyncio about each loan would
    take a twentieth of the time of a message.

    Raises:
        RuntimeError: there is none.
    """
    return borrowed_loops.get(threading.get_ident()) or asyncio.get_running_loop()


@coroutine
def checkpoint() -> Generator[None, None, None]:
    """Wait for one iteration of the event loop, in which everything else that is ready runs."""
    yield


def thread_calls(loop: asyncio.AbstractEventLoop) -> set[asyncio.Future[None]]:
    """Return the futures of the pending calls of `run_in_thread` in `loop`.

    They are done when the calls end. Tests wait for them, as the loop does not expose them.
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


class DaemonThread(Executor):
    """One daemon thread, so that a call that hangs keeps neither block nor program from ending.

    It is always the same thread, as some libraries with a device require.

    Args:
        name: What debuggers show.
    """

    def __init__(self, name: str) -> None:
        self._calls: SimpleQueue[Call | None] = SimpleQueue()
        threading.Thread(target=self._run, name=name, daemon=True).start()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call a function in the thread."""
        future: Future[Any] = Future()
        self._calls.put((future, lambda: fn(*args, **kwargs)))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: ARG002
        """End the thread after the calls already submitted; never wait for it."""
        self._calls.put(None)

    def _run(self) -> None:
        while (call := self._calls.get()) is not None:
            future, work = call
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(work())
            except BaseException as error:  # noqa: BLE001  # the caller raises it
                future.set_exception(error)


def is_cancelled_task() -> bool:
    """Return whether the running task is being cancelled.

    If not, a CancelledError that reaches it comes from something it awaited, or is a mistake.
    """
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


async def to_the_end(work: Coroutine[Any, Any, T], raising: BaseException | None = None) -> T:
    """Return the result of `work`, which continues even if the caller is cancelled.

    For work that has to finish however a task ends, such as closing connections.

    Args:
        work: The work.
        raising: The exception that the caller raises afterwards. A cancellation does not replace
            it: a TaskGroup of Python 3.13 that raises its tasks' errors in a cancelled task cancels
            that task once more, so the next ``await`` would lose these errors.

    Raises:
        CancelledError: the caller was cancelled, and `raising` is None or a CancelledError; raised
            after `work` has finished.
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
    if cancelled is not None and (raising is None or isinstance(raising, asyncio.CancelledError)):
        raise cancelled
    return result


def spin_before_blocking(
    loop: asyncio.AbstractEventLoop, spin_ns: int, now_ns: Callable[[], int], subject: str
) -> Callable[[], None]:
    """Make `loop` poll for events for a while before its thread blocks.

    Args:
        loop: An event loop of asyncio's own.
        spin_ns: How long, in nanoseconds.
        now_ns: A monotonic clock, in nanoseconds.
        subject: What errors name.

    Returns:
        A function that undoes it.

    Raises:
        RuntimeError: the loop is of another kind, or already spins.
    """
    selector = getattr(loop, "_selector", None)
    if not isinstance(selector, selectors.BaseSelector):
        raise RuntimeError(  # noqa: TRY004  # no argument has a wrong type
            f"{subject}: the event loop {type(loop).__module__}.{type(loop).__name__} cannot spin; "
            "use asyncio's own, as in aionode.run(..., loop_factory=asyncio.SelectorEventLoop), or "
            "leave out spin_us"
        )
    if "select" in vars(selector):
        raise RuntimeError(f"{subject}: another context of this event loop spins already")
    block = selector.select

    def select(timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        ready = block(0)
        if ready or (timeout is not None and timeout <= 0):
            return ready
        began_ns = now_ns()
        ends_ns = began_ns + (spin_ns if timeout is None else min(spin_ns, int(timeout * 1e9)))
        while now_ns() < ends_ns:
            ready = block(0)
            if ready:
                return ready
        return block(None if timeout is None else max(timeout - (now_ns() - began_ns) / 1e9, 0))

    vars(selector)["select"] = select
    return lambda: vars(selector).pop("select", None)
