"""Callbacks that run within the event that asks for them: the way past a queue, or past a task."""

from __future__ import annotations

import asyncio
from contextvars import Context, copy_context
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.clock import perf_ns

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Coroutine

    from aionode.endpoints._core.message_queue import MessageQueue

__all__ = ["InlineCall", "InlineRunner"]

T = TypeVar("T")


class InlineCall:
    """Runs callbacks within an event, while a task waits that runs them otherwise.

    What a callback leaves, an error or something to await, is for that task: `after` takes it.
    """

    __slots__ = ("_context", "_error", "_rest")

    def __init__(self) -> None:
        self._context: Context | None = None
        self._error: BaseException | None = None
        self._rest: Coroutine[object, object, None] | None = None

    def prepare(self) -> None:
        """Let callbacks run in the context of this task, as they would if it called them."""
        if self._context is None:
            self._context = copy_context()

    def run(
        self, handle: Callable[..., Coroutine[object, object, None] | None], *args: Any
    ) -> bool:
        """Call `handle`, once `prepare` was called; return whether nothing is left of it."""
        assert self._context is not None  # noqa: S101  # as said
        try:
            self._rest = self._context.run(handle, *args)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # noqa: BLE001  # raised by the task, as if it had called
            self._error = error
        return self._rest is None and self._error is None

    async def after(self, event: Awaitable[None]) -> None:
        """Wait for `event`, and finish what was left meanwhile; `run` causes the event if need be.

        Raises:
            BaseException: what a callback raised.
        """
        try:
            await event
        except asyncio.CancelledError:
            if self._rest is not None:
                self._rest.close()
                self._rest = None
            if self._error is None:
                raise
        if self._error is not None:
            error, self._error = self._error, None
            raise error
        if self._rest is not None:
            rest, self._rest = self._rest, None
            await rest


class InlineRunner(InlineCall, Generic[T]):
    """Handles an item within the event that brought it, while the pump of its inbox is idle.

    To wake the pump takes one more turn of the loop and a step of a task, which is much of what a
    message costs. The order stays: while anything is in the inbox, or the pump was woken, nothing
    is handled here. What a callback leaves goes to the pump, which takes it before anything else.

    Args:
        message_queue: The queue that is passed by.
        handle: What the pump calls too; only for callbacks that are not known to wait.
    """

    __slots__ = ("_handle", "_message_queue", "_waiter")

    def __init__(
        self,
        message_queue: MessageQueue[T],
        handle: Callable[[int, T], Coroutine[object, object, None] | None],
    ) -> None:
        super().__init__()
        self._message_queue = message_queue
        self._handle = handle
        # What the pump waits for; None while it does not, or while a callback runs here.
        self._waiter: asyncio.Future[None] | None = None

    def take(self, item: T, inline_deadline_ns: int) -> bool:
        """Handle `item` if that may be done before `inline_deadline_ns`; return whether it was."""
        waiter = self._waiter
        if waiter is None or waiter.done():
            return False
        now_ns = perf_ns()
        if now_ns >= inline_deadline_ns:
            return False
        self._waiter = None
        try:
            done = self.run(self._handle, now_ns, item)
        finally:
            self._waiter = waiter
        # The callback may have woken or cancelled the pump itself.
        if not done and not waiter.done():
            waiter.set_result(None)
        return True

    async def wait(self) -> None:
        """Wait until something is in the inbox, and finish what was begun here. For the pump.

        Raises:
            BaseException: what a callback raised.
        """
        if not self._message_queue:
            self.prepare()
            await self.after(self._until_woken())

    async def _until_woken(self) -> None:
        waiter = self._waiter = self._message_queue.expect()
        try:
            await waiter
        finally:
            self._waiter = None
            self._message_queue.forget(waiter)
