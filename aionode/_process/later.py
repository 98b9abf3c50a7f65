"""One call that waits for its time."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Later"]


class Later:
    """A call that the running event loop makes in a while, unless it is cancelled before."""

    __slots__ = ("_timer",)

    def __init__(self) -> None:
        self._timer: asyncio.TimerHandle | None = None

    @property
    def waits(self) -> bool:
        """Whether there is such a call."""
        return self._timer is not None

    def call(self, delay_s: float, action: Callable[[], object]) -> None:
        """Call `action` in so many seconds, in place of what waits."""
        self.cancel()

        def run() -> None:
            self._timer = None
            action()

        self._timer = asyncio.get_running_loop().call_later(delay_s, run)

    def cancel(self) -> None:
        """Call nothing any more."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
