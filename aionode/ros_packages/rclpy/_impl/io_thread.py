"""The thread in which a context communicates: one event loop, and no user code."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import Callable
from functools import partial
from threading import Lock, Thread, get_ident
from typing import TYPE_CHECKING, Any, TypeVar

from aionode import Context
from aionode._process.lendable_loop import LendableLoop
from aionode.clock import MachineTime
from aionode.errors import ForkedProcessError
from rclpy._impl import uninterrupted
from rclpy._impl.destroyable import Wakeup
from rclpy._impl.errors import InvalidHandle

if TYPE_CHECKING:
    from aionode.engine.bare_node import BarePublisher

__all__ = ["IoThread"]

T = TypeVar("T")

MAX_WAITING = 1000
"""Number of messages that may wait for the thread before `publish` blocks."""

SLICE = 100
"""Number of messages that the thread takes in one loop iteration."""

PRECISE_S = 0.002
"""The end of a wait, in seconds, during which no descriptors are watched, since that has a
resolution of milliseconds."""

STOP_S = 5.0
"""How long the end of the process waits for the thread: longer than all of its steps.

Inside Zenoh at the very end, it would abort the process.
"""

logger = logging.getLogger("aionode.rclpy")

FAILURE = "in the input and output of a context"

now_ns = MachineTime().system_ns
steady_ns = MachineTime().steady_ns


class IoThread:
    """Runs a context in the event loop of its own thread, from `start` to `stop`.

    Attributes:
        context: The context; it and everything that belongs to it are used in this thread only.
    """

    def __init__(self, context: Context) -> None:
        self.context = context
        self._work: deque[Callable[[], object]] = deque()
        # The number of times that the loop has checked for work, and that number when it was last
        # woken. If they are equal, it will check again. The loop checks once it runs.
        self._looks = 0
        self._woken_after = 0
        # Set by the thread when it ends; from then on, each thread does the work that it posts.
        self._ended = False
        self._loop: LendableLoop | None = None
        self._stopping: asyncio.Event | None = None
        self._opened = Wakeup()
        self._failure: BaseException | None = None  # to open the context
        self._inherited = False  # whether it belongs to the parent of this forked process
        # Held while a message is delivered inside this context, in the publishing thread, and while
        # subscriptions are added and removed. Nothing waits while it is held.
        self._delivery_lock = Lock()
        # A daemon, because the interpreter waits for other threads before it calls `atexit`
        # functions.
        self._thread = Thread(target=self._main, name="rclpy-io", daemon=True)

    def start(self) -> None:
        """Start the thread, and open the context.

        Raises:
            TransportError: a transport cannot connect.
        """
        self._thread.start()
        self._opened.wait(None)
        if self._failure is not None:
            raise self._failure

    def stop(self) -> None:
        """Close the context once everything published is sent, and end the thread."""
        if self._thread.is_alive() and not self.is_current:
            self.post(self._stop)
            self._thread.join(STOP_S)

    @property
    def is_current(self) -> bool:
        """Whether the caller runs in this thread."""
        return self._thread.ident == get_ident()

    def call(self, function: Callable[..., T], *args: Any) -> T:
        """Call `function` in the thread, and return its result.

        Raises:
            InvalidHandle: the context is shut down.
            RCLError: a finalizer calls this where it cannot wait.
            ForkedProcessError: the context belongs to the parent of this forked process.
            Exception: raised by the function.
        """
        if self.is_current:
            return function(*args)
        uninterrupted.refuse_to_wait()
        self.refuse_if_inherited()
        results: list[T] = []
        errors: list[BaseException] = []
        done = Wakeup()

        def work() -> None:
            try:
                self._refuse_if_ended()
                results.append(function(*args))
            except BaseException as error:  # noqa: BLE001  # raised in the calling thread
                errors.append(error)
            done.wake()

        self.post(work)
        done.wait(None)
        if errors:
            raise errors[0]
        return results[0]

    def post(self, action: Callable[[], object]) -> None:
        """Call `action` in the thread soon, after everything posted before.

        Any thread, signal handler or finalizer may call this at any time.
        """
        self._work.append(action)
        self._schedule()

    def send(self, action: Callable[[], object]) -> None:
        """Call `action`, which sends something, after everything posted before.

        It is called at once in this thread if the context's thread sleeps, otherwise soon in the
        context's thread.

        Raises:
            ForkedProcessError: the context belongs to the parent of this forked process.
        """
        self.refuse_if_inherited()
        if self._work or not uninterrupted.begin():
            self.post(action)
            return
        try:
            loop = self._loop
            if self._work or loop is None or not loop.borrow():
                self.post(action)
                return
            try:
                action()
            except Exception:
                logger.exception(FAILURE)
            finally:
                loop.give_back()
        finally:
            uninterrupted.end()

    def publish(self, publisher: BarePublisher, msg: Any) -> None:
        """Deliver a message inside this context, and then send it to others, as `send` does.

        Only one call is in progress at a time. It is delivered when this returns; only for a
        finalizer that has interrupted such a call it is delivered later. This waits first while
        more is posted than the thread has done.

        Raises:
            QueueFullError: a KEEP_ALL subscription of this context is full.
        """
        if len(self._work) >= MAX_WAITING:
            self._pace()
        if uninterrupted.begin():
            try:
                with self._delivery_lock:
                    source_ns = now_ns()
                    sequence = publisher.publish_here(msg, source_ns)
                    if not sequence:
                        return
                    loop = self._loop
                    if self._work or loop is None or not loop.borrow():
                        if not self._ended:
                            send = partial(publisher.publish_elsewhere, msg, sequence, source_ns)
                            self.post(send)
                        return
                    # `send` inlined: two calls less for each message.
                    try:
                        publisher.publish_elsewhere(msg, sequence, source_ns)
                    except Exception:
                        logger.exception(FAILURE)
                    finally:
                        loop.give_back()
            finally:
                uninterrupted.end()
        elif uninterrupted.begun():
            self.post(partial(self.publish, publisher, msg))
        else:
            self.call(self.publish, publisher, msg)

    def change_delivery(self, change: Callable[[], T]) -> T:
        """Call `change`, which adds or removes receivers of deliveries; in the thread only.

        Nothing is delivered inside this context meanwhile.
        """
        begun = uninterrupted.begin()
        try:
            with self._delivery_lock:
                return change()
        finally:
            if begun:
                uninterrupted.end()

    def wait(self, wakeup: Wakeup, timeout_sec: float | None) -> bool:
        """Wait for a wake-up, and read incoming data meanwhile, so that no other thread has to.

        Args:
            wakeup: What is waited for.
            timeout_sec: The longest time in seconds; None forever.

        Returns:
            Whether a wake-up has come.

        Raises:
            ForkedProcessError: the context belongs to the parent of this forked process.
        """
        if self._inherited:
            self.refuse_if_inherited()
        readers = None if self._loop is None else self._loop.readers
        ends_ns = None if timeout_sec is None else steady_ns() + timeout_sec * 1e9
        if (
            readers is not None
            and (timeout_sec is None or timeout_sec > PRECISE_S)
            and uninterrupted.begin(readers.rouse)
        ):
            try:
                if readers.begin():
                    try:
                        reads_until_ns = None if ends_ns is None else ends_ns - PRECISE_S * 1e9
                        if readers.read(wakeup, reads_until_ns, uninterrupted.postponed):
                            return True
                    finally:
                        wakeup.rouse = None
                        readers.end()
            finally:
                uninterrupted.end()
        return wakeup.wait(None if ends_ns is None else (ends_ns - steady_ns()) / 1e9)

    def _pace(self) -> None:
        """Wait until the thread has done what is posted, where it is possible to wait."""
        if not self.is_current and not uninterrupted.begun():
            turn = Wakeup()
            self.post(turn.wake)
            turn.wait(None)

    def _schedule(self) -> None:
        if self._ended:
            self._drain()
        elif self._woken_after != self._looks and not self._inherited:
            looks = self._looks
            try:
                self.loop.call_soon_threadsafe(self._drain)
            except RuntimeError:  # the loop has just been closed
                self._drain()
                return
            # Not before it is woken: a signal handler may interrupt this, post something itself and
            # wait for it; or it may raise, in which case the loop would never be woken.
            self._woken_after = looks

    def _drain(self) -> None:
        self._looks += 1
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
                    logger.exception(FAILURE)
        if work:
            self._schedule()

    def _refuse_if_ended(self) -> None:
        if self._ended:
            raise InvalidHandle("the context is shut down")

    def refuse_if_inherited(self) -> None:
        """Raise in a forked child.

        Raises:
            ForkedProcessError: the context belongs to the parent of this forked process.
        """
        if self._inherited:
            raise ForkedProcessError("the context of rclpy")

    def abandon(self) -> None:
        """Leave everything to the parent process, from which this one was forked."""
        self._inherited = True
        self._loop = None
        self._work.clear()

    def _stop(self) -> None:
        if self._stopping is not None:
            self._stopping.set()

    def _main(self) -> None:
        try:
            with asyncio.Runner(loop_factory=LendableLoop) as runner:
                runner.run(self._run())
        except BaseException as error:
            if self._loop is not None:
                logger.exception("a context ended")
            else:
                self._failure = error
        finally:
            self._ended = True
            self._opened.wake()
            while self._work:
                self._drain()

    async def _run(self) -> None:
        async with self.context:
            loop = asyncio.get_running_loop()
            assert isinstance(loop, LendableLoop)  # noqa: S101  # `_main` has made it
            self._loop = loop
            self._stopping = asyncio.Event()
            self._opened.wake()
            self._drain()  # a signal may have ended `start`, so `stop` may already be here
            await self._stopping.wait()

    # In the thread

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The event loop of the thread."""
        assert self._loop is not None  # noqa: S101  # `start` has returned
        return self._loop
