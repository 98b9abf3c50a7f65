"""Run callbacks: measured, fair to the rest of the loop, with a policy for errors.

Every callback of every entity runs through `CallbackRunner`, and `consume` passes it the queued
items; nothing else decides what happens around a callback.
"""

from __future__ import annotations

import asyncio
import functools
import inspect
import os
import sys
import weakref
from collections.abc import Awaitable, Callable, Coroutine, Generator
from types import FunctionType, MethodType
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from msgspec import Struct, field

from aionode._process.concurrency import SLICE_NS, is_cancelled_task, run_in_thread
from aionode._process.processor_waits import WAITS
from aionode._process.tracebacks import traceback_text
from aionode.clock import perf_ns
from aionode.endpoints.core.node_tasks import create_own_task
from aionode.endpoints.core.thread_time import ThreadTime
from aionode.engine.causes import Party, note_end
from aionode.errors import (
    CallbackCancelledError,
    CallbackSignatureError,
    RequestRefusedError,
    brief,
)

if TYPE_CHECKING:
    from aionode.endpoints.core.entity import Entity
    from aionode.endpoints.core.message_queue import MessageQueue
    from aionode.endpoints.stats import CallbackStats
    from aionode.graph import EndpointInfo
    from aionode.logging import RcutilsLogger

__all__ = [
    "CallbackContext",
    "CallbackRunner",
    "Callbacks",
    "OnError",
    "accepts",
    "checked_concurrency",
    "consume",
    "is_unfinished",
]

T = TypeVar("T")


REFUSED_SEC = 1.0
"""Minimum time between two reports of requests beyond the limits of a service."""

REPORT_INTERVAL_NS = 1_000_000_000
"""Minimum time between two reports of slow callbacks of one entity."""


LOOKED_AT_NS = 1_000_000_000
"""The duration from which a callback that hardly ran may have been stopped in a debugger."""


class CallbackContext(Struct, frozen=True):
    """The callback that failed, as passed to an `on_error` function.

    Attributes:
        node: Full name of the node.
        subject: What failed, such as ``subscription of /chatter (callback on_text)``.
        entity: The entity itself.
    """

    node: str
    subject: str
    entity: object


OnError = Literal["raise", "log"] | Callable[[Exception, CallbackContext], None]


class CallbackRunner:
    """Runs the callback of one entity.

    Args:
        callback: A function or coroutine function.
        entity: The entity.
        callbacks: How its node runs callbacks.
        stats: Receives counts and durations.
        on_error: What to do with an exception: see `fail`.
        offload: Whether a sync callback runs in a thread.

    Raises:
        TypeError: `on_error` is neither a string nor a function.
        ValueError: `on_error` is an unknown string, or a coroutine function is to be offloaded.

    Attributes:
        offload: Whether the callback runs in a thread.
        is_sync: Whether a call is expected to finish at once, in the loop's own thread.
        budget_ns: How long a callback may block the loop before it is reported.
        waiting: The node's callbacks that have started and are suspended; shared with the node.
        thread_time: How long the node's thread has run; read after callbacks.
    """

    def __init__(
        self,
        callback: Callable[..., Any],
        entity: Entity,
        callbacks: Callbacks,
        stats: CallbackStats,
        *,
        on_error: OnError = "raise",
        offload: bool = False,
    ) -> None:
        self.callback = callback
        self._entity = entity
        if isinstance(on_error, str):
            if on_error not in ("raise", "log"):
                raise ValueError(
                    f"{self.subject}: on_error={brief(on_error)} is unknown; "
                    'use "raise", "log" or a function (exception, context)'
                )
        elif not callable(on_error):
            raise TypeError(
                f"{self.subject}: on_error is {brief(on_error)}; "
                'use "raise", "log" or a function (exception, context)'
            )
        if offload and inspect.iscoroutinefunction(callback):
            raise ValueError(
                f"{self.subject}: offload=True runs a sync callback in a thread, but this one "
                "is a coroutine function; use `await asyncio.to_thread(...)` inside it"
            )
        self.stats = stats
        self._callbacks = callbacks
        self._on_error = on_error
        self.offload = offload
        self.is_sync = not offload and not _is_async(callback)
        self.budget_ns = callbacks.budget_ns
        self.waiting = callbacks.waiting
        self.thread_time = callbacks.thread_time
        self._last_report_ns = -REPORT_INTERVAL_NS

    def party_of(self, endpoint: EndpointInfo) -> Party:
        """Return the party that takes what arrives at an endpoint, with the callback's name."""
        return Party.of(endpoint, self.naming())

    def naming(self) -> Callable[[], str]:
        """Return a function that names the callback, and keeps nothing of the program alive."""
        reference, first = weakref.ref(self), callback_name(self.callback)

        def name() -> str:
            runner = reference()
            return first if runner is None else callback_name(runner.callback)

        return name

    @property
    def subject(self) -> str:
        """The entity and its callback, such as ``subscription of /chatter (callback on_text)``."""
        return f"{self._entity._subject} (callback {callback_name(self.callback)})"

    def run(self, *args: Any) -> Coroutine[Any, Any, None] | None:
        """Run the callback and handle its errors; return the rest to await, or None.

        Raises:
            Exception: what the callback raised, if `on_error` is ``"raise"``.
        """
        try:
            entered = self.enter(*args)
        except Exception as error:  # noqa: BLE001  # the policy decides: `fail`
            self.fail(error)
            return None
        return self._finish(entered) if is_unfinished(entered) else None

    def receive(self, entered_ns: int, *args: Any) -> Coroutine[Any, Any, None] | None:
        """Call `run` for an item that was queued at `entered_ns`; count it, and record its wait.

        Raises:
            Exception: what the callback raised, if `on_error` is ``"raise"``.
        """
        self.stats.received += 1
        began_ns = perf_ns()
        waited_ns = began_ns - entered_ns
        if self.offload:
            self.stats.queue_wait.record(waited_ns)
            return self._finish(_Offloaded(self, args))
        try:
            outcome = self.callback(*args)
        except (Exception, asyncio.CancelledError) as error:  # noqa: BLE001  # the policy decides: `fail`
            return self.conclude(waited_ns, perf_ns() - began_ns, None, error)
        took_ns = perf_ns() - began_ns
        if outcome is not None or took_ns > self.budget_ns:
            return self.conclude(waited_ns, took_ns, outcome)
        self.stats._record_call(waited_ns, took_ns)
        if began_ns >= self.thread_time.due_ns:
            self.thread_time.read(began_ns)
        return None

    def conclude(
        self, waited_ns: int, took_ns: int, outcome: Any, error: BaseException | None = None
    ) -> Coroutine[Any, Any, None] | None:
        """Record a call of the callback, handle its error, and return the rest to await.

        Args:
            waited_ns: How long its item was queued.
            took_ns: How long the call took.
            outcome: What the callback returned.
            error: What it raised.

        Raises:
            BaseException: `error`, if it is not an `Exception` or `on_error` is ``"raise"``.
        """
        stats = self.stats
        if _is_awaitable(outcome):
            stats.queue_wait.record(waited_ns)
            return self._finish(_Measured(self, outcome))
        stats._waited_ns.append(waited_ns)
        self._record_sync(took_ns)
        if isinstance(error, asyncio.CancelledError):
            self.fail(self._cancelled(error))
        elif isinstance(error, Exception):
            self.fail(error)
        elif error is not None:
            raise error
        return None

    def _cancelled(self, cause: asyncio.CancelledError) -> CallbackCancelledError:
        """Return the error for a callback that raised CancelledError with its task not cancelled.

        That is always so for a sync callback, as its task is cancelled only where it awaits. If it
        propagated, it would silently end that task and with it the entity.
        """
        error = CallbackCancelledError(self.subject)
        error.__cause__ = cause
        return error

    async def _finish(self, outcome: Any) -> None:
        try:
            await self.outcome(outcome)
        except Exception as error:  # noqa: BLE001  # the policy decides: `fail`
            self.fail(error)

    def enter(self, *args: Any) -> Any:
        """Run the callback up to its first await; the result is for `outcome`.

        Raises:
            Exception: what a sync callback raised.
        """
        if self.offload:
            return _Offloaded(self, args)
        began_ns = perf_ns()
        try:
            outcome = self.callback(*args)
        except BaseException as error:
            ended_ns = perf_ns()
            self._record_sync(ended_ns - began_ns, ended_ns)
            if isinstance(error, asyncio.CancelledError):
                raise self._cancelled(error) from error
            raise
        if _is_awaitable(outcome):
            return _Measured(self, outcome)
        ended_ns = perf_ns()
        self._record_sync(ended_ns - began_ns, ended_ns)
        return outcome

    async def outcome(self, entered: Any) -> Any:
        """Return the result of a callback that `enter` started, awaiting it if necessary.

        Raises:
            CallbackCancelledError: something that the callback awaited was cancelled.
            Exception: what the callback raised.
        """
        if not is_unfinished(entered):
            return entered
        try:
            return await entered
        except asyncio.CancelledError as error:
            if is_cancelled_task():
                raise
            raise self._cancelled(error) from error

    async def call(self, *args: Any) -> Any:
        """Run the callback and return its result; see `enter` and `outcome` for the errors."""
        return await self.outcome(self.enter(*args))

    def fail(self, error: Exception) -> None:
        """Apply the error policy: count the error, then raise it, log it, or pass it to `on_error`.

        Raises:
            Exception: `error` itself, if `on_error` is ``"raise"``.
        """
        self.stats.errors += 1
        if self._on_error == "raise":
            error.add_note(f"in {self.subject} of node {self._callbacks.node}")
            raise error
        if self._on_error == "log" and isinstance(error, RequestRefusedError):
            # A client that sends such requests must not be able to fill this node's log.
            self._callbacks.logger.warning(
                f"{self.subject} refused a request: {error}", throttle_duration_sec=REFUSED_SEC
            )
        elif self._on_error == "log":
            self._callbacks.logger.error(f"{self.subject} failed:\n{traceback_text(error)}")
        else:
            context = CallbackContext(self._callbacks.node, self.subject, self._entity)
            try:
                self._on_error(error, context)
            except asyncio.CancelledError as cause:
                raise self._cancelled(cause) from cause

    def _record_sync(self, took_ns: int, ended_ns: int = 0) -> None:
        self.stats._record_took(took_ns)
        if took_ns > self.budget_ns:
            self.report_blocking(took_ns, self.thread_time.waited_ns())
            self.thread_time.read(perf_ns())
        elif ended_ns >= self.thread_time.due_ns:
            self.thread_time.read(ended_ns)

    def report_blocking(self, took_ns: int, waited_ns: int | None) -> None:
        """Warn that the loop was blocked for too long, at most once per second.

        The time that the thread waited for a processor does not count, since the callback could do
        nothing about it; nor does the time that a person looks at it in a debugger.

        Args:
            took_ns: How long the callback held the loop.
            waited_ns: How much of that its thread was ready without a processor; None if unknown.
        """
        now_ns = perf_ns()
        own_ns = took_ns - min(waited_ns or 0, took_ns)
        if own_ns <= self.budget_ns:
            WAITS.note(took_ns - own_ns, now_ns)
        ran_ns = self.thread_time.ran_ns()
        if (
            own_ns <= self.budget_ns
            or now_ns - self._last_report_ns < REPORT_INTERVAL_NS
            or is_debugged(own_ns, ran_ns)
        ):
            return
        self._last_report_ns = now_ns
        self._callbacks.logger.warning(
            f"{self.subject} blocked the event loop for {own_ns / 1e6:.1f} ms "
            f"(budget {self.budget_ns / 1e6:g} ms): nothing else could run. "
            f"{advice(own_ns, ran_ns, knows_waits=waited_ns is not None)}"
        )


class Callbacks(Struct, frozen=True):
    """The shared settings and state for running one node's callbacks.

    Attributes:
        node: Full name of the node.
        logger: Its logger.
        budget_ns: How long a callback may block the loop before it is reported.
        waiting: The callbacks that have started and are suspended, each named by its ``str()``.
            They add themselves when they start and remove themselves when they end.
        thread_time: How long the node's thread has run.
        slice_ns: How long a queue is drained before others get a turn; from the time base.
    """

    node: str
    logger: RcutilsLogger
    budget_ns: int
    waiting: set[object] = field(default_factory=set)
    thread_time: ThreadTime = field(default_factory=ThreadTime)
    slice_ns: int = SLICE_NS

    def make_runner(
        self,
        callback: Callable[..., Any],
        entity: Entity,
        stats: CallbackStats,
        *,
        on_error: OnError,
        offload: bool,
    ) -> CallbackRunner:
        """Create the runner of `callback` for `entity`.

        Raises:
            TypeError: `on_error` is neither a string nor a function.
            ValueError: `on_error` is an unknown string, or a coroutine function is to be offloaded.
        """
        return CallbackRunner(callback, entity, self, stats, on_error=on_error, offload=offload)


class _Measured:
    """An async callback; measures the longest stretch between two awaits."""

    __slots__ = ("_awaitable", "_runner")

    def __init__(self, runner: CallbackRunner, awaitable: Awaitable[Any]) -> None:
        self._runner = runner
        self._awaitable: Any = awaitable  # None once started

    def __del__(self) -> None:
        # The task was cancelled first, so this was never awaited.
        awaitable = self._awaitable
        if awaitable is not None:
            give_up = getattr(awaitable, "close", None) or getattr(awaitable, "cancel", None)
            if give_up is not None:
                give_up()

    def __str__(self) -> str:
        return self._runner.subject

    def __await__(self) -> Generator[Any, Any, Any]:
        runner = self._runner
        awaitable, self._awaitable = self._awaitable, None
        steps = awaitable.__await__()
        runner.waiting.add(self)
        began_ns = perf_ns()
        longest_ns = 0
        waited_ns: int | None = None  # of the longest stretch, for a processor
        thrown: BaseException | None = None
        try:
            while True:
                step_ns = perf_ns()
                try:
                    # asyncio only ever sends None to a coroutine, or throws into it.
                    waits_for = next(steps) if thrown is None else steps.throw(thrown)
                finally:
                    took_ns = perf_ns() - step_ns
                    if took_ns > longest_ns:
                        longest_ns = took_ns
                        if took_ns > runner.budget_ns:
                            waited_ns = runner.thread_time.waited_ns()
                thrown = None
                try:
                    yield waits_for
                except BaseException as error:  # noqa: BLE001  # handed on to the callback
                    thrown = error
        except StopIteration as stop:
            return stop.value
        finally:
            runner.waiting.discard(self)
            ended_ns = perf_ns()
            note_end(ended_ns)
            runner.stats.run_time.record(ended_ns - began_ns)
            runner.stats.blocking.record(longest_ns)
            if longest_ns > runner.budget_ns:
                runner.report_blocking(longest_ns, waited_ns)
            if ended_ns >= runner.thread_time.due_ns:
                runner.thread_time.read(ended_ns)


class _Offloaded:
    """A sync callback that runs in a thread."""

    __slots__ = ("_args", "_runner")

    def __init__(self, runner: CallbackRunner, args: tuple[Any, ...]) -> None:
        self._runner = runner
        self._args = args

    def __str__(self) -> str:
        return f"{self._runner.subject} in a thread, which cannot be cancelled"

    def __await__(self) -> Generator[Any, Any, Any]:
        return self._run().__await__()

    async def _run(self) -> Any:
        stats = self._runner.stats
        waiting = self._runner.waiting
        began_ns = perf_ns()
        waiting.add(self)
        try:
            return await run_in_thread(self._call)
        finally:
            waiting.discard(self)
            ended_ns = perf_ns()
            note_end(ended_ns)
            stats.run_time.record(ended_ns - began_ns)
            stats.blocking.record(0)

    def _call(self) -> Any:
        """Call the callback, in the thread.

        A future cannot hold a StopIteration (before Python 3.13 waiting for it would never end), so
        it becomes a RuntimeError, as in coroutines.
        """
        try:
            return self._runner.callback(*self._args)
        except StopIteration as error:
            raise RuntimeError(f"{self._runner.subject} raised StopIteration") from error


UNFINISHED = _Measured, _Offloaded


def _is_awaitable(outcome: Any) -> bool:
    """Return whether to await what a callback returned."""
    # The second question alone takes several times as long, for each response of a service.
    return hasattr(outcome, "__await__") and isinstance(outcome, Awaitable)


def is_unfinished(entered: object) -> bool:
    """Return whether `CallbackRunner.outcome` has to await what `CallbackRunner.enter` returned."""
    return isinstance(entered, UNFINISHED)


# Queues


def consume(
    message_queue: MessageQueue[T],
    handle: Callable[[int, T], Coroutine[Any, Any, None] | None],
    concurrent: bool | int,  # an int is a number of callbacks, not a bool
    *,
    inline: bool = False,
) -> Coroutine[Any, Any, None]:
    """Return a coroutine that passes all items of `message_queue` to `handle`, until cancelled.

    `handle` runs what can run at once and returns the rest to await, if any. With `concurrent` the
    rest runs in a task alongside the next items, any number at once or at most the given number,
    while further items stay queued. `inline` lets items bypass the queue while it is empty (see
    `MessageQueue`); not for coroutine functions that run one at a time.
    """
    if concurrent is False:
        return message_queue.consume(handle, inline=inline)
    limit = None if concurrent is True else concurrent
    return _consume_concurrently(message_queue, handle, limit, inline=inline)


async def _consume_concurrently(
    message_queue: MessageQueue[T],
    handle: Callable[[int, T], Coroutine[Any, Any, None] | None],
    limit: int | None,
    *,
    inline: bool,
) -> None:
    running: set[asyncio.Task[None]] = set()

    def start(entered_ns: int, item: T) -> Coroutine[Any, Any, None] | None:
        rest = handle(entered_ns, item)
        if rest is None:
            return None
        task = create_own_task(tasks, rest)
        if limit is None:
            return None
        running.add(task)
        task.add_done_callback(running.discard)
        return until_fewer(limit) if len(running) >= limit else None

    async def until_fewer(limit: int) -> None:
        while len(running) >= limit:
            await asyncio.wait(running, return_when=asyncio.FIRST_COMPLETED)

    async with asyncio.TaskGroup() as tasks:
        await message_queue.consume(start, inline=inline)


# Reports


def is_debugged(took_ns: int, ran_ns: int | None) -> bool:
    """Return whether somebody may have looked at a callback in Python's debugger meanwhile."""
    bdb = sys.modules.get("bdb")
    if bdb is not None and isinstance(getattr(sys.gettrace(), "__self__", None), bdb.Bdb):
        return True
    return "pdb" in sys.modules and took_ns > LOOKED_AT_NS and 2 * (ran_ns or took_ns) < took_ns


def advice(took_ns: int, ran_ns: int | None, *, knows_waits: bool = False) -> str:
    """Return the advice in a report of a slow callback: where its time went, and what helps.

    Args:
        took_ns: How long the callback blocked the loop.
        ran_ns: How long its thread ran meanwhile; None if unknown.
        knows_waits: Whether waits for a processor are left out of this time.
    """
    move = (
        "Move the work off the loop: offload=True runs a sync callback in a thread, a coroutine "
        "can await asyncio.to_thread(...)"
    )
    if ran_ns is None or 2 * ran_ns > took_ns:
        return move
    waited_for = "a lock, I/O or a sleep"
    load, cores = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0, os.cpu_count() or 1
    if load > cores and not knows_waits:
        waited_for += f", or for a processor: the load is {load:.1f} on {cores} cores"
    return (
        f"Its thread ran for {ran_ns / 1e6:.1f} ms and waited for the rest ({waited_for}). {move}"
    )


# Arguments


def _is_async(callback: Callable[..., Any]) -> bool:
    return inspect.iscoroutinefunction(callback) or inspect.iscoroutinefunction(
        type(callback).__call__
    )


def callback_name(callback: Callable[..., Any]) -> str:
    """Return the name of the program's function, looking through partials and filters."""
    if isinstance(callback, functools.partial):
        return callback_name(callback.func)
    owner = getattr(callback, "__self__", None)
    inner = getattr(
        type(owner), "_SimpleFilter__inner_callbacks", None
    )  # of `aionode.message_filters`
    names = [] if inner is None else [callback_name(function) for function in inner(owner)]
    return ", ".join(names) or getattr(callback, "__qualname__", repr(callback))


def accepts(callback: Callable[..., Any], *counts: int, subject: str, wanted: str) -> int:
    """Return the first number in `counts` of positional arguments that `callback` accepts.

    Raises:
        TypeError: `callback` is not callable.
        CallbackSignatureError: it takes a different number of arguments; the text names `wanted`.
    """
    if not callable(callback):
        raise TypeError(f"{subject}: {brief(callback)} is not callable; pass a function {wanted}")
    function = callback.__func__ if isinstance(callback, MethodType) else callback
    if isinstance(function, FunctionType) and not function.__dict__:
        # Most callbacks, in a twentieth of the time of a signature: each goal has one.
        code = function.__code__
        if not (code.co_kwonlyargcount or code.co_flags & inspect.CO_VARARGS):
            most = code.co_argcount - (function is not callback)
            least = most - len(function.__defaults__ or ())
            for count in counts:
                if least <= count <= most:
                    return count
    try:
        signature = inspect.signature(callback)
    except ValueError:  # a builtin without a signature
        return counts[0]
    for count in counts:
        try:
            signature.bind(*(None,) * count)
        except TypeError:
            continue
        return count
    name = callback_name(callback)
    raise CallbackSignatureError(subject, f"{name}{signature}", wanted)


def checked_concurrency(concurrent: bool | int, subject: str) -> bool | int:  # as in `consume`
    """Return `concurrent` if it is False, True or a positive number.

    Raises:
        TypeError: it is neither a bool nor an int.
        ValueError: it is a number below 1.
    """
    if isinstance(concurrent, bool):
        return concurrent
    if not isinstance(concurrent, int):
        raise TypeError(
            f"{subject}: concurrent={brief(concurrent)}; use False (one at a time), True (any "
            "number) or a number (the maximum at once)"
        )
    if concurrent < 1:
        raise ValueError(
            f"{subject}: concurrent={concurrent}; at least 1 callback must be able to run"
        )
    return concurrent
