"""Alarms that are at most 0.1 ms late, using kernel timers (Linux).

Event loops have millisecond resolution: uvloop is up to 1 ms late, and asyncio up to 2 ms, as it
rounds up before `epoll` rounds up again, so a 1 kHz timer would lose ticks. A `timerfd` is a file
that becomes readable at a time given in nanoseconds, and loops wait for files without rounding.
"""

from __future__ import annotations

import asyncio
import errno
import os
import sys
import time
import weakref
from functools import cache
from typing import TYPE_CHECKING, Any

from aionode._process.concurrency import running_loop
from aionode.clock.timer_heap import TimerHeap

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock.timer_heap import Entry

__all__ = ["KernelAlarms", "PeriodicAlarm"]

# From <time.h> and <sys/timerfd.h>.
CLOCK_REALTIME = 0
CLOCK_MONOTONIC = 1
CLOCK_BOOTTIME = 7
TFD_TIMER_ABSTIME = 1
TFD_TIMER_CANCEL_ON_SET = 2


class KernelAlarms(TimerHeap):
    """The alarms of one event loop, all on one `timerfd`.

    The file is open only while an alarm is pending, so that no open file is left behind.

    Args:
        loop: The event loop.
        clock: The kernel clock that they use.

    Raises:
        OSError: The system has no `timerfd`, or the process has too many open files.
        NotImplementedError: The loop cannot wait for files.
    """

    __slots__ = ("__weakref__", "_clock", "_fd", "_loop", "_set_ns", "_spec")

    def __init__(self, loop: asyncio.AbstractEventLoop, clock: int = CLOCK_MONOTONIC) -> None:
        super().__init__()
        self._clock = clock
        self._loop = weakref.ref(loop)  # weak, as the registry of loops holds this object
        self._fd = -1
        self._set_ns = 0  # time when the file becomes readable; 0 for never
        self._spec = itimerspec()
        self._open(loop)

    def add(self, when_ns: int, callback: Callable[[], None]) -> Entry:
        """Call `callback` when the steady clock reaches `when_ns`."""
        loop = self._loop()
        if self._fd < 0 and loop is not None:
            self._open(loop)
        entry = super().add(when_ns, callback)
        self._set_for(when_ns)
        return entry

    def note_cancelled(self) -> None:
        """Close the file after the last alarm was cancelled."""
        super().note_cancelled()
        if not len(self):
            self._close_soon()

    def _open(self, loop: asyncio.AbstractEventLoop) -> None:
        fd = open_timer(self._clock)
        try:
            loop.add_reader(fd, self._expired)
        except BaseException:
            os.close(fd)
            raise
        self._fd = fd
        self._set_ns = 0

    def _set_for(self, when_ns: int) -> None:
        if not 0 < self._set_ns <= when_ns:
            self._set_ns = max(when_ns, 1)  # 0 would disarm it
            set_timer(self._fd, self._set_ns, self._spec)

    def _expired(self) -> None:
        """Call due callbacks, as the file became readable."""
        try:
            os.read(self._fd, 8)  # a counter, which must be read to rearm the file
        except BlockingIOError:
            return  # rescheduled to an earlier time just as it expired; it expires again
        self._set_ns = 0
        try:
            self.fire(time.clock_gettime_ns(self._clock))
        finally:
            next_ns = self.first_ns()
            if next_ns is None:
                self._close_soon()
            else:
                self._set_for(next_ns)

    def _close_soon(self) -> None:
        """Close the file in the next iteration, unless a callback of this one sets an alarm."""
        loop = self._loop()
        if loop is None or loop.is_closed():
            self._close()
        else:
            loop.call_soon(self._close_if_idle, loop)

    def _close_if_idle(self, loop: asyncio.AbstractEventLoop) -> None:
        if self._fd >= 0 and not len(self):
            loop.remove_reader(self._fd)
            self._close()

    def _close(self) -> None:
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    __del__ = _close  # for a loop that is closed while an alarm is pending


MAX_PERIODIC = 64
"""Maximum number of alarms with their own kernel timer, and thus an open file."""


class PeriodicAlarm:
    """An alarm that repeats without being rescheduled, with its own `timerfd`.

    See `Clock.call_every`. It fires once more whenever the system clock is set.

    Raises:
        OSError: The system has no `timerfd`, or the process has too many open files.
        NotImplementedError: The loop cannot wait for files.
    """

    __slots__ = ("_callback", "_fd", "_loop", "_process")

    count = 0

    def __init__(
        self, when_ns: int, period_ns: int, callback: Callable[[], None], *, system: bool
    ) -> None:
        self._fd = -1
        if PeriodicAlarm.count >= MAX_PERIODIC:
            raise OSError(errno.EMFILE, "the others share one file")
        self._loop = running_loop()
        self._process = os.getpid()
        self._callback = callback
        # On the system clock itself, as its offset from the steady clock keeps changing.
        fd = open_timer(CLOCK_REALTIME if system else CLOCK_MONOTONIC)
        try:
            spec = itimerspec()
            spec[0], spec[1] = divmod(period_ns, 1_000_000_000)
            set_timer(fd, max(when_ns, 1), spec, TFD_TIMER_CANCEL_ON_SET if system else 0)
            self._loop.add_reader(fd, self._expired)
        except BaseException:
            os.close(fd)
            raise
        self._fd = fd
        PeriodicAlarm.count += 1

    def _expired(self) -> None:
        try:
            os.read(self._fd, 8)  # a counter, which must be read to rearm the file
        except BlockingIOError:
            return
        except OSError as error:
            if error.errno != errno.ECANCELED:  # the system clock was set
                raise
        self._callback()

    def cancel(self) -> None:
        """Cancel the alarm; calling it again has no effect."""
        fd, self._fd = self._fd, -1
        if fd >= 0:
            PeriodicAlarm.count -= 1
            # A forked child shares the parent's `epoll` and would silence its timers.
            if not self._loop.is_closed() and self._process == os.getpid():
                self._loop.remove_reader(fd)
            os.close(fd)

    __del__ = cancel  # for a loop that is closed while an alarm is pending


@cache
def libc() -> Any:
    """Return the C library, as Python has these functions only from 3.13 on."""
    if sys.platform != "linux" or sys.maxsize < 2**32:
        raise OSError(errno.ENOSYS, "timerfd: only used on 64-bit Linux")
    import ctypes

    return ctypes.CDLL(None, use_errno=True)


def open_timer(clock: int = CLOCK_MONOTONIC) -> int:
    """Create a `timerfd`, and return its file descriptor."""
    fd: int = libc().timerfd_create(clock, os.O_NONBLOCK | os.O_CLOEXEC)
    if fd < 0:
        import ctypes

        raise OSError(ctypes.get_errno(), "timerfd_create failed")
    return fd


def itimerspec() -> Any:
    """Return a ``struct itimerspec`` of zeros: an interval and a time, in s and ns each."""
    import ctypes

    return (ctypes.c_long * 4)()


def set_timer(fd: int, when_ns: int, spec: Any, flags: int = 0) -> None:
    """Make `fd` readable when its clock reaches `when_ns`, then after each interval of `spec`."""
    spec[2], spec[3] = divmod(when_ns, 1_000_000_000)
    libc().timerfd_settime(fd, TFD_TIMER_ABSTIME | flags, spec, None)
