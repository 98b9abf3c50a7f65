"""An event loop that lends itself to other threads while its own thread sleeps.

To hand work to a loop in another thread takes two wake-ups: of that thread, and, as it needs the
interpreter, of the one that holds it. While the loop sleeps, nothing that belongs to it is used, so
another thread may as well do the work itself. `LendableLoop.borrow` is how it asks; whatever
belongs to the thread of the loop belongs to the borrower until `LendableLoop.give_back`.
"""

from __future__ import annotations

import asyncio
import selectors
from contextlib import suppress
from threading import Lock
from typing import TYPE_CHECKING, Any, Protocol, TypeVarTuple

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextvars import Context

__all__ = ["LendableLoop"]

Ts = TypeVarTuple("Ts")


class HasFileno(Protocol):
    """What has a descriptor."""

    def fileno(self) -> int:
        """Return the descriptor."""


class LendableLoop(asyncio.SelectorEventLoop):
    """An event loop that other threads may borrow while it waits for events.

    Work for a borrower is short, and of the kind that a callback of the loop does. For the
    borrower this is the running loop meanwhile, also if its thread runs one of its own.
    """

    def __init__(self) -> None:
        # Held by the thread of the loop except while it waits for events, and by the borrower.
        self._owned = Lock()
        self._owned.acquire()
        self._is_lent = False
        self._has_news = False
        self._loop_of_borrower: asyncio.AbstractEventLoop | None = None
        super().__init__(_LendingSelector(self._owned))

    def borrow(self) -> bool:
        """Take the loop if it sleeps and no other thread has it. Never waits.

        Returns:
            Whether the caller has it. Then it has to call `give_back` soon: until then the loop
            does not wake up. Always False in asyncio's debug mode, which checks threads.
        """
        if self.get_debug() or not self._owned.acquire(blocking=False):
            return False
        self._is_lent = True
        self._loop_of_borrower = asyncio._get_running_loop()
        asyncio._set_running_loop(self)
        return True

    def give_back(self) -> None:
        """End what `borrow` began; the loop wakes up if the borrower has given it work."""
        asyncio._set_running_loop(self._loop_of_borrower)
        has_news, self._has_news = self._has_news, False
        self._is_lent = False
        self._owned.release()
        if has_news:
            with suppress(RuntimeError):  # it has been closed meanwhile
                self.call_soon_threadsafe(_look)

    # What gives the loop work, which it learns of when it is given back.

    def call_soon(
        self, callback: Callable[[*Ts], object], *args: *Ts, context: Context | None = None
    ) -> asyncio.Handle:
        """Schedule a callback, as in any loop."""
        self._has_news = self._is_lent
        return super().call_soon(callback, *args, context=context)

    def call_at(
        self,
        when: float,
        callback: Callable[[*Ts], object],
        *args: *Ts,
        context: Context | None = None,
    ) -> asyncio.TimerHandle:
        """Schedule a callback, as in any loop."""
        self._has_news = self._is_lent
        return super().call_at(when, callback, *args, context=context)

    def add_reader(self, fd: int | HasFileno, callback: Callable[[*Ts], Any], *args: *Ts) -> None:
        """Watch a descriptor, as in any loop."""
        self._has_news = self._is_lent
        super().add_reader(fd, callback, *args)

    def add_writer(self, fd: int | HasFileno, callback: Callable[[*Ts], Any], *args: *Ts) -> None:
        """Watch a descriptor, as in any loop."""
        self._has_news = self._is_lent
        super().add_writer(fd, callback, *args)


def _look() -> None:
    """Do nothing: the loop looks at what is scheduled when it is called."""


class _LendingSelector(selectors.DefaultSelector):
    """Lets go of a lock while it waits for events."""

    def __init__(self, owned: Lock) -> None:
        super().__init__()
        self._owned = owned

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        """Wait for events, without the lock if it may take a while."""
        if timeout is not None and timeout <= 0:
            return super().select(timeout)
        self._owned.release()
        try:
            return super().select(timeout)
        finally:
            self._owned.acquire()
