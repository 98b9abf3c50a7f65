"""The way past the queue, for a callback that may run at once."""

from __future__ import annotations

import asyncio
from contextvars import Context, copy_context
from typing import TYPE_CHECKING, Generic, TypeVar

from aionode.clock import perf_ns

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from aionode.endpoints.inbox import Inbox

__all__ = ["Shortcut"]

T = TypeVar("T")


class Shortcut(Generic[T]):
    """Handles an item within the event that brought it, while the pump of its inbox is idle.

    To wake the pump takes one more turn of the loop and a step of a task, which is much of what a
    message costs. The order stays: while anything is in the inbox, or the pump was woken, nothing
    is handled here. What a callback leaves, an error or something to await, goes to the pump,
    which takes it before anything else.

    Args:
        inbox: The queue that is passed by.
        handle: What the pump calls too; only for callbacks that are not known to wait.
    """

    __slots__ = ("_context", "_error", "_handle", "_inbox", "_rest", "_waiter")

    def __init__(
        self, inbox: Inbox[T], handle: Callable[[int, T], Coroutine[object, object, None] | None]
    ) -> None:
        self._inbox = inbox
        self._handle = handle
        self._context: Context | None = None
        # What the pump waits for; None while it does not, or while a callback runs here.
        self._waiter: asyncio.Future[None] | None = None
        self._error: BaseException | None = None
        self._rest: Coroutine[object, object, None] | None = None

    def take(self, item: T, until_ns: int) -> bool:
        """Handle `item` if that may be done before `until_ns`; return whether it was."""
        waiter = self._waiter
        if waiter is None or waiter.done():
            return False
        now_ns = perf_ns()
        if now_ns >= until_ns:
            return False
        assert self._context is not None  # noqa: S101  # the pump has set it before it waited
        self._waiter = None
        try:
            self._rest = self._context.run(self._handle, now_ns, item)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # noqa: BLE001  # raised by the pump, as if it had called
            self._error = error
        finally:
            self._waiter = waiter
        # The callback may have woken or cancelled the pump itself.
        if (self._rest is not None or self._error is not None) and not waiter.done():
            waiter.set_result(None)
        return True

    async def wait(self) -> None:
        """Wait until something is in the inbox, and finish what was begun here. For the pump.

        Raises:
            BaseException: what a callback raised.
        """
        inbox = self._inbox
        if inbox:
            return
        if self._context is None:
            self._context = copy_context()
        waiter = self._waiter = inbox.expect()
        try:
            await waiter
        except asyncio.CancelledError:
            if self._rest is not None:
                self._rest.close()
                self._rest = None
            if self._error is None:
                raise
        finally:
            self._waiter = None
            inbox.forget(waiter)
        if self._error is not None:
            error, self._error = self._error, None
            raise error
        if self._rest is not None:
            rest, self._rest = self._rest, None
            await rest
