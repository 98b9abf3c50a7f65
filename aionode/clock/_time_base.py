"""The source of time: the machine, or a test that advances it manually.

Everything in aionode that reads time or waits for it does so through a `TimeBase`, so that tests
can replace it.
"""

from __future__ import annotations

import asyncio
import os
import time
from abc import ABC, abstractmethod
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Protocol
from weakref import WeakKeyDictionary

from aionode._process.concurrency import SLICE_NS, running_loop

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock._timerfd import KernelAlarms

__all__ = [
    "Alarm",
    "MachineTime",
    "TimeBase",
    "perf_ns",
    "process_ns",
    "thread_ns",
    "thread_waited_ns",
]

perf_ns = time.perf_counter_ns  # for statistics only; not driven by a manual clock
thread_ns = time.thread_time_ns  # likewise; the CPU time of the current thread
process_ns = time.process_time_ns  # likewise; that of all threads


def thread_waited_ns() -> int | None:
    """Return how long the current thread was ready to run but had no processor.

    None where the system does not say: it needs Linux with scheduler statistics.
    """
    try:
        file = os.open("/proc/thread-self/schedstat", os.O_RDONLY)
        try:
            return int(os.read(file, 80).split()[1])
        finally:
            os.close(file)
    except (OSError, ValueError, IndexError):
        return None


# uvloop rounds waits to the nearest millisecond, so half of them end early; selector loops are
# early by at most the 1 ns they add for rounding. A remainder below SPIN_S is spent in iterations
# of the loop, a longer one in another sleep, which is too long for uvloop to round to zero.
SPIN_S = 50e-6
MIN_SLEEP_S = 1e-3


class Alarm(Protocol):
    """A callback that is called at a certain time."""

    def cancel(self) -> None:
        """Cancel the callback; calling it again has no effect."""


class TimeBase(ABC):
    """A source of time, and of callbacks at a certain time.

    Attributes:
        slice_ns: How long a queue is drained before others get a turn, by `perf_ns`; 0 for one item
            per turn, so that the order of callbacks does not depend on their speed.
    """

    slice_ns = SLICE_NS

    @abstractmethod
    def system_ns(self) -> int:
        """Return the nanoseconds since the epoch on the system clock, which may be set back."""

    @abstractmethod
    def steady_ns(self) -> int:
        """Return the nanoseconds of a monotonic clock."""

    def through_suspend(self) -> TimeBase:
        """Return a time base whose steady clock keeps running while the host is suspended.

        For limits that protect people: a machine that wakes up was silent meanwhile. Returns itself
        if the time is not the machine's.
        """
        return self

    @abstractmethod
    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule `callback` in the running loop for `steady_ns`, never earlier.

        For a time in the past it is called in one of the next iterations of the loop, never at
        once.
        """


class MachineTime(TimeBase):
    """The clocks of the machine: UTC, and a monotonic clock with an arbitrary zero."""

    # Python's own functions, since every message is stamped and a method would double the cost.
    system_ns = staticmethod(time.time_ns)
    steady_ns = staticmethod(time.monotonic_ns)

    def through_suspend(self) -> TimeBase:
        """Return the time base that uses CLOCK_BOOTTIME, if the system has it."""
        return BOOT_TIME

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule `callback` in the running loop for `steady_ns`.

        On Linux it does so within about 0.1 ms, elsewhere within 1 or 2 ms.
        """
        loop = running_loop()
        alarms = self._kernel_alarms(loop)
        if alarms is not None:
            with suppress(OSError):  # too many open files at the moment
                return alarms.add(steady_ns, callback)
        return LoopAlarm(loop, steady_ns, callback, self.steady_ns)

    def _kernel_alarms(self, loop: asyncio.AbstractEventLoop) -> KernelAlarms | None:
        return kernel_alarms(loop)


class BootTime(MachineTime):
    """The machine's clocks, with a steady clock that keeps running while the host is suspended."""

    # macOS has no CLOCK_BOOTTIME, and its clocks may differ on a suspended host.
    if hasattr(time, "CLOCK_BOOTTIME"):
        steady_ns = staticmethod(partial(time.clock_gettime_ns, time.CLOCK_BOOTTIME))

    def _kernel_alarms(self, loop: asyncio.AbstractEventLoop) -> KernelAlarms | None:
        return kernel_alarms(loop, through_suspend=True)


BOOT_TIME = BootTime()

KERNEL_ALARMS: WeakKeyDictionary[asyncio.AbstractEventLoop, dict[bool, KernelAlarms | None]] = (
    WeakKeyDictionary()
)


def kernel_alarms(
    loop: asyncio.AbstractEventLoop, *, through_suspend: bool = False
) -> KernelAlarms | None:
    """Return the kernel's alarms for `loop`, or None if they are not available."""
    try:
        return KERNEL_ALARMS[loop][through_suspend]
    except KeyError:
        pass
    from aionode.clock._timerfd import CLOCK_BOOTTIME, KernelAlarms  # with the first alarm

    try:
        alarms = KernelAlarms(loop, CLOCK_BOOTTIME) if through_suspend else KernelAlarms(loop)
    except (OSError, NotImplementedError):
        alarms = None
    KERNEL_ALARMS.setdefault(loop, {})[through_suspend] = alarms
    return alarms


class LoopAlarm:
    """A timer of the event loop that sleeps again if the loop wakes it early."""

    __slots__ = ("_callback", "_handle", "_loop", "_now_ns", "_when_ns")

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        when_ns: int,
        callback: Callable[[], None],
        now_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self._loop = loop
        self._when_ns = when_ns
        self._callback = callback
        self._now_ns = now_ns
        delay_s = max(0.0, (when_ns - now_ns()) / 1e9)
        self._handle: asyncio.TimerHandle = loop.call_later(delay_s, self._check)

    def _check(self) -> None:
        left_ns = self._when_ns - self._now_ns()
        if left_ns <= 0:
            self._callback()
            return
        left_s = left_ns / 1e9
        delay_s = left_s if left_s <= SPIN_S else max(left_s, MIN_SLEEP_S)
        self._handle = self._loop.call_later(delay_s, self._check)

    def cancel(self) -> None:
        """Cancel the callback; calling it again has no effect."""
        self._handle.cancel()
