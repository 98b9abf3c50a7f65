"""Pending callbacks, earliest first: a heap that drops cancelled entries."""

from __future__ import annotations

from collections import deque
from heapq import heapify, heappop, heappush
from itertools import count
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Entry", "TimerHeap"]

SMALL = 64  # below this many cancelled entries, removal is not worth it


class Entry:
    """One pending callback."""

    __slots__ = ("callback", "heap")

    def __init__(self, heap: TimerHeap, callback: Callable[[], None]) -> None:
        self.heap: TimerHeap | None = heap  # None once removed from the heap
        self.callback: Callable[[], None] | None = callback

    def cancel(self) -> None:
        """Cancel the callback; calling it again has no effect."""
        if self.callback is not None:
            self.callback = None
            if self.heap is not None:
                self.heap.note_cancelled()


class TimerHeap:
    """Pending callbacks: earliest first, and in order of arrival for equal times."""

    __slots__ = ("_cancelled", "_heap", "_order")

    def __init__(self) -> None:
        self._heap: list[tuple[int, int, Entry]] = []
        self._order = count()
        self._cancelled = 0

    def __len__(self) -> int:
        return len(self._heap) - self._cancelled

    def add(self, when_ns: int, callback: Callable[[], None]) -> Entry:
        """Schedule `callback` for the first `fire()` at or after `when_ns`."""
        entry = Entry(self, callback)
        heappush(self._heap, (when_ns, next(self._order), entry))
        return entry

    def first_ns(self) -> int | None:
        """Return the time of the earliest callback, or None if there is none."""
        heap = self._heap
        while heap:
            if heap[0][2].callback is not None:
                return heap[0][0]
            heappop(heap)
            self._cancelled -= 1
        return None

    def fire(self, now_ns: int) -> None:
        """Call all callbacks due at `now_ns`; entries added meanwhile wait for the next call.

        An exception in a callback propagates; the remaining ones are called next time.
        """
        heap = self._heap
        due: deque[Entry] = deque()
        while heap and heap[0][0] <= now_ns:
            entry = heappop(heap)[2]
            entry.heap = None
            if entry.callback is None:
                self._cancelled -= 1
            else:
                due.append(entry)
        try:
            while due:
                entry = due.popleft()
                callback = entry.callback
                if callback is not None:  # an earlier callback may have cancelled it
                    entry.callback = None
                    callback()
        finally:
            for entry in due:
                entry.heap = self
                heappush(self._heap, (now_ns, next(self._order), entry))

    def note_cancelled(self) -> None:
        """Count a cancelled entry; remove all of them when they are the majority."""
        self._cancelled += 1
        if self._cancelled > SMALL and self._cancelled * 2 > len(self._heap):
            self._heap = [item for item in self._heap if item[2].callback is not None]
            heapify(self._heap)
            self._cancelled = 0
