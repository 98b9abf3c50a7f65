"""The bounded queue in front of every callback and every reader."""

from __future__ import annotations

import asyncio
from collections import deque
from typing import TYPE_CHECKING, Generic, TypeVar

from aionode.clock import perf_ns

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.endpoints.stats import CallbackStats

__all__ = ["MessageQueue"]

T = TypeVar("T")


class MessageQueue(Generic[T]):
    """Holds what has arrived and was not yet taken: ordered, bounded, counted.

    With KEEP_LAST a full inbox drops its oldest item, with KEEP_ALL it refuses the newest; both are
    counted in `stats.dropped`. Putting never waits and needs no running loop.

    Attributes:
        depth: How many items it holds at most.
        keep_all: Whether a full one refuses the newest item.
        stats: Where dropped items are counted.
        items: What is queued, with the `perf_ns` of their arrival, to be looked at only.
    """

    __slots__ = ("_readers", "_writers", "depth", "items", "keep_all", "stats")

    def __init__(self, depth: int, stats: CallbackStats, *, keep_all: bool = False) -> None:
        self.depth = depth
        self.keep_all = keep_all
        self.stats = stats
        self.items: deque[tuple[int, T]] = deque()
        self._readers: list[asyncio.Future[None]] = []
        self._writers: list[asyncio.Future[None]] = []

    def __len__(self) -> int:
        return len(self.items)

    def put(self, item: T) -> None:
        """Add `item`, and wake whoever waits for it."""
        queue = self.items
        if len(queue) >= self.depth:
            self.stats.dropped += 1
            if self.keep_all:
                return
            queue.popleft()
        queue.append((perf_ns(), item))
        if self._readers:
            _wake(self._readers)

    def pop(self) -> tuple[int, T]:
        """Take the oldest item, with the `perf_ns` of its arrival; IndexError when empty."""
        entry = self.items.popleft()
        if self._writers:
            _wake(self._writers)
        return entry

    def has_room(self) -> bool:
        """Whether an item can be added without losing one that should be kept."""
        return not self.keep_all or len(self.items) < self.depth

    async def wait(self) -> None:
        """Wait until there is an item, or until woken by `wake`. Cancelling loses nothing."""
        if not self.items:
            waiter = self.expect()
            try:
                await waiter
            finally:
                self.forget(waiter)

    def expect(self) -> asyncio.Future[None]:
        """Return a future that is done when the next item comes, or by `wake`."""
        waiter = asyncio.get_running_loop().create_future()
        self._readers.append(waiter)
        return waiter

    def forget(self, waiter: asyncio.Future[None]) -> None:
        """Note that nobody waits for what `expect` returned any more."""
        if waiter in self._readers:
            self._readers.remove(waiter)

    async def wait_for_room(self) -> None:
        """Wait until there is room, or until woken by `wake`."""
        if not self.has_room():
            waiter = asyncio.get_running_loop().create_future()
            self._writers.append(waiter)
            try:
                await waiter
            finally:
                if waiter in self._writers:
                    self._writers.remove(waiter)

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` soon after the next item was taken, or after `wake`."""
        waiter = asyncio.get_running_loop().create_future()
        waiter.add_done_callback(lambda _: callback())
        self._writers.append(waiter)

    def discard(self) -> list[T]:
        """Remove and count what was not taken, and return it."""
        unread = [item for _, item in self.items]
        self.stats.dropped += len(unread)
        self.items.clear()
        return unread

    def wake(self) -> None:
        """Wake everyone who waits, on either side: the entity is being destroyed."""
        _wake(self._readers)
        _wake(self._writers)


def _wake(waiters: list[asyncio.Future[None]]) -> None:
    for waiter in waiters:
        if not waiter.done():
            waiter.set_result(None)
    waiters.clear()
