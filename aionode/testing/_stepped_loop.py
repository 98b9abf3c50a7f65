"""An event loop that follows a manual clock, and whose thread calls end in order.

Code in nodes may use ``asyncio.sleep``, ``asyncio.timeout`` and ``asyncio.to_thread``, and so does
aionode itself. All of these go through four methods of the loop. `SteppedLoop` overrides them in
the loop object's dictionary, and restores them at the end.

The task that starts it is not affected: its timeouts limit the test, in real time. Nor is code
outside tasks, where the loop itself reads its time.
"""

from __future__ import annotations

import asyncio
from collections import deque
from functools import partial
from typing import TYPE_CHECKING, Any, Self

from aionode.clock import S_TO_NS
from aionode.logging import get_logger
from aionode.testing._quiescence import ready_queue, turn_until_empty, turn_until_tasks_block

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextvars import Context

    from aionode.clock import Alarm
    from aionode.testing._manual_clock import ManualClock

__all__ = ["SteppedLoop"]

METHODS = ("time", "call_later", "call_at", "run_in_executor")
SLOW_THREAD_S = 5.0
"""After this many seconds a warning names the thread call that is awaited."""


class SteppedLoop:
    """Makes the running loop follow a clock, within a ``with`` block.

    Args:
        clock: The clock.
    """

    def __init__(self, clock: ManualClock) -> None:
        self._clock = clock
        self._loop = asyncio.get_running_loop()
        self._owner = asyncio.current_task()
        self._ready = ready_queue(self._loop)
        self._began_ns = clock.steady_ns()
        self._timers: dict[SteppedTimer, None] = {}
        # Calls in threads: the running future, the one its caller awaits, and the function's name.
        self._calls: deque[tuple[asyncio.Future[Any], asyncio.Future[Any], str]] = deque()
        self._real = {name: getattr(self._loop, name) for name in METHODS}

    def __enter__(self) -> Self:
        """Override the loop's methods."""
        vars(self._loop).update({name: getattr(self, f"_{name}") for name in METHODS})
        return self

    def __exit__(self, *_: object) -> None:
        """Restore the loop's own time; pending calls continue in real time."""
        for name in METHODS:
            vars(self._loop).pop(name, None)
        for timer in list(self._timers):
            timer.leave_clock()
            left_s = max(0.0, timer.when() - self._now_s())
            self._loop.call_later(left_s, timer.run)
        for running, outcome, _name in self._calls:
            running.add_done_callback(partial(pass_on, outcome=outcome))

    async def walk_to(self, end_ns: int) -> None:
        """Advance time to `end_ns`: everything due fires at its own time, in order."""
        await self._clock._walk_to(end_ns, self.settle)

    async def settle(self) -> None:
        """Wait until no callback can run and every call in a thread has ended.

        Calls in threads end in the order in which they started, each when nothing else can run, so
        that the order of callbacks does not depend on the speed of threads.
        """
        while True:
            if self._ready is None:
                await turn_until_tasks_block()
            else:
                await turn_until_empty(self._loop, self._ready)
            if not self._calls:
                return
            running, outcome, name = self._calls.popleft()
            await self._until_ended(running, name)
            pass_on(running, outcome)

    async def _until_ended(self, running: asyncio.Future[Any], name: str) -> None:
        if not running.done():
            await asyncio.wait([running], timeout=SLOW_THREAD_S)
        if not running.done():
            get_logger("aionode.testing").warning(
                f"{name} has been running in a thread for {SLOW_THREAD_S:g} s, and time stands "
                "still until it returns; if it waits for messages, wait for them in the event loop"
            )
            await asyncio.wait([running])

    # Methods of an event loop

    def _is_foreign(self) -> bool:
        """Return whether the caller does not follow the clock."""
        task = asyncio.current_task(self._loop)
        return task is None or task is self._owner

    def _now_s(self) -> float:
        return (self._clock.steady_ns() - self._began_ns) / S_TO_NS

    def _time(self) -> float:
        real: float = self._real["time"]() if self._is_foreign() else self._now_s()
        return real

    def _call_at(
        self, when: float, callback: Callable[..., Any], *args: Any, context: Context | None = None
    ) -> asyncio.TimerHandle:
        if self._is_foreign():
            handle: asyncio.TimerHandle = self._real["call_at"](
                when, callback, *args, context=context
            )
            return handle
        return self._timer(self._began_ns + round(when * S_TO_NS), callback, args, context)

    def _call_later(
        self, delay: float, callback: Callable[..., Any], *args: Any, context: Context | None = None
    ) -> asyncio.TimerHandle:
        if asyncio.current_task(self._loop) is self._owner:
            handle: asyncio.TimerHandle = self._real["call_later"](
                delay, callback, *args, context=context
            )
            return handle
        due_ns = self._clock.steady_ns() + round(delay * S_TO_NS)
        return self._timer(due_ns, callback, args, context)

    def _timer(
        self,
        due_ns: int,
        callback: Callable[..., Any],
        args: tuple[Any, ...],
        context: Context | None,
    ) -> SteppedTimer:
        when = (due_ns - self._began_ns) / S_TO_NS
        timer = SteppedTimer(when, callback, args, self._loop, context)
        timer.enter(self._clock, due_ns, self._timers)
        return timer

    def _run_in_executor(
        self, executor: Any, func: Callable[..., Any], *args: Any
    ) -> asyncio.Future[Any]:
        running: asyncio.Future[Any] = self._real["run_in_executor"](executor, func, *args)
        if asyncio.current_task(self._loop) is self._owner:
            return running
        outcome: asyncio.Future[Any] = self._loop.create_future()
        self._calls.append((running, outcome, name_of(func)))
        return outcome


class SteppedTimer(asyncio.TimerHandle):
    """A callback scheduled on a loop, but called by a clock."""

    _alarm: Alarm | None = None
    _timers: dict[SteppedTimer, None]

    def enter(self, clock: ManualClock, due_ns: int, timers: dict[SteppedTimer, None]) -> None:
        """Schedule it with `clock` at `due_ns`; until then it is one of `timers`."""
        self._timers = timers
        self._timers[self] = None
        self._alarm = clock.call_at(due_ns, self.run)

    def leave_clock(self) -> None:
        """Remove it from the clock."""
        self._timers.pop(self, None)
        if self._alarm is not None:
            self._alarm.cancel()

    def run(self) -> None:
        """Call the callback, unless it was cancelled."""
        self._timers.pop(self, None)
        if not self.cancelled():
            self._run()

    def cancel(self) -> None:
        """Cancel the callback."""
        if not self.cancelled():
            self.leave_clock()
            asyncio.Handle.cancel(self)


def name_of(function: Any) -> str:
    """Return the name of the function called in a thread, which ``asyncio.to_thread`` wraps."""
    while isinstance(function, partial):
        function = function.args[0] if function.args else function.func
    return getattr(function, "__qualname__", repr(function))


def pass_on(ended: asyncio.Future[Any], outcome: asyncio.Future[Any]) -> None:
    """Copy the result of `ended` to `outcome`, unless it was cancelled meanwhile."""
    if ended.cancelled():
        outcome.cancel()
        return
    error = ended.exception()
    if outcome.done():
        return
    if error is None:
        outcome.set_result(ended.result())
    else:
        outcome.set_exception(error)
