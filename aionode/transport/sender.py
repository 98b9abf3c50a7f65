"""Sending what may block, from a thread, so that the event loop never does."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable
from queue import SimpleQueue
from typing import TYPE_CHECKING

from aionode.transport.wakeup import Lane

if TYPE_CHECKING:
    from aionode.transport.wakeup import Wakeup

__all__ = ["Outlet", "Sender"]


Job = Callable[[], None]


class Sender:
    """One thread that runs jobs in order. It is started by the first job.

    Args:
        name: Name of the thread.
        wakeup: Wakes the loop when a job is done that somebody waits for.
    """

    def __init__(self, name: str, wakeup: Wakeup) -> None:
        self._name = name
        self._jobs: SimpleQueue[Job | None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._wakeup = wakeup

    def submit(self, job: Job) -> None:
        """Run `job` after those before it. It must not raise."""
        if self._thread is None:
            self._jobs = SimpleQueue()  # an earlier thread may still be busy with its own
            self._thread = threading.Thread(
                target=run, args=(self._jobs,), name=self._name, daemon=True
            )
            self._thread.start()
        self._jobs.put(job)

    def outlet(self, limit: int, *, keep_all: bool) -> Outlet:
        """Return a bounded queue that this thread empties."""
        return Outlet(self, self._wakeup, limit, keep_all=keep_all)

    def close(self) -> None:
        """Let the thread end after the jobs that it has; returns at once."""
        if self._thread is not None:
            self._thread = None
            self._jobs.put(None)

    async def flush(self) -> None:
        """Wait until the jobs so far are done and the thread has ended; the next starts another.

        Cancelling stops the wait only: the thread still ends after its jobs.
        """
        if self._thread is None:
            return
        ended = asyncio.Event()
        lane: Lane[None] = Lane(self._wakeup, lambda _: ended.set())
        self._thread = None
        self._jobs.put(lambda: lane.put(None))
        self._jobs.put(None)
        await ended.wait()


def run(jobs: SimpleQueue[Job | None]) -> None:
    """Run jobs until there is None."""
    while (job := jobs.get()) is not None:
        job()


class Outlet:
    """A bounded queue of sends, in order.

    Args:
        sender: The thread that sends.
        wakeup: Wakes the loop when everything was sent.
        limit: How many sends wait at most.
        keep_all: Whether a full queue has no room, or else drops its oldest.

    Attributes:
        dropped: How many sends were dropped.
    """

    def __init__(self, sender: Sender, wakeup: Wakeup, limit: int, *, keep_all: bool) -> None:
        self.dropped = 0
        self._sender = sender
        self._limit = limit
        self._keep_all = keep_all
        self._waiting: deque[Callable[[], None]] = deque()
        # Written by the loop only and by the thread only; the loop compares them.
        self._put = 0
        self._sent = 0
        self._drained: list[asyncio.Future[None]] = []
        self._lane: Lane[None] = Lane(wakeup, self._wake, limit=1)

    def __len__(self) -> int:
        return self._put - self._sent

    def put(self, send: Callable[[], None]) -> None:
        """Have `send` called in the thread; a full queue drops its oldest unless it keeps all."""
        if not self._keep_all and len(self._waiting) >= self._limit:
            try:
                self._waiting.popleft()
            except IndexError:  # the thread was faster
                pass
            else:
                self.dropped += 1
                self._waiting.append(send)  # and takes the place, and the job, of the oldest
                return
        self._put += 1
        self._waiting.append(send)
        self._sender.submit(self._send)

    def has_room(self) -> bool:
        """Whether one more can be put without dropping any."""
        return len(self) < self._limit

    async def drain(self) -> None:
        """Wait until everything was sent. Cancelling is safe."""
        while len(self):
            waiter = asyncio.get_running_loop().create_future()
            self._drained.append(waiter)
            if len(self):  # the thread looks at the list after it counts, so one of both sees it
                await waiter
            else:
                self._wake(None)

    def _send(self) -> None:
        try:
            self._waiting.popleft()()
        finally:
            self._sent += 1
            if self._drained and not len(self):
                self._lane.put(None)

    def _wake(self, _: None) -> None:
        waiters, self._drained = self._drained, []
        for waiter in waiters:
            if not waiter.done():
                waiter.set_result(None)
