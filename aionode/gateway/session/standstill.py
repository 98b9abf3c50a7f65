"""Detects standstills of the event loop: data that it reads afterwards was sent long before."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from aionode.clock import S_TO_NS

if TYPE_CHECKING:
    from aionode.clock import Alarm, TimeBase

__all__ = ["Standstills"]

LOOK_NS: Final = S_TO_NS // 10
"""The time between two checks of the clock, in nanoseconds."""

LATE_NS: Final = 3 * S_TO_NS // 20
"""A check later than this shows that the loop was stalled, in nanoseconds."""

LONG_NS: Final = S_TO_NS
"""From this length on, a standstill invalidates one-time requests such as calls and goals; commands
are repeated, and so may be refused after any standstill."""

READ_NS: Final = S_TO_NS // 5
"""Time after a standstill by which everything sent meanwhile has been read: connections made during
it are accepted first, which takes some loop iterations."""


class Standstills:
    """Detects standstills of the loop: a callback that blocks it, SIGSTOP, a suspended host.

    The kernel buffers what clients send meanwhile, and it is then read as if it had just arrived. A
    check by an alarm comes too late for data read in the same iteration, so readers check as well.

    Args:
        time_base: The source of time.

    Attributes:
        until_ns: Data read until then may be old, in nanoseconds of the steady clock.
        long_until_ns: The same for the last long standstill.
    """

    def __init__(self, time_base: TimeBase) -> None:
        self.until_ns = self.long_until_ns = -1
        self._time_base = time_base
        self._clock = time_base.through_suspend()
        self._on_standstill: Callable[[bool], None] | None = None
        self._looked_ns = 0
        self._ended_ns: int | None = None
        self._alarm: Alarm | None = None

    def watch(self, on_standstill: Callable[[bool], None]) -> None:
        """Check from now on, and call a function after each standstill with whether it was long."""
        self._on_standstill = on_standstill
        self._looked_ns = self._clock.steady_ns()
        self._ring()

    def stop(self) -> None:
        """Stop checking."""
        self._on_standstill = None
        if self._alarm is not None:
            self._alarm.cancel()

    def look(self) -> None:
        """Record a loop iteration; after too long without one, everything read now may be old."""
        if self._on_standstill is None:
            return
        now_ns = self._clock.steady_ns()
        late_ns = now_ns - self._looked_ns - LOOK_NS
        self._looked_ns = now_ns
        if late_ns > LATE_NS:
            self._ended_ns = now_ns
            self.until_ns = self._time_base.steady_ns() + READ_NS
            is_long = late_ns >= LONG_NS
            if is_long:
                self.long_until_ns = self.until_ns
            self._on_standstill(is_long)

    def since_sec(self) -> float:
        """Return how long ago the last standstill ended, in seconds."""
        if self._ended_ns is None:
            return math.inf
        return (self._clock.steady_ns() - self._ended_ns) / S_TO_NS

    def _ring(self) -> None:
        self.look()
        if self._on_standstill is not None:
            due_ns = self._time_base.steady_ns() + LOOK_NS
            self._alarm = self._time_base.call_at(due_ns, self._ring)
