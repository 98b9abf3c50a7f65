"""What the ops of one client of rosbridge share: the way back to the client, and tasks in order."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Hashable
from typing import TYPE_CHECKING, Any, Final

from aionode._concurrency import checkpoint
from aionode.errors import MessageError
from aionode.gateway._rosbridge_frames import Fragmented, op_frame

if TYPE_CHECKING:
    from aionode.gateway._session import Session

__all__ = ["Lanes", "Link"]

LEVELS: Final = ("none", "error", "warning", "info")

MOST_WAITING: Final = 100
"""Most ops of one lane that wait."""

MOST_TASKS: Final = 1000
"""Most calls, goals and lanes of one client at a time; the policy limits the first two, too."""


class Link:
    """The way to one client.

    Args:
        session: The session of the client.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self._level = 0

    def set_level(self, level: str) -> None:
        """Send statuses up to a level from now on, which clients can read that ask for it.

        Raises:
            MessageError: there is no such level.
        """
        if level not in LEVELS:
            raise MessageError("set_level.level", f"{level!r}, needs one of {', '.join(LEVELS)}")
        self._level = LEVELS.index(level)

    def send(self, op: dict[str, Any], fragment_size: float = 0) -> None:
        """Send an op, in fragments if it is longer than a size that the client has asked for."""
        frame = op_frame({key: value for key, value in op.items() if value is not None})
        if fragment_size:
            frame = Fragmented.of(frame, max(int(fragment_size), 1), str(op.get("id", "")))
        self.session.outbox.send(frame)

    def status(self, level: str, text: str, op: dict[str, Any] | None = None) -> None:
        """Tell the client what became of an op, if it has asked for statuses of this level."""
        if LEVELS.index(level) > self._level:
            return
        message_id = None if op is None else op.get("id")
        if not isinstance(message_id, str):
            message_id = None
        self.send({"op": "status", "level": level, "msg": text, "id": message_id})


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
        """Run `work` after what was put into the same lane before.

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
        """Cancel what is running: the client has gone."""
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
