"""Ending the process at a deadline, whatever it is waiting for."""

from __future__ import annotations

import _thread
import contextlib

from aionode._process.sudden_end import start_thread
from aionode.cli._support.exit import leave

__all__ = ["Deadline"]


class Deadline:
    """Ends the process at a given time, whatever it is waiting for.

    By then, the work is done and its output printed. Only Zenoh may still be waiting for a peer
    that is frozen or overloaded, and there is no reason to wait with it.

    Args:
        armed: Whether the process may be ended: only if it is the command, not another program.
    """

    def __init__(self, *, armed: bool) -> None:
        self._armed = armed
        # One lock per thread that waits for a deadline; releasing the lock ends that thread. A
        # signal handler may run `set` between two lines of `set` or `cancel` in the same thread, so
        # each step is a single C call that leaves no deadline out of the list.
        self._waiting: list[_thread.LockType] = []

    def set(self, seconds: float, status: int, text: str = "") -> None:
        """Exit with `status` in `seconds`, with `text` on stderr; replaces an earlier deadline.

        A signal handler may call it.
        """
        self.cancel()
        if not self._armed:
            return
        cancelled = _thread.allocate_lock()
        cancelled.acquire()
        self._waiting.append(cancelled)

        def wait() -> None:
            if not cancelled.acquire(timeout=seconds):
                leave(status, text)

        start_thread(wait)

    def cancel(self) -> None:
        """Remove the deadline."""
        with contextlib.suppress(IndexError):  # all removed, perhaps by a handler meanwhile
            while True:
                self._waiting.pop().release()
