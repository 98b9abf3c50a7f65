"""An event loop that lends itself to other threads while its own thread sleeps.

To hand work to a loop in another thread takes two wake-ups: of that thread, and, as it needs the
interpreter, of the one that holds it. While the loop sleeps, nothing that belongs to it is used, so
another thread may as well do the work itself. `LendableLoop.borrow` is how it asks; whatever
belongs to the thread of the loop belongs to the borrower until `LendableLoop.give_back`.

A thread that waits for what the loop will read can go further, and wait for the loop's descriptors
itself: `LendableLoop.readers`.

Between `LendableLoop.borrow` and `LendableLoop.give_back`, and between `Readers.begin` and
`Readers.end`, the thread *holds* the loop: nothing else of it runs until the thread lets go. Python
runs code of others between any two bytecodes of that thread all the same:

- *A handler of a signal*, in the main thread. It may call what any thread may call at any time:
  `call_soon_threadsafe`, whose callback runs once the loop is let go; `Readers.rouse`, which never
  waits; `borrow` and `begin`, which answer False. It must wait for nothing that needs the loop,
  which would be a wait for the thread that it has interrupted.
- *An exception out of a handler*. Work that it leaves half done stays half done, but the loop is
  let go if a ``finally`` does that. That is not enough in all places: an exception before the
  ``try``, or at the first bytecode of `give_back` or `end` itself, leaves the loop held for ever.
  So the main thread calls `borrow` and `begin` only while no handler is installed that may raise.
- *The garbage collector*, in any thread: finalizers and callbacks of weak references. For them
  holds what holds for handlers. What they raise, Python prints, and it goes no further.

`rclpy._impl.uninterrupted` keeps these rules for programs of rclpy, whose threads, handlers
and finalizers know nothing of them.
"""

from __future__ import annotations

import asyncio
import os
import select
import selectors
from contextlib import suppress
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING, Any, Protocol, TypeVarTuple

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextvars import Context

__all__ = ["LendableLoop", "Readers"]

LONGEST_WAIT_S = 3600.0
"""Longest wait for descriptors."""

LONGEST_END_S = 1.0
"""Longest time for which closing a loop waits for the thread that polls in its place."""

Ts = TypeVarTuple("Ts")


class HasFileno(Protocol):
    """An object with a file descriptor."""

    def fileno(self) -> int:
        """Return the descriptor."""


class LendableLoop(asyncio.SelectorEventLoop):
    """An event loop that other threads may borrow while it waits for events.

    Work for a borrower is short, and of the kind that a callback of the loop does. For the
    borrower this is the running loop meanwhile, also if its thread runs one of its own.

    Attributes:
        readers: The descriptors of `add_reader`, to wait for in place of the loop; None where the
            system has no epoll.
    """

    def __init__(self) -> None:
        # Held by the thread of the loop except while it waits for events, and by the borrower.
        self._owned = Lock()
        self._owned.acquire()
        self._lends = True
        self._is_lent = False
        self._has_news = False
        self._loop_of_borrower: asyncio.AbstractEventLoop | None = None
        self.readers: Readers | None = None
        super().__init__(_LendingSelector(self._owned))
        if hasattr(select, "epoll"):
            self.readers = Readers(self)
            super().add_reader(self.readers.fileno(), self.readers._look)

    def set_debug(self, enabled: bool) -> None:
        """Set asyncio's debug mode, in which the loop is not lent."""
        super().set_debug(enabled)
        self._lends = not enabled

    def borrow(self) -> bool:
        """Take the loop if it sleeps and no other thread has it. Never waits.

        Returns:
            Whether the caller has it. Then it has to call `give_back` soon: until then the loop
            does not wake up. Always False in asyncio's debug mode, which checks threads.
        """
        if not self._lends or not self._owned.acquire(blocking=False):
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
                self.call_soon_threadsafe(_only_wake_up)

    # Calls that give the loop work; the loop learns of them when it is given back.

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
        if self.readers is not None:
            self.readers._add(_number_of(fd), partial(callback, *args))
            return
        self._has_news = self._is_lent
        super().add_reader(fd, callback, *args)

    def remove_reader(self, fd: int | HasFileno) -> bool:
        """Watch a descriptor no longer, as in any loop."""
        if self.readers is not None:
            return self.readers._remove(_number_of(fd))
        return super().remove_reader(fd)

    def add_writer(self, fd: int | HasFileno, callback: Callable[[*Ts], Any], *args: *Ts) -> None:
        """Watch a descriptor, as in any loop."""
        self._has_news = self._is_lent
        super().add_writer(fd, callback, *args)

    def close(self) -> None:
        """Close the loop; a thread that waits for its descriptors no longer does."""
        if self.readers is not None and not self.is_closed():
            super().remove_reader(self.readers.fileno())
            self.readers._close()
        super().close()


class Readers:
    """The descriptors that a loop reads, and the wait for them.

    One thread at a time may wait in place of the loop: `begin`, then `wait` and `call` again and
    again, at last `end`. What becomes readable wakes that thread only; the loop goes on with its
    timers, and with everything else that wakes it. Before and after, the loop reads as any other.
    """

    # The loop waits for `_gate`, in which `_epoll` is switched off while another thread waits.

    def __init__(self, loop: LendableLoop) -> None:
        self._loop = loop
        self._callbacks: dict[int, Callable[[], Any]] = {}
        self._epoll = select.epoll()
        self._gate = select.epoll()
        self._fd = self._epoll.fileno()
        self._gate.register(self._fd, select.EPOLLIN)
        self._waiting = Lock()
        self._closing = False
        self._is_gone = False
        self._rousing: list[None] = []  # an element for each thread that is about to write
        self._is_event_closed = Lock()  # acquired by who closes it, once
        self._event = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        self._add(self._event, self._take_event)

    def fileno(self) -> int:
        """Return the descriptor that the loop waits for."""
        return self._gate.fileno()

    def begin(self) -> bool:
        """Wait for the descriptors in place of the loop from now on, until `end`.

        Returns:
            Whether the caller may: no other thread does, and the loop is not being closed.
        """
        if not self._waiting.acquire(blocking=False):
            return False
        if self._closing:
            self._waiting.release()
            return False
        self._gate.modify(self._fd, 0)
        return True

    def wait(self, timeout_s: float | None) -> list[tuple[int, int]]:
        """Wait until something is readable, or `rouse` is called; with whole milliseconds.

        Args:
            timeout_s: The longest wait in seconds, None for ever; it ends after an hour all the
                same, as the system has no waits of a month.

        Returns:
            What `call` takes; empty if the time has passed.
        """
        return self._epoll.poll(None if timeout_s is None else min(timeout_s, LONGEST_WAIT_S))

    def call(self, readable: list[tuple[int, int]]) -> bool:
        """Borrow the loop and call the callbacks of these descriptors.

        Returns:
            False if the loop is not to be had, or is being closed: end the wait, and the loop does
            what is left.
        """
        if not readable:
            return not self._closing
        if not self._loop.borrow():
            return False
        try:
            self._call(readable)
        finally:
            self._loop.give_back()
        return not self._closing

    def end(self) -> None:
        """Give the waiting for descriptors back to the loop itself."""
        self._gate.modify(self._fd, select.EPOLLIN)
        self._waiting.release()

    def rouse(self) -> None:
        """End the wait of the thread that waits; any thread or signal handler may call this.

        After the loop is closed it has no effect.
        """
        # Not to a descriptor that has become another file: the last one that writes closes it. No
        # lock, as the handler of a signal may be called in the middle, and call this.
        self._rousing.append(None)
        try:
            if not self._is_gone:
                os.eventfd_write(self._event, 1)
        finally:
            self._rousing.pop()
            if self._is_gone:
                self._close_event()

    def _close_event(self) -> None:
        if not self._rousing and self._is_event_closed.acquire(blocking=False):
            os.close(self._event)

    def _take_event(self) -> None:
        with suppress(BlockingIOError):
            os.eventfd_read(self._event)

    def _look(self) -> None:
        """Read what is readable; in the thread of the loop."""
        self._call(self.wait(0))

    def _call(self, readable: list[tuple[int, int]]) -> None:
        for fd, _ in readable:
            callback = self._callbacks.get(fd)
            if callback is None:  # the callback of another one has removed it
                continue
            try:
                callback()
            except Exception as error:  # noqa: BLE001  # as in any loop
                self._loop.call_exception_handler(
                    {"message": f"Exception in callback {callback}", "exception": error}
                )

    def _add(self, fd: int, callback: Callable[[], Any]) -> None:
        with suppress(FileExistsError):  # then it has another callback from now on
            self._epoll.register(fd, select.EPOLLIN)
        self._callbacks[fd] = callback

    def _remove(self, fd: int) -> bool:
        if self._callbacks.pop(fd, None) is None:
            return False
        with suppress(OSError):  # it was closed before
            self._epoll.unregister(fd)
        return True

    def _close(self) -> None:
        self._closing = True
        self.rouse()
        if self._waiting.acquire(timeout=LONGEST_END_S):
            self._epoll.close()
            self._gate.close()
            self._is_gone = True  # before the look: `rouse` looks in the other order
            self._close_event()


def _number_of(fd: int | HasFileno) -> int:
    return fd if isinstance(fd, int) else fd.fileno()


def _only_wake_up() -> None:
    """Do nothing: scheduling it wakes the loop, which then sees its new work."""


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
