"""The CPU time of a thread, to tell what a blocked loop did with its wall time."""

from __future__ import annotations

import threading

from aionode.clock import perf_ns, thread_ns, thread_waited_ns

__all__ = ["ThreadTime"]

INTERVAL_NS = 5_000_000
"""Maximum age of a reading: it costs a microsecond, too much for each callback."""

WAITS_INTERVAL_NS = 50_000_000
"""Maximum age of the reading of how long the thread has waited, which comes from a file."""


class ThreadTime:
    """Measures how long the thread of an event loop ran since shortly before a callback.

    The time is read after a callback, never before it, so that no message waits for the reading.
    Between the reading and the next callback the loop mostly sleeps, which takes no thread time;
    whatever else it runs counts as well, so a wait in the callback right after may go unnoticed.

    Attributes:
        due_ns: The `perf_ns` time from which the next reading is due; checked by the callers, since
            a call per callback would cost as much as it saves.
    """

    __slots__ = ("_read_ns", "_thread", "_waited_ns", "_waits_due_ns", "due_ns")

    def __init__(self) -> None:
        self._thread = 0
        self._waits_due_ns = 0
        self.read(perf_ns())

    def read(self, now_ns: int) -> None:
        """Read the time of the current thread at the `perf_ns` time `now_ns`."""
        thread = threading.get_ident()
        if now_ns >= self._waits_due_ns or thread != self._thread:
            self._waited_ns = thread_waited_ns()
            self._waits_due_ns = now_ns + WAITS_INTERVAL_NS
        self._thread = thread
        self._read_ns = thread_ns()
        self.due_ns = now_ns + INTERVAL_NS

    def waited_ns(self) -> int | None:
        """Return how long the current thread was ready without a processor since the last reading.

        That was a twentieth of a second ago at most. None if the system does not say, or the
        reading was taken in another thread.
        """
        before_ns = self._waited_ns
        if before_ns is None or threading.get_ident() != self._thread:
            return None
        now_ns = self._waited_ns = thread_waited_ns()
        return None if now_ns is None else now_ns - before_ns

    def ran_ns(self) -> int | None:
        """Return how long the current thread ran since the reading, in nanoseconds.

        None if the reading was taken in another thread, where the node was created.
        """
        if threading.get_ident() != self._thread:
            return None
        return thread_ns() - self._read_ns
