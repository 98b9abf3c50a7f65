"""The event loop and thread of a context, for calls from other threads."""

from __future__ import annotations

import asyncio
import contextlib
from concurrent.futures import Future
from threading import get_ident
from typing import TYPE_CHECKING, Any, TypeVar

from aionode._process.concurrency import running_loop

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["LoopAffinity"]

ResultT = TypeVar("ResultT")

PATIENCE_S = 1.0
"""How often a waiting thread checks whether the event loop has been closed, in seconds."""


class LoopAffinity:
    """The event loop that the nodes of a context run in.

    Attributes:
        thread: The thread of that loop; 0 while the context is not open.
    """

    __slots__ = ("_loop", "thread")

    def __init__(self) -> None:
        self.thread = 0
        self._loop: asyncio.AbstractEventLoop | None = None

    def attach(self) -> None:
        """Record the running loop and its thread as those of the context."""
        self._loop = running_loop()
        self.thread = get_ident()

    def detach(self) -> None:
        """Forget them when the context is closed."""
        self._loop = None
        self.thread = 0

    def is_other_thread(self) -> bool:
        """Return whether the context works in a thread other than this one.

        False while its loop is not running, between two calls of `run_until_complete`: nothing else
        runs then, and a thread waiting for the loop might wait forever.
        """
        if self.thread in (0, get_ident()):
            return False
        return self._loop is not None and self._loop.is_running()

    def call(self, action: Callable[[], object]) -> None:
        """Run `action` in the loop's thread: now if this is it, otherwise soon."""
        loop = self._loop
        if loop is None or self.thread == get_ident():
            action()
            return
        with contextlib.suppress(RuntimeError):  # the loop was closed, and with it the context
            loop.call_soon_threadsafe(action)

    def wait_for(self, action: Callable[..., ResultT], *args: Any) -> ResultT:
        """Run `action` in the loop's thread, and return its result. Only from other threads.

        Raises:
            Exception: whatever `action` raised.
            RuntimeError: the loop was closed.
        """
        loop = self._loop
        if loop is None:
            return action(*args)
        done: Future[ResultT] = Future()

        def act() -> None:
            try:
                result = action(*args)
            except Exception as error:  # noqa: BLE001  # raised in the calling thread
                done.set_exception(error)
            else:
                done.set_result(result)

        loop.call_soon_threadsafe(act)
        while True:
            try:
                return done.result(PATIENCE_S)
            except TimeoutError:
                if done.done():
                    raise  # raised by `action` itself
                if loop.is_closed():
                    raise RuntimeError("the event loop of the node was closed") from None
