"""An event loop that lends itself to other threads while its own thread sleeps.

Handing work to a loop in another thread takes two wake-ups: of that thread and, since it needs the
interpreter, of the one that holds the GIL. While the loop sleeps, nothing of it is in use, so
another thread may as well do the work itself. It asks with `LendableLoop.borrow`; whatever belongs
to the loop's thread belongs to the borrower until `LendableLoop.give_back`.

A thread that waits for something the loop will read can go further and wait for the loop's
descriptors itself: `LendableLoop.readers`.

Between `LendableLoop.borrow` and `LendableLoop.give_back`, and between `Readers.begin` and
`Readers.end`, the thread *holds* the loop: nothing else of it runs until the thread releases it.
Even so, Python may run other code between any two bytecodes of that thread:

- *A signal handler*, in the main thread. It may call what any thread may call at any time:
  `call_soon_threadsafe`, whose callback runs once the loop is released; `Readers.rouse`, which
  never blocks; `borrow` and `begin`, which return False. It must not wait for anything that needs
  the loop, since it would wait for the thread that it has interrupted.
- *An exception from a handler*. Work that it interrupts stays half done, but the loop is released
  if a ``finally`` does so. That is not always enough: an exception before the ``try``, or at the
  first bytecode of `give_back` or `end` itself, leaves the loop held forever. So the main thread
  calls `borrow` and `begin` only while no handler that may raise is installed.
- *The garbage collector*, in any thread: finalizers and weak reference callbacks. The rules for
  handlers apply to them too. Python prints what they raise, and it does not propagate.

`rclpy._impl.uninterrupted` enforces these rules for rclpy programs, whose threads, handlers and
finalizers know nothing of them.
"""

from __future__ import annotations

import asyncio
import os
import select
import selectors
from contextlib import suppress
from functools import partial
from threading import Lock, get_ident
from typing import TYPE_CHECKING, Any, Protocol, TypeVarTuple

from aionode._process.concurrency import borrowed_loops
from aionode.clock import MachineTime

if TYPE_CHECKING:
    from collections.abc import Callable, Sized
    from contextvars import Context

__all__ = ["MAX_WAIT_S", "LendableLoop", "Readers"]

MAX_WAIT_S = 1.0
"""Longest wait of one system call, in seconds, for a lock or for descriptors.

Python handles signals between two bytecodes of the main thread. One that comes just before the
system call, or in another thread, does not end it, and is handled only after it.
"""

MAX_END_S = 1.0
"""How long closing a loop waits for the thread that polls in its place."""

Ts = TypeVarTuple("Ts")

steady_ns = MachineTime().steady_ns


class HasFileno(Protocol):
    """An object with a file descriptor."""

    def fileno(self) -> int:
        """Return the descriptor."""


class Sleeper(Protocol):
    """A thread that waits.

    Attributes:
        rouse: What those who wake it have to call besides, if anything.
    """

    rouse: Callable[[], None] | None

    def take(self, blocking: bool, /) -> bool:
        """Return whether it was woken since the last time; ``blocking`` is False."""


class LendableLoop(asyncio.SelectorEventLoop):
    """An event loop that other threads may borrow while it waits for events.

    A borrower's work must be short, like that of a callback of the loop. Meanwhile `running_loop`
    returns this loop in its thread, even if that runs a loop of its own; asyncio knows nothing of
    it, since telling it would take a twentieth of a message's time.

    Attributes:
        readers: The descriptors of `add_reader`, which another thread may wait for in place of the
            loop; None if the system has no epoll.
    """

    def __init__(self) -> None:
        # Held by the loop's thread except while it waits for events, and by the borrower.
        self._owned = Lock()
        self._owned.acquire()
        self._lends = True
        self._is_lent = False
        self._has_news = False
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
        """Borrow the loop if it is sleeping and no other thread has it; never blocks.

        Returns:
            Whether the caller has it and must call `give_back` soon, as the loop does not wake up
            until then. Always False in asyncio's debug mode, which checks threads.
        """
        if not self._lends or not self._owned.acquire(False):
            return False
        self._is_lent = True
        borrowed_loops[get_ident()] = self
        return True

    def give_back(self) -> None:
        """Return the borrowed loop; it wakes up if the borrower has given it work."""
        borrowed_loops.pop(get_ident(), None)
        has_news, self._has_news = self._has_news, False
        self._is_lent = False
        self._owned.release()
        if has_news:
            with suppress(RuntimeError):  # closed meanwhile
                self.call_soon_threadsafe(_only_wake_up)

    # Calls that give the loop work, which it notices when it is given back.

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
            self.readers._add(_number_of(fd), partial(callback, *args) if args else callback)
            return
        self._has_news = self._is_lent
        super().add_reader(fd, callback, *args)

    def remove_reader(self, fd: int | HasFileno) -> bool:
        """Stop watching a descriptor, as in any loop."""
        if self.readers is not None:
            return self.readers._remove(_number_of(fd))
        return super().remove_reader(fd)

    def add_writer(self, fd: int | HasFileno, callback: Callable[[*Ts], Any], *args: *Ts) -> None:
        """Watch a descriptor, as in any loop."""
        self._has_news = self._is_lent
        super().add_writer(fd, callback, *args)

    def close(self) -> None:
        """Close the loop; a thread that waits for its descriptors stops waiting."""
        if self.readers is not None and not self.is_closed():
            super().remove_reader(self.readers.fileno())
            self.readers._close()
        super().close()


class Readers:
    """The descriptors that a loop reads, and waiting for them.

    One thread at a time may wait in place of the loop: `begin`, then `read`, finally `end`.
    Readable descriptors wake only that thread; the loop continues with its timers and everything
    else that wakes it. Before and after, the loop reads like any other.
    """

    # The loop waits for `_gate`, in which `_epoll` is disabled while another thread waits.

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
        self._rousing: list[None] = []  # one element per thread that is about to write
        self._is_event_closed = Lock()  # acquired once, by whoever closes it
        self._event = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        self._add(self._event, self._take_event)

    def fileno(self) -> int:
        """Return the descriptor that the loop waits for."""
        return self._gate.fileno()

    def begin(self) -> bool:
        """Take over waiting for the descriptors from the loop, until `end`.

        Returns:
            Whether that succeeded: no other thread is waiting, and the loop is not being closed.
        """
        if not self._waiting.acquire(False):
            return False
        if self._closing:
            self._waiting.release()
            return False
        self._gate.modify(self._fd, 0)
        return True

    def read(self, sleeper: Sleeper, ends_ns: float | None, interruptions: Sized) -> bool:
        """Read what arrives, with the loop borrowed, until `sleeper` is woken.

        Args:
            sleeper: Who waits; what is read here need not rouse it.
            ends_ns: The time of the steady clock at which this ends, None for no limit; with a
                resolution of milliseconds.
            interruptions: This ends once there are any.

        Returns:
            Whether it was woken. This also ends if the loop cannot be borrowed or is being closed;
            the loop does the rest.
        """
        loop = self._loop
        while not interruptions:
            timeout_s = MAX_WAIT_S
            if ends_ns is not None:
                timeout_s = min((ends_ns - steady_ns()) / 1e9, MAX_WAIT_S)
                if timeout_s <= 0:
                    return False
            sleeper.rouse = self.rouse
            if sleeper.take(False):
                return True
            readable = self._epoll.poll(timeout_s)
            sleeper.rouse = None
            if readable:
                if not loop.borrow():
                    return sleeper.take(False)
                try:
                    self._call(readable)
                finally:
                    loop.give_back()
            if sleeper.take(False):
                return True
            if self._closing:
                return False
        return False

    def end(self) -> None:
        """Hand waiting for the descriptors back to the loop."""
        self._gate.modify(self._fd, select.EPOLLIN)
        self._waiting.release()

    def rouse(self) -> None:
        """Wake the waiting thread; any thread or signal handler may call this.

        After the loop is closed it has no effect.
        """
        # The last writer closes the descriptor, so that none writes to one that has become another
        # file. No lock, as a signal handler may run in the middle and call this.
        self._rousing.append(None)
        try:
            if not self._is_gone:
                os.eventfd_write(self._event, 1)
        finally:
            self._rousing.pop()
            if self._is_gone:
                self._close_event()

    def _close_event(self) -> None:
        if not self._rousing and self._is_event_closed.acquire(False):
            os.close(self._event)

    def _take_event(self) -> None:
        with suppress(BlockingIOError):
            os.eventfd_read(self._event)

    def _look(self) -> None:
        """Handle readable descriptors, in the loop's thread, unless another thread waits for them.

        No other one begins meanwhile, since this might take the event that is to rouse it.
        """
        if self._waiting.acquire(False):
            try:
                self._call(self._epoll.poll(0))
            finally:
                self._waiting.release()

    def _call(self, readable: list[tuple[int, int]]) -> None:
        for fd, _ in readable:
            callback = self._callbacks.get(fd)
            if callback is None:  # removed by another one's callback
                continue
            try:
                callback()
            except Exception as error:  # noqa: BLE001  # as in any loop
                self._loop.call_exception_handler(
                    {"message": f"Exception in callback {callback}", "exception": error}
                )

    def _add(self, fd: int, callback: Callable[[], Any]) -> None:
        with suppress(FileExistsError):  # it only gets a new callback
            self._epoll.register(fd, select.EPOLLIN)
        self._callbacks[fd] = callback

    def _remove(self, fd: int) -> bool:
        if self._callbacks.pop(fd, None) is None:
            return False
        with suppress(OSError):  # already closed
            self._epoll.unregister(fd)
        return True

    def _close(self) -> None:
        self._closing = True
        self.rouse()
        if self._waiting.acquire(timeout=MAX_END_S):
            self._epoll.close()
            self._gate.close()
            self._is_gone = True  # before the check: `rouse` checks in the opposite order
            self._close_event()


def _number_of(fd: int | HasFileno) -> int:
    return fd if isinstance(fd, int) else fd.fileno()


def _only_wake_up() -> None:
    """Do nothing; scheduling this wakes the loop, which then sees its new work."""


class _LendingSelector(selectors.DefaultSelector):
    """Releases a lock while it waits for events."""

    def __init__(self, owned: Lock) -> None:
        super().__init__()
        self._owned = owned

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        """Wait for events, releasing the lock if it may take a while."""
        if timeout is not None and timeout <= 0:
            return super().select(timeout)
        self._owned.release()
        try:
            return super().select(timeout)
        finally:
            self._owned.acquire()
