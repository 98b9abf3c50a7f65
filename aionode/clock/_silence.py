"""Noticing that something has been silent for too long."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock._time_base import Alarm, TimeBase

__all__ = ["SilenceAlarm"]


class SilenceAlarm:
    """Tells how many whole periods have passed since the last sign, from the first sign on.

    A sign costs one reading of the clock: the alarm is set again only when it rings.

    Args:
        time_base: Whose steady clock counts.
        period_ns: The longest silence.
        on_silence: Called with the number of periods that are over since the last sign or call;
            returns whether to go on counting without another sign.
    """

    __slots__ = (
        "_alarm",
        "_on_silence",
        "_period_ns",
        "_runs",
        "_since_ns",
        "_steady_ns",
        "_time_base",
    )

    def __init__(
        self, time_base: TimeBase, period_ns: int, on_silence: Callable[[int], bool]
    ) -> None:
        self._time_base = time_base
        self._steady_ns = time_base.steady_ns
        self._period_ns = period_ns
        self._on_silence = on_silence
        self._since_ns: int | None = None  # the last sign, or the end of the last silent period
        self._alarm: Alarm | None = None
        self._runs = False

    def start(self) -> None:
        """Begin to ring: an event loop runs now. Signs count before that, too."""
        self._runs = True
        if self._alarm is None and self._since_ns is not None:
            self._set()

    def note(self) -> None:
        """Take a sign."""
        self._since_ns = self._steady_ns()
        if self._alarm is None and self._runs:
            self._set()

    def stop(self) -> None:
        """Ring no more."""
        self._runs = False
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def _set(self) -> None:
        assert self._since_ns is not None  # noqa: S101  # there was a sign
        self._alarm = self._time_base.call_at(self._since_ns + self._period_ns, self._ring)

    def _ring(self) -> None:
        # After a stall of the loop, what came in time may still wait to be read: that takes a turn
        # of the loop, and what it wakes another one.
        loop = asyncio.get_running_loop()
        loop.call_soon(loop.call_soon, self._judge)

    def _judge(self) -> None:
        if not self._runs or self._since_ns is None:
            return
        periods = (self._steady_ns() - self._since_ns) // self._period_ns
        if periods > 0:
            self._since_ns += periods * self._period_ns
            if not self._on_silence(periods):
                self._alarm = None  # until the next sign
                return
        self._set()
