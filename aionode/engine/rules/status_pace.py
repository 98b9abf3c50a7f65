"""Paces the status messages of an action server: fewer when there are many goals."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode._process.concurrency import running_loop

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

__all__ = ["StatusPace", "StatusSpacing"]

SPACING_S = 0.0001
"""The minimum interval between two status messages, in seconds per goal listed."""

UNSPACED = 10
"""Up to this many goals, every change is sent in the next iteration of the loop."""


class StatusSpacing:
    """The minimum interval between status messages, which grows with the number of goals.

    A status message lists every goal that is active or kept, so sending a long list after each
    change would cost more than the goals themselves. The interval counts real time, since sending
    the list takes real time whatever clock the node has.
    """

    def __init__(self) -> None:
        self._next_s = 0.0  # when the next message may be sent

    def wait_s(self, now_s: float) -> float:
        """Return how long the next message has to wait, in seconds; 0 for not at all."""
        return max(0.0, self._next_s - now_s)

    def note_sent(self, listed: int, now_s: float) -> None:
        """Record that a message listing this many goals was sent."""
        if listed > UNSPACED:
            self._next_s = now_s + listed * SPACING_S


class StatusPace:
    """Decides when the goal states are published after one of them has changed.

    All changes within one loop iteration go into one message. With many goals, there is also a
    minimum interval between messages, see `StatusSpacing`; the first change after a pause is sent
    immediately, and the last one is always sent.

    Args:
        send: Publishes the states.
        goals: The goals to list.
    """

    def __init__(self, send: Callable[[], None], goals: Collection[bytes]) -> None:
        self._send = send
        self._goals = goals
        self._spacing = StatusSpacing()  # of the loop's time
        self._due: asyncio.Handle | None = None

    def note_change(self) -> None:
        """Schedule the states to be sent soon."""
        if self._due is None:
            loop = running_loop()
            wait_s = self._spacing.wait_s(loop.time())
            if wait_s:
                self._due = loop.call_later(wait_s, self.flush)
            else:
                self._due = loop.call_soon(self.flush)

    def flush(self) -> None:
        """Send the states now, if any has changed since the last message."""
        if self._due is None:
            return
        self._due.cancel()
        self._due = None
        listed = len(self._goals)
        self._send()
        self._spacing.note_sent(listed, running_loop().time())
