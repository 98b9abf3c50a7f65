"""Queues from other threads to the event loop, with one wake-up per burst.

A thread appends to a `ThreadsafeQueue` and wakes the loop, unless that was already done. The loop
then empties all queues in turn, a slice at a time, so that timers and other callbacks run in
between. This handles bursts several times as fast as one `call_soon_threadsafe` per item, because a
wake-up is a system call and most items need none.

Zenoh's threads are not started by Python, which creates a thread state for each of their calls and
frees it at the end. Mapping and unmapping its memory costs several times as much as handling the
item. So the state of such a thread is kept from its first item on.
"""

from __future__ import annotations

import ctypes
import os
import threading
from collections import deque
from typing import TYPE_CHECKING, ClassVar, Final, Generic, TypeVar

from aionode._process.concurrency import SLICE_NS
from aionode.clock import perf_ns

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Iterator

__all__ = ["LoopWaker", "MessageArrivals", "ThreadsafeQueue"]

T = TypeVar("T")


SLICE_ITEMS = 32
"""Number of items handled from one queue before it is the next queue's turn."""

UNMEASURED: Final = 8
"""Number of messages that may wait whatever their size."""

KEPT_LIMIT: Final = 64
"""Number of Zenoh threads whose thread state is kept. The receiving threads are few, and live as
long as the process; others might come and go."""


class ThreadState(threading.local):
    """Python's state of the calling thread.

    Attributes:
        is_known: Whether `keep` was called; false for a new state.
    """

    kept: ClassVar[int] = 0  # in all threads
    is_known = False

    def keep(self) -> None:
        """Keep the state until the process ends, unless Python started the thread."""
        self.is_known = True
        ident = threading.get_ident()
        if ThreadState.kept < KEPT_LIMIT and all(t.ident != ident for t in threading.enumerate()):
            ThreadState.kept += 1
            # One call more than there will be of PyGILState_Release, which would free it after the
            # last.
            ctypes.pythonapi.PyGILState_Ensure()


thread_state = ThreadState()


class LoopWaker:
    """Wakes one event loop when a queue has an item.

    Attributes:
        inline_deadline_ns: The `perf_ns` time until which handlers may run callbacks; 0 while no
            queue is being emptied. See `Reader.deliver`.
    """

    def __init__(self) -> None:
        self.inline_deadline_ns = 0
        self._ready: deque[ThreadsafeQueue[object]] = deque()
        # Whether the loop will check the queues by itself. Set by the thread that wakes it, cleared
        # by the loop before its last check: a later item wakes it again, so none is missed.
        self._armed = True
        self._lock = threading.Lock()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._event_fd: int | None = None

    def open(self, loop: asyncio.AbstractEventLoop) -> None:
        """Start waking `loop`, the running one; waiting items are handled soon."""
        self._loop = loop
        if hasattr(os, "eventfd"):
            fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
            loop.add_reader(fd, self._on_event, fd)
            self._event_fd = fd
        self._armed = True
        loop.call_soon(self._empty)

    def close(self) -> None:
        """Stop waking the loop. Items that arrive meanwhile wait for the next `open`."""
        with self._lock:  # a thread may be about to write: never to a reused descriptor
            self._armed = True
            loop, self._loop = self._loop, None
            fd, self._event_fd = self._event_fd, None
        if fd is not None:
            if loop is not None and not loop.is_closed():
                loop.remove_reader(fd)
            os.close(fd)

    def ready(self, queue: ThreadsafeQueue[object]) -> None:
        """Schedule `queue`, which has an item. Any thread may call it."""
        self._ready.append(queue)
        if not thread_state.is_known:
            thread_state.keep()
        if not self._armed:
            self._armed = True
            self._wake()

    def again(self, queue: ThreadsafeQueue[object]) -> None:
        """Reschedule `queue`, which has more items. Only called by `take`, on the loop."""
        self._ready.append(queue)

    def _wake(self) -> None:
        with self._lock:
            if self._event_fd is not None:
                os.eventfd_write(self._event_fd, 1)
            elif self._loop is not None and not self._loop.is_closed():
                # The loop wakes itself through a pair of sockets.
                self._loop.call_soon_threadsafe(self._empty)

    def _on_event(self, fd: int) -> None:
        try:
            os.eventfd_read(fd)
        except BlockingIOError:  # an earlier iteration consumed the event
            return
        self._empty()

    def _empty(self) -> None:
        """Empty the queues in turn, until all are empty or the time slice is over."""
        if self._loop is None:
            return
        ready = self._ready
        ends_ns = self.inline_deadline_ns = perf_ns() + SLICE_NS
        try:
            if ready:
                ready.popleft().take()
            while ready and perf_ns() < ends_ns:
                ready.popleft().take()
        finally:
            self.inline_deadline_ns = 0
            self._armed = False
            if ready:
                self._armed = True
                self._loop.call_soon(self._empty)


class ThreadsafeQueue(Generic[T]):
    """A queue from one source in other threads to `handle` on the loop.

    Args:
        waker: Wakes the loop.
        handle: Called on the loop with each item, in order. Must not raise.
        limit: Maximum number of items that wait; further ones push out the oldest. None means no
            limit, for sources that limit themselves.
    """

    __slots__ = ("_handle", "_items", "_queued", "_waker")

    def __init__(
        self, waker: LoopWaker, handle: Callable[[T], None], limit: int | None = None
    ) -> None:
        self._waker = waker
        self._handle = handle
        self._items: deque[T] = deque(maxlen=limit)
        self._queued = False

    def __len__(self) -> int:
        return len(self._items)

    def put(self, item: T) -> None:
        """Add `item`. Any thread may call it; never waits."""
        self._items.append(item)
        if not self._queued:
            self._queued = True
            self._waker.ready(self)  # type: ignore[arg-type]  # it only calls take()

    def take(self) -> None:
        """Handle some of the items, on the loop."""
        self._queued = False  # before the check, so that a later item schedules it again
        items = self._items
        left = min(len(items), SLICE_ITEMS)
        try:
            while left and items:  # the handler may clear the queue
                left -= 1
                self._handle(items.popleft())
        finally:
            if items and not self._queued:
                self._queued = True
                self._waker.again(self)  # type: ignore[arg-type]  # as above

    def take_all(self) -> None:
        """Handle all items that are waiting now, on the loop."""
        items = self._items
        for _ in range(len(items)):
            if items:  # the handler may clear the queue
                self._handle(items.popleft())

    def take_out(self) -> Iterator[T]:
        """Yield all items without handling them."""
        while self._items:
            yield self._items.popleft()

    def clear(self) -> None:
        """Drop all items."""
        self._items.clear()


ARRIVALS: Final = threading.Lock()
"""Held briefly by threads that add to the measured part of any `MessageArrivals`, and by the loop
taking from it. One lock is enough: it is only used where messages wait."""


class MessageArrivals(ThreadsafeQueue[T]):
    """A queue of messages that is also bounded in bytes, as a message may have any size.

    Asking Zenoh for the size of a message costs as much as passing it on. So the first few are not
    measured, and as long as the loop keeps up, no others wait.

    Args:
        waker: Wakes the loop.
        handle: Called on the loop with each item, in order. Must not raise.
        limit: Maximum number of items that wait; further ones push out the oldest.
        limit_bytes: Maximum size of the measured items in bytes; the newest one stays even if it is
            larger.
        size_of: Returns the size of an item in bytes; called in any thread.
        on_dropped: Called on the loop with the number of items that were pushed out for their size.
    """

    __slots__ = (
        "_bytes",
        "_dropped",
        "_late",
        "_limit",
        "_limit_bytes",
        "_on_dropped",
        "_size_of",
    )

    def __init__(
        self,
        waker: LoopWaker,
        handle: Callable[[T], None],
        limit: int,
        limit_bytes: int,
        size_of: Callable[[T], int],
        on_dropped: Callable[[int], None],
    ) -> None:
        super().__init__(waker, handle, limit)
        self._limit = limit
        self._limit_bytes = limit_bytes
        self._size_of = size_of
        self._on_dropped = on_dropped
        # Items after the first few, with their sizes. Senders' threads add to it and the loop takes
        # from it, both holding the lock. While it holds something, no sender bypasses it, so the
        # items of one sender, which all come from one thread, stay in order. Most queues never need
        # it.
        self._late: deque[tuple[int, T]] | tuple[()] = ()
        self._bytes = 0
        self._dropped = 0

    def __len__(self) -> int:
        return len(self._items) + len(self._late)

    def put(self, item: T) -> None:
        """Add `item`. Any thread may call it; never waits."""
        if len(self._items) < UNMEASURED and not self._late:
            self._items.append(item)
        else:
            self._put_late(item)
        if not self._queued:
            self._queued = True
            self._waker.ready(self)  # type: ignore[arg-type]  # it only calls take()

    def _put_late(self, item: T) -> None:
        size = self._size_of(item)
        with ARRIVALS:
            late = self._late = self._late or deque()
            late.append((size, item))
            self._bytes += size
            while len(late) > 1 and (self._bytes > self._limit_bytes or len(late) > self._limit):
                self._dropped += self._bytes > self._limit_bytes
                self._bytes -= late.popleft()[0]

    def take(self) -> None:
        """Handle some of the items, on the loop."""
        if self._late and not self._items:
            self._measure_no_more()
        super().take()
        if self._late and not self._queued:
            self._queued = True
            self._waker.again(self)  # type: ignore[arg-type]  # it only calls take()
        if self._dropped:
            with ARRIVALS:
                dropped, self._dropped = self._dropped, 0
            self._on_dropped(dropped)

    def _measure_no_more(self) -> None:
        """Move some items to the queue from which they are handled."""
        with ARRIVALS:
            late = self._late
            for _ in range(min(len(late), SLICE_ITEMS)):
                size, item = late.popleft()  # type: ignore[union-attr]  # it has some
                self._bytes -= size
                self._items.append(item)

    def take_all(self) -> None:
        """Handle all items that are waiting now, on the loop."""
        for _ in range(1 + len(self._late) // SLICE_ITEMS):
            super().take_all()
            self._measure_no_more()
        super().take_all()

    def clear(self) -> None:
        """Drop all items."""
        super().clear()
        with ARRIVALS:
            self._late = ()
            self._bytes = 0
