"""The work of one client: each lane in order, and the lanes side by side."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Hashable
from typing import Final

from aionode._process.concurrency import checkpoint
from aionode.errors import MessageError

__all__ = ["Lanes"]

MOST_WAITING: Final = 100
"""Ops of one lane that may wait."""

MOST_TASKS: Final = 1000
"""Calls, goals and lanes of one client that may run; the policy limits the first two, too."""


class Lanes:
    """Runs the ops of one client: those of one lane in order, lanes side by side.

    A subscription that waits for the description of its type must not hold up a command.

    Args:
        tasks: The owner of the tasks.
    """

    def __init__(self, tasks: asyncio.TaskGroup) -> None:
        self._tasks = tasks
        self._lanes: dict[Hashable, deque[Callable[[], Awaitable[None]]]] = {}
        self._running: set[asyncio.Task[None]] = set()

    async def put(self, lane: Hashable, work: Callable[[], Awaitable[None]]) -> None:
        """Run `work` after the earlier work of the same lane.

        Raises:
            MessageError: too much waits in the lane, or there are too many lanes.
        """
        waiting = self._lanes.get(lane)
        if waiting is not None and len(waiting) >= MOST_WAITING:
            await checkpoint()  # one burst, perhaps, that no task has had a turn to work off
            waiting = self._lanes.get(lane)
        if waiting is None:
            if len(self._running) >= MOST_TASKS:
                await checkpoint()  # those of a burst may have nothing to wait for
            self.start(lambda: self._run(lane))
            self._lanes[lane] = deque([work])
        elif len(waiting) < MOST_WAITING:
            waiting.append(work)
        else:
            raise MessageError("client", f"{MOST_WAITING} ops wait for an earlier one; send fewer")

    def start(self, work: Callable[[], Awaitable[None]]) -> asyncio.Task[None]:
        """Run `work` beside everything else; return its task.

        Raises:
            MessageError: too many tasks are running.
        """
        if len(self._running) >= MOST_TASKS:
            raise MessageError("client", f"{MOST_TASKS} ops are under way; wait for their ends")

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
                await waiting[0]()
                waiting.popleft()
                await checkpoint()  # the work of many small ops in one burst
        finally:
            del self._lanes[lane]
