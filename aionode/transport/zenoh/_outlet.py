"""The way of acknowledgements, assertions and cancellations out of the event loop."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.transport._send_thread import SendThread

__all__ = ["Outlet"]

LIMIT: Final = 10_000
"""Number of puts that wait for the thread; of each kind the newest count, so the oldest may be
lost."""


class Outlet:
    """Puts at once, or from a thread while Zenoh may stand still.

    Args:
        send_thread: The thread.
        limit_bytes: How many bytes wait for it at most.

    Attributes:
        is_crowded: Whether others have announced so much that Zenoh may stand still: it drops what
            a connection has announced in one piece, and no put goes on meanwhile.
    """

    def __init__(self, send_thread: SendThread, limit_bytes: int) -> None:
        self.is_crowded = False
        self._queue = send_thread.send_queue(LIMIT, limit_bytes, keep_all=False)

    def send(self, put: Callable[[], None], size_bytes: int) -> None:
        """Call `put`, which must not raise."""
        if self.is_crowded:
            self._queue.put(put, size_bytes)
        else:
            put()

    def clear(self) -> None:
        """Drop what waits."""
        self._queue.abandon()
