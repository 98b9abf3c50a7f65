"""Threads for sends that may block, so that the event loop never does."""

from __future__ import annotations

import asyncio
import atexit
import threading
import weakref
from collections import deque
from collections.abc import Callable
from queue import SimpleQueue
from typing import TYPE_CHECKING, Final

from aionode._process.concurrency import running_loop
from aionode.clock import perf_ns
from aionode.engine.transport.loop_waker import ThreadsafeQueue
from aionode.engine.transport.network import QUEUE_BYTES

if TYPE_CHECKING:
    from aionode.engine.transport.loop_waker import LoopWaker

__all__ = ["SendQueue", "SendThread", "start_thread"]


Job = Callable[[], None]

EXIT_S: Final = 1.0
"""How long the process waits at exit for threads that are sending, in seconds."""

INSIDE_S: Final = 2.0
"""How long it waits for other threads, in seconds. Closing a session may take a second on a busy
machine, and with a frozen peer far longer than anybody would wait."""

started: weakref.WeakSet[threading.Thread] = weakref.WeakSet()
"""The threads started by `start_thread`, for `end_all`."""


def start_thread(thread: threading.Thread) -> bool:
    """Start a thread that the process waits for at exit.

    Returns:
        False if the interpreter is shutting down: since Python 3.12, threads cannot be started
        then, although a loop in another thread may still be running.
    """
    try:
        thread.start()
    except RuntimeError:
        return False
    started.add(thread)
    return True


class Worker:
    """One thread and its jobs.

    Attributes:
        stopped: Whether waiting jobs are dropped.
        thread: A daemon, so Python does not wait for it at exit; `end_all` does for a while.
    """

    def __init__(self, name: str) -> None:
        self.stopped = False
        self._jobs: SimpleQueue[Job | None] = SimpleQueue()
        # One is written only by the loop and one only by the thread; the loop compares them.
        self._put = 0
        self._done = 0
        self.thread = threading.Thread(target=self._run, name=name, daemon=True)
        workers.add(self)
        self._started = start_thread(self.thread)

    @property
    def busy(self) -> bool:
        """Whether a job is waiting or running."""
        return self._put != self._done

    def submit(self, job: Job) -> None:
        """Run `job` after those before it; in the calling thread if no thread could be started."""
        if not self._started:
            job()
            return
        self._put += 1
        self._jobs.put(job)

    def submit_past_loop(self, job: Job) -> None:
        """Like `submit`, but from any thread; `busy` does not include this job."""

        def run() -> None:
            job()
            self._done -= (
                1  # only the loop counts submitted jobs, and only this thread finished ones
            )

        self._jobs.put(run)

    def end(self) -> None:
        """End the thread after its jobs."""
        self._jobs.put(None)

    def _run(self) -> None:
        while (job := self._jobs.get()) is not None:
            if not self.stopped:
                job()
            self._done += 1


workers: weakref.WeakSet[Worker] = weakref.WeakSet()


@atexit.register
def end_all() -> None:
    """End all threads: one inside Zenoh while the interpreter exits would abort the process."""
    running = [worker for worker in workers if worker.thread.is_alive()]
    for worker in running:
        worker.stopped = True
        worker.end()
    for worker in running:
        worker.thread.join(EXIT_S / len(running))
    # Python does not wait for threads started by a daemon thread, such as rclpy's.
    ends_ns = perf_ns() + int(INSIDE_S * 1e9)
    for thread in list(started):
        thread.join(max(0, ends_ns - perf_ns()) / 1e9)


class SendThread:
    """One thread that runs jobs in order, started by the first job.

    Args:
        name: Name of the thread.
        waker: Wakes the loop when a job is done that a coroutine is waiting for.
    """

    def __init__(self, name: str, waker: LoopWaker) -> None:
        self._name = name
        self._worker: Worker | None = None
        self._waker = waker

    @property
    def busy(self) -> bool:
        """Whether a job is waiting or running."""
        return self._worker is not None and self._worker.busy

    def submit(self, job: Job) -> None:
        """Run `job` after those before it. It must not raise."""
        if self._worker is None:
            self._worker = Worker(self._name)
        self._worker.submit(job)

    def send_queue(
        self,
        limit: int,
        limit_bytes: int = QUEUE_BYTES,
        *,
        keep_all: bool,
        lost: Callable[[int], None] | None = None,
    ) -> SendQueue:
        """Return a bounded queue that this thread empties."""
        return SendQueue(self, self._waker, limit, limit_bytes, keep_all=keep_all, lost=lost)

    def submit_past_loop(self, job: Job) -> None:
        """Run `job` after those before it, of which there must be one; from any thread."""
        worker = self._worker
        if worker is not None:
            worker.submit_past_loop(job)

    def close(self) -> None:
        """End the thread after its current jobs; does not wait."""
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.end()

    def abandon(self) -> None:
        """End the thread after its current job; does not wait."""
        if self._worker is not None:
            self._worker.stopped = True
        self.close()

    async def flush(self) -> None:
        """Wait until all jobs so far are done and the thread has ended; the next starts another.

        Cancelling only stops the wait: the thread still ends after its jobs.
        """
        worker = self._worker
        if worker is None:
            return
        ended = asyncio.Event()
        queue: ThreadsafeQueue[None] = ThreadsafeQueue(self._waker, lambda _: ended.set())
        worker.submit(lambda: queue.put(None))
        self.close()
        await ended.wait()


class SendQueue:
    """A bounded queue of sends, in order.

    Args:
        send_thread: The thread that sends.
        waker: Wakes the loop when everything was sent.
        limit: Maximum number of sends that wait.
        limit_bytes: Maximum total size of those that wait; the newest waits whatever its size.
        keep_all: Whether a full queue has no room, instead of dropping its oldest.
        lost: Called with the number of sends that were dropped.

    Attributes:
        dropped: Number of sends that were dropped.
        limit: Maximum number of sends that wait; it may be changed.
        sent: Number of sends that have left the queue.
    """

    def __init__(
        self,
        send_thread: SendThread,
        waker: LoopWaker,
        limit: int,
        limit_bytes: int,
        *,
        keep_all: bool,
        lost: Callable[[int], None] | None = None,
    ) -> None:
        self.dropped = 0
        self._send_thread = send_thread
        self.limit = limit
        self._keep_all = keep_all
        self._lost = lost
        self._limit_bytes = limit_bytes
        self._waiting: deque[tuple[int, Callable[[], None]]] = deque()
        # One is written only by the loop and one only by the thread; the loop compares them.
        self._put = self._put_bytes = 0
        self.sent = self._sent_bytes = 0
        self._drained: list[asyncio.Future[None]] = []
        self._queue: ThreadsafeQueue[None] = ThreadsafeQueue(waker, self._wake, limit=1)

    def __len__(self) -> int:
        return self._put - self.sent

    @property
    def _waiting_bytes(self) -> int:
        return self._put_bytes - self._sent_bytes

    def put(self, send: Callable[[], None], size_bytes: int = 0) -> None:
        """Queue a call of `send`; a full queue drops its oldest unless it is KEEP_ALL."""
        waiting = self._waiting
        dropped = 0
        while not self._keep_all and (
            len(waiting) >= self.limit or self._waiting_bytes + size_bytes > self._limit_bytes
        ):
            try:
                oldest_bytes, _ = waiting.popleft()
            except IndexError:  # the thread was faster, or is sending the only one
                break
            self._put_bytes -= oldest_bytes
            dropped += 1
        self._put_bytes += size_bytes
        waiting.append((size_bytes, send))
        if dropped:  # it takes over the job of a dropped one; the other jobs find less to do
            self._note_dropped(dropped)
        else:
            self._put += 1
            self._send_thread.submit(self._send)

    def _note_dropped(self, count: int) -> None:
        self.dropped += count
        if self._lost is not None:
            self._lost(count)

    def has_room(self) -> bool:
        """Whether another send can be added without dropping any."""
        return len(self) < self.limit and (
            not self._waiting or self._waiting_bytes < self._limit_bytes
        )

    async def drain(self) -> None:
        """Wait until everything was sent. Cancelling is safe."""
        while len(self):
            waiter = running_loop().create_future()
            self._drained.append(waiter)
            if len(self):  # the thread checks the list after counting, so one of both sees it
                await waiter
            else:
                self._wake(None)

    def abandon(self) -> None:
        """Drop waiting sends, and count them."""
        count = len(self._waiting)
        self._waiting.clear()
        self._put_bytes = self._sent_bytes
        if count:
            self._note_dropped(count)

    def _send(self) -> None:
        try:
            size_bytes, send = self._waiting.popleft()
        except IndexError:  # it was dropped or abandoned
            size_bytes, send = 0, None
        try:
            if send is not None:
                send()
        finally:
            self._sent_bytes += size_bytes
            self.sent += 1
            if self._drained and not len(self):
                self._queue.put(None)

    def _wake(self, _: None) -> None:
        waiters, self._drained = self._drained, []
        for waiter in waiters:
            if not waiter.done():
                waiter.set_result(None)
