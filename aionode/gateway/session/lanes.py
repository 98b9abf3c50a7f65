"""The work of one client: each lane in order, and the lanes concurrently."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Hashable
from typing import Final

from aionode._process.concurrency import checkpoint
from aionode.errors import MessageError

__all__ = ["Lanes", "weight_of"]

MAX_WAITING: Final = 100
"""Number of ops in one lane that may wait."""

MAX_WEIGHT: Final = 8 << 20
"""Bytes that the waiting and running ops of a client may take; a single one may take more."""

PART_BYTES: Final = 64
"""Bytes that a JSON object or list takes besides its text, at least."""

PATIENCE_SEC: Final = 1.0
"""How long a frame waits for room; meanwhile its client is not read."""

MAX_TASKS: Final = 1000
"""Number of calls, goals and lanes of one client that may run; the policy also limits the first
two."""


class Lanes:
    """Runs the ops of one client: those of one lane in order, the lanes concurrently.

    A subscription that waits for the description of its type must not hold up a command.

    Args:
        tasks: The owner of the tasks.
    """

    def __init__(self, tasks: asyncio.TaskGroup) -> None:
        self._tasks = tasks
        self._lanes: dict[Hashable, deque[tuple[Callable[[], Awaitable[None]], int]]] = {}
        self._running: set[asyncio.Task[None]] = set()
        self._weight = self._next_weight = 0
        self._has_room = asyncio.Event()

    async def admit(self, frame: str | bytes) -> None:
        """Wait until there is room in memory for the ops of a frame, which are put or started next.

        Raises:
            MessageError: there is no room because earlier ops take long.
        """
        weight = weight_of(frame)
        try:
            async with asyncio.timeout(PATIENCE_SEC):
                while self._weight and self._weight + weight > MAX_WEIGHT:
                    self._has_room.clear()
                    await self._has_room.wait()
        except TimeoutError:
            problem = (
                f"its earlier ops take {self._weight} bytes; wait for them, or send smaller ones"
            )
            raise MessageError("client", problem) from None
        self._next_weight = weight

    def _taken_weight(self) -> int:
        """Assign the weight of the last frame to the first of its ops."""
        weight, self._next_weight = self._next_weight, 0
        self._weight += weight
        return weight

    def _release(self, weight: int) -> None:
        self._weight -= weight
        self._has_room.set()

    async def put(self, lane: Hashable, work: Callable[[], Awaitable[None]]) -> None:
        """Run `work` after the earlier work of the same lane.

        Raises:
            MessageError: too much work waits in the lane, or there are too many lanes.
        """
        waiting = self._lanes.get(lane)
        if waiting is not None and len(waiting) >= MAX_WAITING:
            await checkpoint()  # perhaps a single burst that no task has had a chance to work off
            waiting = self._lanes.get(lane)
        if waiting is None:
            if len(self._running) >= MAX_TASKS:
                await checkpoint()  # those of a burst may have nothing to wait for
            self._begin(lambda: self._run(lane))
            self._lanes[lane] = deque([(work, self._taken_weight())])
        elif len(waiting) < MAX_WAITING:
            waiting.append((work, self._taken_weight()))
        else:
            raise MessageError("client", f"{MAX_WAITING} ops wait for an earlier one; send fewer")

    def start(self, work: Callable[[], Awaitable[None]]) -> asyncio.Task[None]:
        """Run `work` concurrently with everything else; return its task.

        Raises:
            MessageError: too many tasks are running.
        """
        task = self._begin(work)
        weight = self._taken_weight()
        task.add_done_callback(lambda _: self._release(weight))
        return task

    def _begin(self, work: Callable[[], Awaitable[None]]) -> asyncio.Task[None]:
        if len(self._running) >= MAX_TASKS:
            raise MessageError("client", f"{MAX_TASKS} ops are in progress; wait for them to end")

        async def run() -> None:
            await work()

        task = self._tasks.create_task(run())
        self._running.add(task)
        task.add_done_callback(self._running.discard)
        return task

    def cancel(self) -> None:
        """Cancel all work: the client has gone."""
        for task in self._running:
            task.cancel()

    async def _run(self, lane: Hashable) -> None:
        waiting = self._lanes[lane]
        try:
            while waiting:
                work, weight = waiting[0]
                try:
                    await work()
                finally:
                    waiting.popleft()
                    self._release(weight)
                del work  # so that the values of its op are not kept while the lane waits
                await checkpoint()  # the work of many small ops in one burst
        finally:
            del self._lanes[lane]
            self._release(sum(weight for _, weight in waiting))


def weight_of(frame: str | bytes) -> int:
    """Estimate how many bytes the values in a frame take, if it is JSON."""
    if isinstance(frame, bytes):
        parts = frame.count(b"{") + frame.count(b"[")
    else:
        parts = frame.count("{") + frame.count("[")
    return len(frame) + PART_BYTES * parts
