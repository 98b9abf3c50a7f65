"""Handles that live as long as they are in use, and how threads learn that one is ready."""

from __future__ import annotations

from _thread import allocate_lock
from typing import TYPE_CHECKING, Protocol, Self

from aionode.rclpy._impl.errors import InvalidHandle

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType

__all__ = ["Arrivals", "Destroyable", "Signal", "Wakeup"]

LONGEST_WAIT_S = 3600.0
"""A lock cannot be waited for much longer than a month; who waits asks again then."""


class Wakeup:
    """Wakes one thread; a wake-up that comes before the wait is kept.

    A single C call on each side, which a signal handler may interrupt anywhere.

    Attributes:
        rouse: Wakes the thread if it waits for something else meanwhile.
        take: ``take(False)`` returns whether a wake-up has come, without waiting.
    """

    __slots__ = ("_lock", "rouse", "take")

    def __init__(self) -> None:
        self.rouse: Callable[[], None] | None = None
        self._lock = allocate_lock()
        self._lock.acquire()
        self.take: Callable[[bool], bool] = self._lock.acquire

    def wake(self) -> None:
        """Wake the thread that waits, or the next one that will."""
        try:
            self._lock.release()
        except RuntimeError:  # it is awake already
            return
        rouse = self.rouse
        if rouse is not None:
            rouse()

    def wait(self, timeout_sec: float | None) -> bool:
        """Wait for a wake-up; return whether one came within the limit. None waits for ever."""
        if timeout_sec is None:
            while not self._lock.acquire(timeout=LONGEST_WAIT_S):
                pass
            return True
        if timeout_sec <= 0:
            return self._lock.acquire(blocking=False)
        return self._lock.acquire(timeout=min(timeout_sec, LONGEST_WAIT_S))


class Wakeable(Protocol):
    """What a `Signal` wakes."""

    def wake(self) -> None:
        """Look again."""


class Signal:
    """Tells the threads that wait for an entity, or for any entity of a node, to look again."""

    __slots__ = ("_wakeups",)

    def __init__(self) -> None:
        # Replaced, never changed: it is read without a lock.
        self._wakeups: tuple[Wakeable, ...] = ()

    def add(self, wakeup: Wakeable) -> None:
        """Wake `wakeup` from now on, once more for each time it is added."""
        self._wakeups = (*self._wakeups, wakeup)

    def remove(self, wakeup: Wakeable) -> None:
        """Undo one `add`; without one nothing happens."""
        rest = list(self._wakeups)
        if wakeup in rest:
            rest.remove(wakeup)
            self._wakeups = tuple(rest)

    def notify(self) -> None:
        """Wake all."""
        for wakeup in self._wakeups:
            wakeup.wake()


class Arrivals:
    """Whether anything has come for a node's handles of one kind since none of them was ready.

    With it, an executor looks at the handles of those kinds only for which something has come.

    Attributes:
        last: Stands for what has come last.
        seen: What had come last when an executor looked at all of them, and none was ready.
    """

    __slots__ = ("_signal", "last", "seen")

    def __init__(self, signal: Signal) -> None:
        self._signal = signal
        self.last: object = None
        self.seen: object = None

    def note(self) -> None:
        """Wake those who wait for the node, after something was put into a handle."""
        # A new object each time, as threads would lose count: executors compare it with `seen`.
        self.last = object()
        for wakeup in self._signal._wakeups:
            wakeup.wake()


class Destroyable:
    """A handle, as rclpy's extension module has them.

    Inside ``with handle:`` it is not destroyed, however often that is asked for meanwhile; after
    `destroy_when_not_in_use`, ``with`` raises InvalidHandle.

    Attributes:
        signal: Woken when the entity may have become ready.
    """

    def __init__(self, signal: Signal | None = None) -> None:
        self.signal = Signal() if signal is None else signal
        self._use_lock = allocate_lock()
        self._uses = 0
        self._unwanted = False

    def __enter__(self) -> Self:
        with self._use_lock:
            if self._unwanted:
                raise InvalidHandle("cannot use Destroyable because destruction was requested")
            self._uses += 1
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        with self._use_lock:
            self._uses -= 1
            last = self._unwanted and not self._uses
        if last:
            self._destroy()

    def __del__(self) -> None:
        if not getattr(self, "_unwanted", True):
            self.destroy_when_not_in_use()

    @property
    def pointer(self) -> int:
        """A number that no other living handle has."""
        return id(self)

    @property
    def is_valid(self) -> bool:
        """Whether ``with handle:`` is possible."""
        return not self._unwanted

    def destroy_when_not_in_use(self) -> None:
        """Destroy it at the end of the last ``with``, or at once; again has no effect."""
        with self._use_lock:
            if self._unwanted:
                return
            self._unwanted = True
            unused = not self._uses
        if unused:
            self._destroy()

    def _destroy(self) -> None:
        """Release what it holds."""

    def ready(self) -> bool:
        """Return whether something can be taken, or done, now."""
        return False
