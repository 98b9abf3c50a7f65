"""Where a node runs, for calls that come from elsewhere."""

from __future__ import annotations

import asyncio
import contextlib
from concurrent.futures import Future
from threading import get_ident
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["LoopAffinity"]

PATIENCE_S = 1.0
"""How long a thread waits before it looks whether the event loop is there at all."""


class LoopAffinity:
    """The event loop that a node runs in.

    Attributes:
        thread: The thread of that loop; 0 while the node does not run.
    """

    __slots__ = ("_loop", "thread")

    def __init__(self) -> None:
        self.thread = 0
        self._loop: asyncio.AbstractEventLoop | None = None

    def attach(self) -> None:
        """Note that the node runs in the loop that runs now."""
        self._loop = asyncio.get_running_loop()
        self.thread = get_ident()

    def detach(self) -> None:
        """Note that it runs no longer."""
        self._loop = None
        self.thread = 0

    def is_other_thread(self) -> bool:
        """Whether the node runs in another thread than this one."""
        return self.thread not in (0, get_ident())

    def call(self, action: Callable[[], object]) -> None:
        """Do `action` in the thread of the loop: soon from elsewhere, else at once."""
        loop = self._loop
        if loop is None or not self.is_other_thread():
            action()
            return
        with contextlib.suppress(RuntimeError):  # the loop was closed, and with it the node
            loop.call_soon_threadsafe(action)

    def wait_for(self, action: Callable[..., None], *args: Any) -> None:
        """Do `action` in the thread of the loop, and wait until it is done. From elsewhere only.

        Raises:
            Exception: what `action` raised.
            RuntimeError: the loop was closed.
        """
        loop = self._loop
        if loop is None:
            action(*args)
            return
        done: Future[None] = Future()

        def act() -> None:
            try:
                action(*args)
            except Exception as error:  # noqa: BLE001  # raised in the thread that asked
                done.set_exception(error)
            else:
                done.set_result(None)

        loop.call_soon_threadsafe(act)
        while True:
            try:
                done.result(PATIENCE_S)
            except TimeoutError:
                if done.done():
                    raise  # it is what `action` raised
                if loop.is_closed():
                    raise RuntimeError("the event loop of the node was closed") from None
            else:
                return
