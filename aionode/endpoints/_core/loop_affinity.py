"""Which event loop and thread a node runs in, for calls from other threads."""

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
"""How often a waiting thread checks whether the event loop has been closed."""


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
        """Record the running loop and its thread as those of the node."""
        self._loop = asyncio.get_running_loop()
        self.thread = get_ident()

    def detach(self) -> None:
        """Forget them: the node has stopped."""
        self._loop = None
        self.thread = 0

    def is_other_thread(self) -> bool:
        """Return whether the node runs in a thread other than this one."""
        return self.thread not in (0, get_ident())

    def call(self, action: Callable[[], object]) -> None:
        """Run `action` in the loop's thread: at once if this is it, else soon."""
        loop = self._loop
        if loop is None or not self.is_other_thread():
            action()
            return
        with contextlib.suppress(RuntimeError):  # the loop was closed, and with it the node
            loop.call_soon_threadsafe(action)

    def wait_for(self, action: Callable[..., None], *args: Any) -> None:
        """Run `action` in the loop's thread, and wait until it is done. From other threads only.

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
            except Exception as error:  # noqa: BLE001  # raised in the calling thread
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
