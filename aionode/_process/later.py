"""Delayed calls that can be cancelled: a single one, or any number together."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode._process.concurrency import running_loop

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["DelayedCalls", "Later"]


class Later:
    """A delayed call in the running event loop, which can be replaced or cancelled."""

    __slots__ = ("_timer",)

    def __init__(self) -> None:
        self._timer: asyncio.TimerHandle | None = None

    @property
    def waits(self) -> bool:
        """Whether a call is pending."""
        return self._timer is not None

    def call(self, delay_s: float, action: Callable[[], object]) -> None:
        """Call `action` after a delay, instead of a pending call."""
        self.cancel()

        def run() -> None:
            self._timer = None
            action()

        self._timer = running_loop().call_later(delay_s, run)

    def cancel(self) -> None:
        """Cancel the pending call, if any."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


class DelayedCalls:
    """Delayed calls in the running event loop that are cancelled together."""

    __slots__ = ("_timers",)

    def __init__(self) -> None:
        self._timers: set[asyncio.TimerHandle] = set()  # until they have run

    def add(self, delay_s: float, action: Callable[[], object]) -> None:
        """Call `action` after a delay, unless `cancel` is called first."""

        def run() -> None:
            self._timers.discard(timer)
            action()

        timer = running_loop().call_later(delay_s, run)
        self._timers.add(timer)

    def cancel(self) -> None:
        """Cancel all pending calls."""
        for timer in self._timers:
            timer.cancel()
        self._timers.clear()
