"""Waits for transforms, and the events that justify another lookup.

A wait for a time in the future depends on one frame: the one whose data ends too early. The lookup
is repeated when that frame has data for the time, or when a frame on the path is new or has another
parent. So even transforms at 1 kHz cost waiters next to nothing.
"""

from __future__ import annotations

from heapq import heapify, heappop, heappush
from itertools import count
from typing import TYPE_CHECKING

from aionode.errors import ForwardExtrapolationException, NoDataForExtrapolationException
from aionode.tf._walk import Failure, latest_common_ns, walk

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.tf._frames import Frame, Tree

__all__ = ["Part", "Waiter", "Waiters", "problem_of"]

Part = tuple[str, str, int]
"""A target frame, a source frame, and a time in nanoseconds."""


def problem_of(tree: Tree, parts: Iterable[Part]) -> tuple[Failure | None, list[str]]:
    """Return why a transform is not available, and the frames on which this depends.

    Args:
        tree: The frames.
        parts: The lookups; a transform between two times has two.
    """
    for target, source, time_ns in parts:
        way = walk(tree, target, source, time_ns)
        if way.failure is not None:
            return way.failure, way.visited
    return None, []


class Waiter:
    """One wait for a transform.

    Args:
        parts: What is awaited.
        on_end: Called once, with None when the transform is available, or with the reason why it
            never will be.
    """

    __slots__ = ("frames", "on_end", "parts", "waits")

    def __init__(self, parts: tuple[Part, ...], on_end: Callable[[Failure | None], None]) -> None:
        self.parts = parts
        self.on_end = on_end
        self.waits = False
        self.frames: list[str] = []  # the frames where it is registered


class Waiters:
    """All waits of one buffer.

    Args:
        tree: The frames.
        cache_ns: How long transforms are kept, in nanoseconds.
    """

    def __init__(self, tree: Tree, cache_ns: int) -> None:
        self._tree = tree
        self._cache_ns = cache_ns
        # By frame: waiters affected by a new place in the tree, and those affected by any data.
        self._by_frame: dict[str, dict[Waiter, None]] = {}
        self._any_data: dict[str, dict[Waiter, None]] = {}
        # By frame: the times for which data is awaited, with a number as a tie-breaker.
        self._due: dict[str, list[tuple[int, int, Waiter]]] = {}
        self._numbers = count()

    def add(self, waiter: Waiter) -> None:
        """Register a wait, or end it at once if there is nothing to wait for."""
        waiter.waits = True
        failure, frames = problem_of(self._tree, waiter.parts)
        if failure is None or self._is_hopeless(waiter):
            waiter.waits = False
            waiter.on_end(failure)
            return
        waiter.frames = list(dict.fromkeys(frames))
        for frame in waiter.frames:
            self._by_frame.setdefault(frame, {})[waiter] = None
        wanted_ns = self._wanted_ns(waiter, failure)
        if wanted_ns:
            entry = wanted_ns, next(self._numbers), waiter
            heappush(self._due.setdefault(failure.frame, []), entry)
        else:
            for frame in waiter.frames:
                self._any_data.setdefault(frame, {})[waiter] = None

    def _wanted_ns(self, waiter: Waiter, failure: Failure) -> int:
        """Return the time up to which a frame needs data; 0 if that alone would not help."""
        if failure.error not in {ForwardExtrapolationException, NoDataForExtrapolationException}:
            return 0
        times = {time_ns for _, _, time_ns in waiter.parts}
        if len(times) > 1:
            return 0  # the failure does not say which of them
        time_ns = times.pop()
        return time_ns if time_ns > self._tree[failure.frame].newest_ns else 0

    def _is_hopeless(self, waiter: Waiter) -> bool:
        """Return whether the time is older than the histories, by tf2's rule."""
        for target, source, time_ns in waiter.parts:
            if time_ns and target != source:
                latest = latest_common_ns(self._tree, target, source)
                if isinstance(latest, int) and 0 < time_ns + self._cache_ns < latest:
                    return True
        return False

    def remove(self, waiter: Waiter) -> None:
        """End a wait without an answer; no effect if it has ended."""
        waiter.waits = False
        for frame in waiter.frames:
            for index in (self._by_frame, self._any_data):
                members = index.get(frame)
                if members is not None:
                    members.pop(waiter, None)
                    if not members:
                        del index[frame]
            due = self._due.get(frame)
            if due and len(due) > 2 * len(self._by_frame.get(frame, ())) + 16:
                self._due[frame] = [entry for entry in due if entry[2].waits]
                heapify(self._due[frame])
        waiter.frames = []

    def changed(self, name: str, frame: Frame, before: tuple[int, str] | None) -> None:
        """Check again the waiters affected by a frame's new transform.

        Args:
            name: The name of the frame.
            frame: Its data.
            before: Its newest stamp and parent before; None if it had none.
        """
        if not self._by_frame:
            return
        latest = frame.latest()
        if before is None or latest is None or before[1] != latest[1]:
            self._ask(list(self._by_frame.get(name, ())))
            return
        due = self._due.get(name)
        if due:
            concerned = []
            while due and (not due[0][2].waits or due[0][0] <= latest[0]):
                waiter = heappop(due)[2]
                if waiter.waits:
                    concerned.append(waiter)
            if not due:
                del self._due[name]
            self._ask(concerned)
        if name in self._any_data:
            self._ask(list(self._any_data[name]))

    def ask_all(self) -> None:
        """Check all waiters again, as everything may have changed."""
        every = {waiter for members in self._by_frame.values() for waiter in members}
        self._ask(list(every))

    def _ask(self, waiters: list[Waiter]) -> None:
        for waiter in waiters:
            if waiter.waits:
                self.remove(waiter)
                self.add(waiter)
