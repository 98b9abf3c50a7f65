"""Run callbacks within the loop event that triggers them, without waking a task."""

from __future__ import annotations

import asyncio
from contextvars import Context, copy_context
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Coroutine

__all__ = ["InlineCall"]


class InlineCall:
    """Runs callbacks within an event of the loop while the task that would run them waits.

    Anything left over, an exception or something to await, goes to that task through `after`.

    Attributes:
        context: The context of the task, to call `run` in; set by `prepare`.
    """

    __slots__ = ("_error", "_rest", "context")

    def __init__(self) -> None:
        self.context: Context
        self._error: BaseException | None = None
        self._rest: Coroutine[object, object, None] | None = None

    def prepare(self) -> None:
        """Take the context of the current task, for callbacks to run as if it called them."""
        self.context = copy_context()

    def run(
        self, handle: Callable[..., Coroutine[object, object, None] | None], *args: Any
    ) -> bool:
        """Call `handle`, within `context`; return False if it left something for `after`."""
        try:
            self._rest = handle(*args)
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # noqa: BLE001  # raised by the task, as if it had called
            self._error = error
        return self._rest is None and self._error is None

    async def after(self, event: Awaitable[None]) -> None:
        """Wait for `event`, which is set if `run` left something over, then finish that.

        Raises:
            BaseException: what a callback raised.
        """
        try:
            await event
        except asyncio.CancelledError:
            self.abandon()
            if self._error is None:
                raise
        rest = self.take_rest()
        if rest is not None:
            await rest

    def abandon(self) -> None:
        """Drop what `run` left over, as the task was cancelled."""
        if self._rest is not None:
            self._rest.close()
            self._rest = None

    def take_rest(self) -> Coroutine[object, object, None] | None:
        """Return what `run` left over to await, if anything.

        Raises:
            BaseException: what a callback raised.
        """
        if self._error is not None:
            error, self._error = self._error, None
            raise error
        rest, self._rest = self._rest, None
        return rest
