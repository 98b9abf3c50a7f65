"""Executors: plain loops in the spinning threads, which call the callbacks of nodes.

I/O happens elsewhere, in the thread of the context; arriving items wait in the handles of the
entities until an executor takes them.
"""

from __future__ import annotations

import inspect
import itertools
import os
import threading
import time  # noqa: TID251  # for programs that take it from here
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, Self, cast

from aionode.clock import MachineTime
from rclpy._impl.destroyable import Wakeup
from rclpy._taking import (
    Ready,
    Take,
    await_or_execute,
    find_ready,
    is_awaited,
    is_still_due,
    wait_set_of,
)
from rclpy.task import Future, Task
from rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from collections.abc import Coroutine, Generator, Iterable, Iterator

    from rclpy._protocols import NodeLike
    from rclpy.callback_groups import Entity
    from rclpy.context import Context

__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
    "TimeoutObject",
    "await_or_execute",
    "inspect",
    "time",
]

steady_ns = MachineTime().steady_ns


class TimeoutException(Exception):  # noqa: N818  # rclpy's name
    """Nothing became ready in time."""


class ShutdownException(Exception):  # noqa: N818  # rclpy's name
    """The executor is shut down."""


class ExternalShutdownException(Exception):  # noqa: N818  # rclpy's name
    """The context is shut down."""


class ConditionReachedException(Exception):  # noqa: N818  # rclpy's name
    """The awaited future is done."""


class TimeoutObject:
    """A time limit in seconds that may change while it is used."""

    def __init__(self, timeout: float) -> None:
        self._timeout = timeout

    @property
    def timeout(self) -> float:
        """The limit."""
        return self._timeout

    @timeout.setter
    def timeout(self, timeout: float) -> None:
        self._timeout = timeout


def never() -> bool:
    """Return False."""
    return False


Work = tuple[Task[Any], "Entity | None", "NodeLike | None"]


class Executor:
    """The base class of executors. Subclasses define `spin_once`, using `wait_for_ready_callbacks`.

    Args:
        context: Its context; the default one by default.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = get_default_context() if context is None else context
        self._nodes: dict[NodeLike, None] = {}
        # Held while a node is added or removed, so that its signal wakes this executor exactly
        # once. A thread can acquire this lock and the next one recursively: a signal handler, or a
        # finalizer, may interrupt the thread that holds them.
        self._nodes_lock = threading.RLock()
        self._tasks: list[Work] = []
        # Held while tasks are added, and while completed ones are removed, so that none is lost.
        self._tasks_lock = threading.RLock()
        self._Executor__wakeup = Wakeup()
        self._is_shutdown = False
        self._Executor__spins = 0
        # Used by the spinning thread; only one thread at a time may spin.
        self._cb_iter: Generator[Ready | Work, None, None] | None = None
        self._last_args: tuple[Any, ...] = ()
        if self._context.handle is None:
            raise RuntimeError("Context must be initialized a GuardCondition can be created")
        self._context.handle.refuse_if_over("guard_condition")
        self._Executor__context_handle = self._context.handle
        self._Executor__context_handle.signal.add(self._Executor__wakeup)
        self._Executor__io = self._Executor__context_handle.io
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """The context."""
        return self._context

    # Tasks

    def create_task(self, callback: Callable[..., Any], *args: Any, **kwargs: Any) -> Task[Any]:
        """Schedule a function or coroutine to run while the executor spins; return its future."""
        task: Task[Any] = Task(callback, args, kwargs, executor=self)
        with self._tasks_lock:
            self._tasks.append((task, None, None))
        self.wake()
        return task

    def create_future(self) -> Future[Any]:
        """Return a future whose done callbacks are tasks of this executor."""
        return Future(executor=self)

    # Nodes

    def add_node(self, node: NodeLike) -> bool:
        """Call the callbacks of `node` from now on; its former executor stops doing so.

        Returns:
            Whether it is new here.

        Raises:
            ForkedProcessError: the context belongs to the parent of this forked process.
        """
        self._Executor__io.refuse_if_inherited()
        with self._nodes_lock:
            if node in self._nodes:
                return False
            self._nodes[node] = None
            node.executor = self
            node.handle.signal.add(self._Executor__wakeup)
        self.wake()
        return True

    def remove_node(self, node: NodeLike) -> None:
        """Stop calling the callbacks of `node`."""
        with self._nodes_lock:
            if node in self._nodes:
                del self._nodes[node]
                node.handle.signal.remove(self._Executor__wakeup)
        self.wake()

    def get_nodes(self) -> list[NodeLike]:
        """Return the nodes."""
        return list(self._nodes)

    def wake(self) -> None:
        """Wake the executor to check again what is ready; any thread may call this."""
        self._Executor__wakeup.wake()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop starting callbacks, and release the nodes.

        As in rclpy, it does not wait for running callbacks: one of them may have called it.

        Args:
            timeout_sec: Ignored.

        Returns:
            True.
        """
        self._is_shutdown = True
        self.wake()
        for node in self.get_nodes():
            self.remove_node(node)
        self._Executor__context_handle.signal.remove(self._Executor__wakeup)
        self._cb_iter = None
        return True

    # Spinning

    @property
    def is_spinning(self) -> bool:
        """Whether a thread is in one of the spin methods; of newer rclpy."""
        return self._Executor__spins > 0

    def spin(self) -> None:
        """Call callbacks until the executor or its context is shut down."""
        # Not by a context manager, which would take a tenth of a message's time.
        self._Executor__spins += 1
        try:
            while self._context.ok() and not self._is_shutdown:
                self.spin_once()
        finally:
            self._Executor__spins -= 1

    def spin_until_future_complete(
        self, future: Future[Any], timeout_sec: float | None = None
    ) -> None:
        """Call callbacks until `future` is done.

        Args:
            future: The future.
            timeout_sec: Maximum time, in seconds; None or negative for no limit.
        """
        # A future created by this executor is one of its tasks, which costs `spin_once` one more
        # call.
        future.add_done_callback(lambda _: self.wake())
        self._Executor__spins += 1
        try:
            self._Executor__spin_until(future, timeout_sec)
        finally:
            self._Executor__spins -= 1

    def _Executor__spin_until(self, future: Future[Any], timeout_sec: float | None) -> None:
        if timeout_sec is None or timeout_sec < 0:
            while self._Executor__goes_on(future):
                self._spin_once_impl(timeout_sec, future.done)
            return
        ends_ns = steady_ns() + timeout_sec * 1e9
        left = TimeoutObject(timeout_sec)
        while self._Executor__goes_on(future):
            self._spin_once_impl(left, future.done)
            left_ns = ends_ns - steady_ns()
            if left_ns <= 0:
                return
            left._timeout = left_ns / 1e9

    def _Executor__goes_on(self, future: Future[Any]) -> bool:
        if self._Executor__context_handle.is_shut_down:
            self._Executor__context_handle.note_told()
            return False
        return not (future.done() or future.cancelled() or self._is_shutdown)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait for one callback, and call it or have a thread call it.

        Only one thread at a time may spin.

        Args:
            timeout_sec: Maximum time to wait, in seconds; None or negative for no limit.

        Raises:
            NotImplementedError: a custom executor does not define this method.
            Exception: raised by the callback, or by an earlier one called in a thread.
        """
        self._Executor__spins += 1
        try:
            self._spin_once_impl(timeout_sec)
        finally:
            self._Executor__spins -= 1

    def spin_once_until_future_complete(
        self, future: Future[Any], timeout_sec: float | TimeoutObject | None = None
    ) -> None:
        """Like `spin_once`, but return as soon as `future` is done."""
        future.add_done_callback(lambda _: self.wake())
        self._Executor__spins += 1
        try:
            self._spin_once_impl(timeout_sec, future.done)
        finally:
            self._Executor__spins -= 1

    def _spin_once_impl(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        condition: Callable[[], bool] = never,
    ) -> None:
        raise NotImplementedError

    def can_execute(self, entity: Entity) -> bool:
        """Return whether an entity's callback may start: none is about to, and its group agrees."""
        return (
            not entity._executor_event
            and entity.callback_group is not None
            and entity.callback_group.can_execute(entity)
        )

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: list[NodeLike] | None = None,
        condition: Callable[[], bool] = never,
    ) -> Work:
        """Wait for a callback that is ready, and return a task that calls it.

        Ready callbacks are collected in rounds: waitables, timers, subscriptions, guard conditions,
        clients, services, with at most one call of each entity.

        Args:
            timeout_sec: Maximum time to wait, in seconds; None or negative for no limit.
            nodes: The nodes to check; by default those of this executor.
            condition: Ends the wait when it is true.

        Returns:
            The task, its entity and node; the latter are None for tasks of `create_task`.

        Raises:
            TimeoutException: nothing was ready in time.
            ShutdownException: the executor is shut down.
            ExternalShutdownException: the context is shut down.
            ConditionReachedException: the condition is true.
        """
        return self._Executor__as_task(self._Executor__next(timeout_sec, nodes, condition))

    def _Executor__next(
        self,
        timeout_sec: float | TimeoutObject | None,
        nodes: list[NodeLike] | None,
        condition: Callable[[], bool],
    ) -> Ready | Work:
        """Return the next of this round, or, after a wait, the first of the next round."""
        args = (timeout_sec, nodes, condition)
        while True:
            if self._cb_iter is None or self._last_args != args:
                self._last_args = args
                self._cb_iter = self._Executor__rounds(timeout_sec, nodes, condition)
            try:
                return next(self._cb_iter)
            except StopIteration:
                self._cb_iter = None

    def _wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: list[NodeLike] | None = None,
        condition: Callable[[], bool] = never,
    ) -> Iterator[Work]:
        """Return the callbacks of one round as tasks, waiting until there is one."""
        return map(self._Executor__as_task, self._Executor__rounds(timeout_sec, nodes, condition))

    def _Executor__rounds(  # noqa: C901, PLR0912  # once for each message, so in one function
        self,
        timeout_sec: float | TimeoutObject | None,
        nodes: list[NodeLike] | None,
        condition: Callable[[], bool],
    ) -> Generator[Ready | Work, None, None]:
        """Yield what is ready in one round, waiting until something is."""
        if isinstance(timeout_sec, TimeoutObject):
            timeout_sec = timeout_sec.timeout
        ends_ns = None
        if timeout_sec is not None and timeout_sec >= 0:
            ends_ns = steady_ns() + int(timeout_sec * 1e9)
        context = self._Executor__context_handle
        yielded = False
        while not yielded:
            self._Executor__wakeup.take(False)  # whatever woke it is checked now
            if self._is_shutdown or context.is_shut_down or condition():
                self._Executor__raise_if_over(condition)
            used = self.get_nodes() if nodes is None else nodes
            if self._tasks:
                for work in self._Executor__unfinished(used):
                    yielded = True
                    yield work
            ready = find_ready(used, self.can_execute, context)
            if not ready and not yielded:
                left_ns = None if ends_ns is None else ends_ns - steady_ns()
                if left_ns is None or left_ns > 0:
                    self._Executor__wait(used, left_ns)
                    if self._is_shutdown or context.is_shut_down:
                        self._Executor__raise_if_over()
                    ready = find_ready(used, self.can_execute, context)
            if len(ready) > 1:
                ready = self._Executor__in_turn(ready)
            # Before the calls, which may take longer than the limit.
            over = ends_ns is not None and (timeout_sec == 0 or steady_ns() >= ends_ns)
            for call in ready:
                # A call of this round may have started another one, of the same group, or reset,
                # cancelled or destroyed this timer.
                if call is ready[0] or (self.can_execute(call[0]) and is_still_due(call)):
                    yielded = True
                    yield call
            if over:
                raise TimeoutException

    def _Executor__in_turn(self, ready: list[Ready]) -> list[Ready]:
        """Return the ready entities in the order in which they are called."""
        return ready

    def _Executor__raise_if_over(self, condition: Callable[[], bool] = never) -> None:
        if self._is_shutdown:
            self.wake()  # another thread may be waiting, too
            raise ShutdownException
        if self._Executor__context_handle.is_shut_down:
            self._Executor__context_handle.note_told()
            self._Executor__io.refuse_if_inherited()
            self.wake()
            raise ExternalShutdownException
        if condition():
            raise ConditionReachedException

    def _Executor__unfinished(self, nodes: list[NodeLike]) -> Iterable[Work]:
        """Yield the tasks that can continue, and remove those that are done."""
        with self._tasks_lock:
            self._tasks = [
                work for work in self._tasks if not (work[0].done() or work[0].cancelled())
            ]
            tasks = list(self._tasks)
        for work in tasks:
            task, _, node = work
            if (
                task._can_go_on()
                and not task.executing()
                and not task._scheduled
                and not task.done()
                and (node is None or node in nodes)
            ):
                yield work

    def _Executor__wait(self, nodes: list[NodeLike], left_ns: int | None) -> None:
        """Wait until something may be ready, or the time has passed."""
        waits = [] if left_ns is None else [left_ns]
        waitables: list[Any] = []
        for node in nodes:
            for timer in tuple(node._timers):
                # If its group is busy, the end of that group's call wakes the executor.
                if self.can_execute(timer):
                    due_ns = timer.handle.due_in_ns()
                    if due_ns is not None:
                        waits.append(due_ns)
            if node._Node__waitables:  # few nodes have any
                waitables += filter(self.can_execute, tuple(node._Node__waitables))
        wait_set = wait_set_of(waitables, self._Executor__context_handle) if waitables else None
        if wait_set is not None:
            due_ns = wait_set.due_in_ns()
            if due_ns is not None:
                waits.append(due_ns)
            wait_set.watch(self._Executor__wakeup)
        try:
            # A handle of a waitable may have become ready before it was watched.
            if wait_set is None or not wait_set.may_be_ready():
                timeout_sec = max(0, min(waits)) / 1e9 if waits else None
                self._Executor__io.wait(self._Executor__wakeup, timeout_sec)
        finally:
            if wait_set is not None:
                wait_set.unwatch(self._Executor__wakeup)

    # Calling callbacks

    def _Executor__as_task(self, ready: Ready | Work) -> Work:
        """Return a task that takes the ready item and calls the entity's callback with it."""
        if isinstance(ready[0], Task):
            return ready  # type: ignore[return-value]  # as its first element says
        entity, node, take = cast("Ready", ready)
        entity._executor_event = True
        return self._Executor__add_task(self._Executor__handle(entity, take), entity, node)

    def _Executor__add_task(
        self, coroutine: Coroutine[Any, Any, None], entity: Any, node: Any
    ) -> Work:
        task: Task[Any] = Task(coroutine, executor=self)
        work = (task, entity, node)
        with self._tasks_lock:
            self._tasks.append(work)
        return work

    async def _Executor__handle(self, entity: Entity, take: Take) -> None:
        group = entity.callback_group
        if self._is_shutdown or not (group is None or group.beginning_execution(entity)):
            entity._executor_event = False
            self.wake()
            return
        try:
            call = take(self, entity)
            entity._executor_event = False
            self.wake()
            if call is not None:
                result = call()
                if is_awaited(call, result):
                    await result
        finally:
            entity._executor_event = False
            if group is not None:
                group.ending_execution(entity)
            self.wake()

    def _Executor__call(self, entity: Entity, node: Any, take: Take) -> Task[Any] | None:
        """Take the ready item and call the entity's callback with it, in the only spinning thread.

        Returns:
            A task if the callback is a coroutine, which has yet to begin.
        """
        group = entity.callback_group
        if self._is_shutdown or not (group is None or group.beginning_execution(entity)):
            return None
        coroutine = None
        try:
            call = take(self, entity)
            result = None if call is None else call()
            if result is not None and call is not None and is_awaited(call, result):
                coroutine = result
        finally:
            if coroutine is None and group is not None:
                group.ending_execution(entity)
        if coroutine is None:
            return None
        return self._Executor__add_task(self._Executor__finish(coroutine, entity), entity, node)[0]

    async def _Executor__finish(self, coroutine: Coroutine[Any, Any, None], entity: Entity) -> None:
        try:
            await coroutine
        finally:
            if entity.callback_group is not None:
                entity.callback_group.ending_execution(entity)
            self.wake()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()


class SingleThreadedExecutor(Executor):
    """Calls callbacks in the thread that spins."""

    def _spin_once_impl(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        condition: Callable[[], bool] = never,
    ) -> None:
        try:
            ready = self._Executor__next(timeout_sec, None, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        task = ready[0] if isinstance(ready[0], Task) else self._Executor__call(*ready)
        if task is None:
            return
        task()
        exception = task.exception()
        if exception is not None:
            raise exception


class MultiThreadedExecutor(Executor):
    """Calls callbacks in a thread pool.

    Args:
        num_threads: The most threads; by default one for each CPU of this process.
        context: Its context; the default one by default.
    """

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        if num_threads is None:
            num_threads = (
                len(os.sched_getaffinity(0))
                if hasattr(os, "sched_getaffinity")
                else os.cpu_count() or 2
            )
        if num_threads == 1:
            warnings.warn(
                "MultiThreadedExecutor is used with a single thread.\n"
                "Use the SingleThreadedExecutor instead.",
                stacklevel=2,
            )
        self._futures: list[Task[Any]] = []
        self._executor = ThreadPoolExecutor(num_threads)
        self._Executor__num_threads = num_threads
        self._Executor__turns = itertools.count(1)

    def _spin_once_impl(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        condition: Callable[[], bool] = never,
    ) -> None:
        try:
            self._Executor__wait_for_thread(timeout_sec, condition)
            task, entity, _ = self.wait_for_ready_callbacks(timeout_sec, None, condition)
        except (
            ExternalShutdownException,
            ShutdownException,
            TimeoutException,
            ConditionReachedException,
        ):
            return
        if entity is not None:
            entity._executor_turn = next(self._Executor__turns)
        task._scheduled = True
        try:
            self._executor.submit(self._Executor__step, task)
        except RuntimeError:  # at the end of the process, when Python has ended all pools
            task.cancel()
            return
        if task not in self._futures:
            self._futures.append(task)
        for future in self._futures[:]:
            if future.done():
                self._futures.remove(future)
                future.result()  # raises the callback's exception

    def _Executor__in_turn(self, ready: list[Ready]) -> list[Ready]:
        """Return the ready entities, the one whose last call is longest ago first."""
        return sorted(ready, key=lambda call: getattr(call[0], "_executor_turn", 0))

    def _Executor__wait_for_thread(
        self, timeout_sec: float | TimeoutObject | None, condition: Callable[[], bool]
    ) -> None:
        """Wait until a thread is free, so that items are taken only when they can be processed.

        Otherwise calls would queue up that nobody can stop: a timer that takes longer than its
        period would delay services and Ctrl-C by all its missed calls.
        """
        if isinstance(timeout_sec, TimeoutObject):
            timeout_sec = timeout_sec.timeout
        ends_ns = None
        if timeout_sec is not None and timeout_sec >= 0:
            ends_ns = steady_ns() + int(timeout_sec * 1e9)
        while sum(task._scheduled for task in self._futures) >= self._Executor__num_threads:
            self._Executor__wakeup.take(False)  # whatever woke it is checked now
            self._Executor__raise_if_over(condition)
            self._cb_iter = None  # more may be ready when a thread is free
            left_ns = None if ends_ns is None else ends_ns - steady_ns()
            if left_ns is not None and left_ns <= 0:
                raise TimeoutException
            if sum(task._scheduled for task in self._futures) < self._Executor__num_threads:
                return  # it became free before the wake-up could be recorded
            self._Executor__io.wait(
                self._Executor__wakeup, None if left_ns is None else left_ns / 1e9
            )

    def _Executor__step(self, task: Task[Any]) -> None:
        try:
            task()
        finally:
            task._scheduled = False
            self.wake()

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Stop starting callbacks, wait for running ones, and end the threads."""
        success = super().shutdown(timeout_sec)
        self._executor.shutdown(wait=wait_for_threads)
        return success
