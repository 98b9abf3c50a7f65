"""Handles that live as long as they are in use, and how threads learn that one is ready."""

from __future__ import annotations

from _thread import allocate_lock
from contextlib import suppress
from typing import TYPE_CHECKING, NoReturn, Protocol, Self

from aionode._process.lendable_loop import MAX_WAIT_S
from aionode.clock import MachineTime
from rclpy._impl.errors import InvalidHandle

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Arrivals", "Destroyable", "Signal", "Wakeup"]

steady_ns = MachineTime().steady_ns


class Wakeup:
    """Wakes one thread; a wake-up that arrives before the wait is kept.

    Each side is a single C call, which a signal handler may interrupt anywhere.

    Attributes:
        rouse: Wakes the thread if it is waiting for something else.
        take: ``take(False)`` returns whether a wake-up has arrived, without waiting.
    """

    __slots__ = ("_lock", "rouse", "take")

    def __init__(self) -> None:
        self.rouse: Callable[[], None] | None = None
        self._lock = allocate_lock()
        self._lock.acquire()
        self.take: Callable[[bool], bool] = self._lock.acquire

    def wake(self) -> None:
        """Wake the waiting thread, or the next one to wait."""
        try:
            self._lock.release()
        except RuntimeError:  # it is already awake
            return
        rouse = self.rouse
        if rouse is not None:
            rouse()

    def wait(self, timeout_sec: float | None) -> bool:
        """Wait for a wake-up; return whether one arrived within the limit. None means no limit."""
        if timeout_sec is None:
            while not self._lock.acquire(timeout=MAX_WAIT_S):
                pass
            return True
        ends_ns = steady_ns() + timeout_sec * 1e9
        while timeout_sec > MAX_WAIT_S:
            if self._lock.acquire(timeout=MAX_WAIT_S):
                return True
            timeout_sec = (ends_ns - steady_ns()) / 1e9
        if timeout_sec <= 0:
            return self._lock.acquire(blocking=False)
        return self._lock.acquire(timeout=timeout_sec)


class Wakeable(Protocol):
    """An object that a `Signal` wakes."""

    def wake(self) -> None:
        """Check again."""


class Signal:
    """Tells the threads that wait for an entity, or for any entity of a node, to check again."""

    __slots__ = ("_wakeups",)

    def __init__(self) -> None:
        # Only changed by single C calls, which neither another thread nor a signal handler
        # interrupts, and read as a copy.
        self._wakeups: list[Wakeable] = []

    def add(self, wakeup: Wakeable) -> None:
        """Wake `wakeup` from now on, once for each time it is added."""
        self._wakeups.append(wakeup)

    def remove(self, wakeup: Wakeable) -> None:
        """Undo one `add`; without a preceding `add` nothing happens."""
        with suppress(ValueError):
            self._wakeups.remove(wakeup)

    def notify(self) -> None:
        """Wake all threads."""
        for wakeup in tuple(self._wakeups):
            wakeup.wake()


class Arrivals:
    """Whether anything has arrived for a node's handles of one kind since none was ready.

    With it, an executor checks the handles of a kind only if something has arrived.

    Attributes:
        last: Stands for the latest arrival.
        seen: What had come last when an executor looked at all of them, and none was ready.
    """

    __slots__ = ("_wakeups", "last", "seen")

    def __init__(self, signal: Signal) -> None:
        self._wakeups = signal._wakeups
        self.last: object = None
        self.seen: object = None

    def note(self) -> None:
        """Wake those who wait for the node, after an item was put into a handle."""
        # A new object each time, because threads could lose a count: executors compare it with
        # `seen`.
        self.last = object()
        for wakeup in tuple(self._wakeups):
            wakeup.wake()


class Destroyable:
    """A handle, like those of rclpy's extension module.

    Within ``with handle:`` it is not destroyed, even if that is requested meanwhile; after
    `destroy_when_not_in_use`, ``with`` raises InvalidHandle.

    Attributes:
        signal: Woken when the entity may have become ready.
    """

    def __init__(self, signal: Signal | None = None) -> None:
        self.signal = Signal() if signal is None else signal
        # Changed without a lock: a signal handler, or a finalizer called by the garbage collector,
        # would wait for the lock forever if this thread held it.
        self._uses: list[None] = []
        self._is_ended = allocate_lock()  # acquired once, by the thread that destroys it
        self._unwanted = False

    def __enter__(self) -> Self:
        # before the check: the destroying thread checks in the opposite order
        self._uses.append(None)
        if self._unwanted:
            self._leave()
            self.refuse()
        return self

    def __exit__(self, exc_type: object, exc: object, traceback: object) -> None:
        self._leave()

    def _leave(self) -> None:
        self._uses.pop()
        if self._unwanted:
            self._destroy_if_unused()

    def _destroy_if_unused(self) -> None:
        if not self._uses and self._is_ended.acquire(blocking=False):
            self._destroy()

    def __del__(self) -> None:
        if not getattr(self, "_unwanted", True):
            self.destroy_when_not_in_use()

    def refuse(self) -> NoReturn:
        """Raise, because it is not to be used any more.

        Raises:
            InvalidHandle: always.
        """
        raise InvalidHandle("cannot use Destroyable because destruction was requested")

    @property
    def pointer(self) -> int:
        """A number that no other live handle has."""
        return id(self)

    @property
    def is_valid(self) -> bool:
        """Whether ``with handle:`` is possible."""
        return not self._unwanted

    def destroy_when_not_in_use(self) -> None:
        """Destroy it at the end of the last ``with``, or immediately; it may be called again."""
        if not self._unwanted:
            self._unwanted = True
            self._destroy_if_unused()

    def _destroy(self) -> None:
        """Release its resources."""

    def ready(self) -> bool:
        """Return whether an item can be taken, or work can be done, now."""
        return False
