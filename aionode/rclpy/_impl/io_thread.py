"""The thread in which a context talks to others: one event loop, and no code of the user's."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from threading import Event, Lock, Thread, current_thread, get_ident, local, main_thread
from typing import TYPE_CHECKING, Any, TypeVar

from aionode import Context
from aionode.clock import MachineTime
from aionode.lendable_loop import LendableLoop
from aionode.rclpy._impl.errors import InvalidHandle

if TYPE_CHECKING:
    from aionode.rclpy._impl.destroyable import Wakeup

__all__ = ["IoThread", "postpone"]

T = TypeVar("T")

MOST_WAITING = 1000
"""How many messages may wait for the thread before `publish` waits for it."""

SLICE = 100
"""How many of them it takes in one turn of its loop."""

PRECISE_S = 0.002
"""The end of a wait, in seconds, for which no descriptors are watched: that has whole
milliseconds only.
"""

STOP_S = 5.0
"""How long the end of the process waits for the thread: longer than its steps may take together.

Inside Zenoh at the very end, it would abort the process.
"""

logger = logging.getLogger("aionode.rclpy")

steady_ns = MachineTime().steady_ns


class Borrowing(local):
    """Whether this thread does the work of a context's thread."""

    active = False


borrowing = Borrowing()

postponed: list[Callable[[], object]] = []
"""What handlers of signals have to do once this thread does no more such work."""


def postpone(action: Callable[[], object]) -> bool:
    """Have `action` called soon if this thread does the work of a context's thread.

    A handler of a signal may raise KeyboardInterrupt, which would leave such work half done.

    Returns:
        Whether it will be called.
    """
    if borrowing.active:
        postponed.append(action)
    return borrowing.active


def call_postponed() -> None:
    """Call what `postpone` has kept, in the thread that handles signals."""
    while postponed and current_thread() is main_thread():
        postponed.pop(0)()


class IoThread:
    """Runs a context in an event loop of its own thread, from `start` to `stop`.

    Attributes:
        context: The context; it and all that belongs to it are used in this thread only.
        delivery_lock: Held while a message is delivered inside this context, in the thread that
            publishes it, and while a subscription is made. Nothing waits while it is held.
    """

    def __init__(self, context: Context) -> None:
        self.context = context
        self._work: deque[Callable[[], object]] = deque()
        self._scheduled = True  # the loop looks once it runs
        self._ended = False
        self._loop: LendableLoop | None = None
        self._stopping: asyncio.Event | None = None
        self._opened: Future[None] = Future()
        self.delivery_lock = Lock()
        self._graph_watchers: list[Callable[[], None]] = []
        # A daemon, as the interpreter waits for others before it calls what `atexit` has.
        self._thread = Thread(target=self._main, name="rclpy-io", daemon=True)

    def start(self) -> None:
        """Start the thread, and open the context.

        Raises:
            TransportError: a transport cannot connect.
        """
        self._thread.start()
        self._opened.result()

    def stop(self) -> None:
        """Close the context, once what was published is sent, and end the thread."""
        if self._thread.is_alive() and not self.is_current:
            self.post(self._stop)
            self._thread.join(STOP_S)

    @property
    def is_current(self) -> bool:
        """Whether the caller runs in this thread."""
        return self._thread.ident == get_ident()

    def call(self, function: Callable[..., T], *args: Any) -> T:
        """Call `function` in the thread and return its result.

        Raises:
            InvalidHandle: the context is shut down.
            Exception: what the function raises.
        """
        if self.is_current:
            return function(*args)
        result: Future[T] = Future()

        def work() -> None:
            if self._ended:
                result.set_exception(InvalidHandle("the context is shut down"))
                return
            try:
                result.set_result(function(*args))
            except BaseException as error:  # noqa: BLE001  # raised in the calling thread
                result.set_exception(error)

        self.post(work)
        return result.result()

    def post(self, action: Callable[[], object]) -> None:
        """Call `action` in the thread soon, after everything that was posted before."""
        self._work.append(action)
        self._schedule()

    def send(self, action: Callable[[], object]) -> None:
        """Call `action`, which sends something, after everything that was posted before.

        In this thread and at once if the context's thread sleeps, and in the latter soon if not.
        """
        loop = self._loop
        borrowing.active = True
        try:
            if self._work or loop is None or not loop.borrow():
                self.post(action)
                return
            try:
                action()
            except Exception:
                logger.exception("in the input and output of a context")
            finally:
                loop.give_back()
        finally:
            borrowing.active = False
            if postponed:
                call_postponed()

    def wait(self, wakeup: Wakeup, timeout_sec: float | None) -> bool:
        """Wait for a wake-up, and meanwhile read what comes in, so that no other thread has to.

        Args:
            wakeup: What is waited for.
            timeout_sec: The longest time in seconds; None for ever.

        Returns:
            Whether a wake-up has come.
        """
        readers = None if self._loop is None else self._loop.readers
        ends_ns = None if timeout_sec is None else steady_ns() + timeout_sec * 1e9
        left_s = timeout_sec
        if readers is not None and (left_s is None or left_s > PRECISE_S) and readers.begin():
            try:
                while left_s is None or left_s > PRECISE_S:
                    wakeup.rouse = readers.rouse
                    if wakeup.take(False):
                        return True
                    readable = readers.wait(None if left_s is None else left_s - PRECISE_S)
                    wakeup.rouse = None
                    borrowing.active = True
                    try:
                        may_go_on = readers.call(readable)
                    finally:
                        borrowing.active = False
                        if postponed:
                            call_postponed()
                    if wakeup.take(False):
                        return True
                    if not may_go_on:
                        break
                    left_s = None if ends_ns is None else (ends_ns - steady_ns()) / 1e9
            finally:
                wakeup.rouse = None
                readers.end()
        return wakeup.wait(None if ends_ns is None else (ends_ns - steady_ns()) / 1e9)

    def pace(self) -> None:
        """Wait while more is posted than the thread has done; for those who post much."""
        if len(self._work) >= MOST_WAITING and not self.is_current:
            turn = Event()
            self.post(turn.set)
            turn.wait()

    def _schedule(self) -> None:
        if self._ended:
            self._drain()
        elif not self._scheduled:
            self._scheduled = True
            try:
                self.loop.call_soon_threadsafe(self._drain)
            except RuntimeError:  # the loop has just been closed
                self._drain()

    def _drain(self) -> None:
        self._scheduled = False
        work = self._work
        left = SLICE
        while work and left:
            left -= 1
            try:
                action = work.popleft()
            except IndexError:  # at the end, several threads may be here
                return
            try:
                action()
            except Exception:
                if not self._ended:
                    logger.exception("in the input and output of a context")
        if work:
            self._schedule()

    def _stop(self) -> None:
        if self._stopping is not None:
            self._stopping.set()

    def _main(self) -> None:
        try:
            with asyncio.Runner(loop_factory=LendableLoop) as runner:
                runner.run(self._run())
        except BaseException as error:
            if self._opened.done():
                logger.exception("a context ended")
            else:
                self._opened.set_exception(error)
        finally:
            self._ended = True
            while self._work:
                self._drain()

    async def _run(self) -> None:
        async with self.context, asyncio.TaskGroup() as tasks:
            loop = asyncio.get_running_loop()
            assert isinstance(loop, LendableLoop)  # noqa: S101  # `_main` has made it
            self._loop = loop
            self._stopping = asyncio.Event()
            watching = tasks.create_task(self._watch_graph())
            self._opened.set_result(None)
            self._drain()  # a signal may have ended `start`, so that `stop` is here already
            await self._stopping.wait()
            watching.cancel()

    # In the thread

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """Its event loop."""
        assert self._loop is not None  # noqa: S101  # `start` has returned
        return self._loop

    def watch_graph(self, watcher: Callable[[], None]) -> None:
        """Call `watcher` after each change of the graph; in the thread only, as `unwatch_graph`."""
        self._graph_watchers.append(watcher)

    def unwatch_graph(self, watcher: Callable[[], None]) -> None:
        """Undo `watch_graph`."""
        self._graph_watchers.remove(watcher)

    async def _watch_graph(self) -> None:
        while True:
            await self.context.graph.changed()
            for watcher in list(self._graph_watchers):
                watcher()
