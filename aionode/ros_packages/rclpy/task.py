"""Futures and tasks. They are rclpy's, not asyncio's: executors step them, in any thread."""

from __future__ import annotations

import inspect
import sys
import threading
import warnings
import weakref
from _thread import RLock  # `threading.RLock` is a function that calls it
from enum import Enum
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.engine.causes import take
from rclpy._impl.causes import caused_by

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator

    from aionode.engine.causes import Run
    from rclpy._protocols import ExecutorLike

__all__ = ["Future", "FutureState", "Task"]

T = TypeVar("T")


class Stepping(threading.local):
    """The task that this thread is currently stepping."""

    task: Task[Any] | None = None


stepping = Stepping()


class FutureState(Enum):
    """The state of a future."""

    PENDING = "PENDING"
    CANCELLED = "CANCELLED"
    FINISHED = "FINISHED"


class Future(Generic[T]):
    """A result that arrives later. Awaiting it in a callback lets the executor do other things.

    Done callbacks run at once, in the thread that sets the result; with an executor they become its
    tasks.
    """

    def __init__(self, *, executor: ExecutorLike | None = None) -> None:
        self._state = FutureState.PENDING
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._exception_fetched = False
        self._callbacks: list[Callable[[Future[T]], object]] = []
        self._wakers: list[Callable[[], None]] = []
        # Ensures that each callback is called once: it is added before completion, or called after
        # it. A signal handler may complete the future while this thread holds the lock.
        self._lock = RLock()
        self._executor = None if executor is None else weakref.ref(executor)
        self._cause: Run | None = None  # the response that it has brought, where that is kept

    def __del__(self) -> None:
        if self._exception is not None and not self._exception_fetched:
            print(  # noqa: T201  # as rclpy does
                f"The following exception was never retrieved: {self._exception}",
                file=sys.stderr,
            )

    def __await__(self) -> Generator[Any, None, T | None]:
        while self._pending():
            task = stepping.task
            if task is not None:
                task._awaited = self
            yield  # other drivers of coroutines, such as asyncio, resume it at once
        if self._cause is not None:
            take(self._cause)
        return self.result()

    def _pending(self) -> bool:
        return self._state is FutureState.PENDING

    def cancel(self) -> None:
        """Cancel it, unless it is done."""
        with self._lock:
            if not self._pending():
                return
            self._state = FutureState.CANCELLED
        self._schedule_or_invoke_done_callbacks()

    def cancelled(self) -> bool:
        """Return whether it was cancelled."""
        return self._state is FutureState.CANCELLED

    def done(self) -> bool:
        """Return whether it has a result or an exception."""
        return self._state is FutureState.FINISHED

    def result(self) -> T | None:
        """Return the result, or None if there is none yet.

        Raises:
            Exception: the exception that was set instead.
        """
        exception = self.exception()
        if exception is not None:
            raise exception
        return self._result

    def exception(self) -> BaseException | None:
        """Return the exception that was set, or None."""
        self._exception_fetched = True
        return self._exception

    def set_result(self, result: T) -> None:
        """Set the result."""
        with self._lock:
            self._result = result
            self._state = FutureState.FINISHED
        self._schedule_or_invoke_done_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Set an exception instead of a result."""
        with self._lock:
            self._exception = exception
            self._exception_fetched = False
            self._state = FutureState.FINISHED
        self._schedule_or_invoke_done_callbacks()

    def _schedule_or_invoke_done_callbacks(self) -> None:
        with self._lock:
            executor = self._get_executor()
            callbacks, self._callbacks = self._callbacks, []
            wakers, self._wakers = self._wakers, []
        for waker in wakers:
            waker()
        for callback in callbacks:
            if executor is not None:
                executor.create_task(caused_by(callback, self._cause), self)
                continue
            try:
                caused_by(callback, self._cause)(self)
            except Exception as error:  # noqa: BLE001  # others have to be called, too
                warnings.warn(f"Unhandled exception in done callback: {error}", stacklevel=2)

    def _get_executor(self) -> ExecutorLike | None:
        return None if self._executor is None else self._executor()

    def _set_executor(self, executor: ExecutorLike | None) -> None:
        """Set the executor that runs the done callbacks as tasks."""
        self._executor = None if executor is None else weakref.ref(executor)

    def _wake_when_done(self, waker: Callable[[], None]) -> None:
        """Call `waker` in the thread that completes the future; now if it is already complete."""
        with self._lock:
            if self._pending():
                if waker not in self._wakers:
                    self._wakers.append(waker)
                return
        waker()

    def add_done_callback(self, callback: Callable[[Future[T]], object]) -> None:
        """Call `callback` with this future when it is done; immediately if it is already done.

        With an executor it becomes a task in either case.
        """
        with self._lock:
            if self._pending():
                self._callbacks.append(callback)
                return
            executor = self._get_executor()
        if executor is not None:
            executor.create_task(callback, self)
        else:
            callback(self)

    def remove_done_callback(self, callback: Callable[[Future[T]], object]) -> bool:
        """Do not call `callback`; return whether it would have been called."""
        with self._lock:
            try:
                self._callbacks.remove(callback)
            except ValueError:
                return False
            return True


class Task(Future[T]):
    """A function or coroutine that an executor runs; calling it runs it, or advances it one step.

    Created by `Executor.create_task`.
    """

    def __init__(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, Any],
        args: tuple[Any, ...] | None = None,
        kwargs: dict[str, Any] | None = None,
        executor: ExecutorLike | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args = args or ()
        self._kwargs = kwargs or {}
        self._handler: Any = handler
        if not inspect.iscoroutine(handler) and inspect.iscoroutinefunction(handler):
            self._handler = handler(*self._args, **self._kwargs)
            self._args = ()
            self._kwargs = {}
        self._awaited: Future[Any] | None = None
        self._executing = False
        self._scheduled = False  # whether a thread of a pool is about to run it
        self._task_lock = threading.Lock()  # held by the thread that runs a step; none waits for it

    def __call__(self) -> None:
        """Run the function, or the coroutine up to its next wait, unless it is already running."""
        if not self._pending() or not self._task_lock.acquire(blocking=False):
            return
        try:
            if not self._pending():
                return
            self._executing = True
            try:
                if inspect.iscoroutine(self._handler):
                    self._step(self._handler)
                    return
                result = self._handler(*self._args, **self._kwargs)
            except StopIteration as stop:
                result = stop.value
            except Exception as error:  # noqa: BLE001  # raised by `result`
                self._finish()
                self.set_exception(error)
                return
            except BaseException as error:  # the end of the program, which runs no further step
                self._finish()
                self.set_exception(error)
                self._exception_fetched = True  # the caller gets it
                raise
            self._finish()
            self.set_result(result)
        finally:
            self._executing = False
            self._task_lock.release()

    def _step(self, coroutine: Coroutine[Any, Any, T]) -> None:
        """Run a coroutine to its next wait, and make the executor resume it afterwards."""
        self._awaited = None
        outer, stepping.task = stepping.task, self
        try:
            coroutine.send(None)
        finally:
            stepping.task = outer
        self._have_executor_woken()

    def _have_executor_woken(self) -> None:
        executor = self._get_executor()
        if self._awaited is not None and executor is not None:
            self._awaited._wake_when_done(executor.wake)

    def _can_go_on(self) -> bool:
        """Return whether a step would make progress."""
        return self._awaited is None or not self._awaited._pending()

    def _finish(self) -> None:
        self._handler = None
        self._awaited = None
        self._args = ()
        self._kwargs = {}

    def executing(self) -> bool:
        """Return whether it is running right now."""
        return self._executing

    def cancel(self) -> None:
        """Cancel it, unless it is done; a coroutine is closed."""
        if self._pending() and inspect.iscoroutine(self._handler):
            self._handler.close()
        super().cancel()
