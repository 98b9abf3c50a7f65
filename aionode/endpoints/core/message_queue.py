"""The bounded queue in front of every callback and every reader."""

from __future__ import annotations

import asyncio
from collections import deque
from typing import TYPE_CHECKING, Final, Generic, TypeVar

from aionode._process.concurrency import SLICE_NS, checkpoint
from aionode.clock import perf_ns
from aionode.endpoints.core.inline_call import InlineCall

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from aionode.endpoints.stats import CallbackStats

__all__ = ["UNWEIGHED", "MessageQueue"]

T = TypeVar("T")

UNWEIGHED: Final = 2
"""Bytes are counted only from this many queued items on; a queue that keeps up has fewer."""

UNLIMITED_BYTES: Final = 1 << 62


class MessageQueue(InlineCall, Generic[T]):
    """A bounded FIFO queue.

    With KEEP_LAST a full queue drops its oldest items, with KEEP_ALL it refuses the newest; both
    are counted in `stats.dropped`. Putting never waits and needs no running loop. A queue is full
    when it reaches its depth or its limit of bytes; a single item always fits.

    Items may also bypass it: while `consume` waits, `take_inline` handles an item within the event
    that brought it, and what is queued is handled by a call of the loop (`take_turn`). Waking the
    consumer instead takes a step of a task, which is much of the cost of a message. Order is
    preserved: once an item is queued or the consumer has been woken, nothing bypasses the queue,
    and the consumer finishes what an inline callback left over before it takes the next item. This
    is part of the queue rather than a separate object because every subscription has a queue.

    Attributes:
        depth: Maximum number of items.
        keep_all: Whether it refuses the newest item when full.
        stats: Where dropped items are counted.
        slice_ns: How long `consume` goes on before others get a turn; from the time base.
        limit_bytes: Maximum total size of the items, if they are weighed.
        weighed_from: Number of items from which on `make_room` decides whether one more fits.
        own_from: The same for messages of this process, of which a busy program makes many: the
            depth, if the last weighed message is so small that a full queue stays within the limit.
        items: The queued items, with the `perf_ns` of their arrival. Read-only, except that a
            subscription which drops expired messages replaces it with a deque that does so.
    """

    __slots__ = (
        "_bytes",
        "_call_soon",
        "_handle",
        "_inline_waiter",
        "_on_heavy",
        "_readers",
        "_size_of",
        "_sizes",
        "_writers",
        "depth",
        "items",
        "keep_all",
        "limit_bytes",
        "own_from",
        "slice_ns",
        "stats",
        "weighed_from",
    )

    def __init__(
        self,
        depth: int,
        stats: CallbackStats,
        *,
        keep_all: bool = False,
        slice_ns: int = SLICE_NS,
    ) -> None:
        super().__init__()
        self.depth = depth
        self.keep_all = keep_all
        self.stats = stats
        self.slice_ns = slice_ns
        self.items: deque[tuple[int, T]] = deque()
        # The sizes of the newest items, as many as were weighed, and their sum. Removals are
        # accounted for when the next item is weighed, so that taking items costs nothing.
        self._sizes: deque[int] = deque()
        self._bytes = 0
        self._size_of: Callable[[T], int] | None = None
        self._on_heavy: Callable[[], None] | None = None
        self.limit_bytes = UNLIMITED_BYTES
        self.weighed_from = self.own_from = depth
        # Waiters for an item and for room; emptied when they are woken.
        self._readers: list[asyncio.Future[None]] = []
        self._writers: list[asyncio.Future[None]] = []
        # `consume` waits for this waiter while inline calls handle items. It is None while the
        # consumer is not waiting, while a turn is planned, and during an inline callback.
        self._inline_waiter: asyncio.Future[None] | None = None
        # Set by `consume`: what handles items inline, and `call_soon` of the loop.
        self._handle: Callable[[int, T], Coroutine[object, object, None] | None]
        self._call_soon: Callable[..., asyncio.Handle]

    def __len__(self) -> int:
        return len(self.items)

    def weigh(
        self,
        size_of: Callable[[T], int],
        limit_bytes: int,
        on_heavy: Callable[[], None],
        unweighed: int = UNWEIGHED,
    ) -> None:
        """Limit the total size of the items as well.

        Args:
            size_of: Returns the approximate size of an item in bytes.
            limit_bytes: The limit.
            on_heavy: Called when the limit is first reached.
            unweighed: How many items are queued before bytes are counted.
        """
        self._size_of = size_of
        self._on_heavy = on_heavy
        self.limit_bytes = limit_bytes
        self.weighed_from = min(self.depth, unweighed)

    def put(self, item: T, *, is_own: bool = False) -> bool:
        """Add `item`, wake the readers, and return whether it was added.

        Args:
            item: The item.
            is_own: Whether this process has made it: the first such item that has to wait is
                weighed, and later ones from `own_from` items on.
        """
        queue = self.items
        count = len(queue)
        if (
            count >= self.weighed_from
            and (not is_own or count >= self.own_from or count == self.weighed_from)
            and not self.make_room(item)
        ):
            return False
        queue.append((perf_ns(), item))
        if self._readers:
            self.wake_readers()
        elif self._inline_waiter is not None:
            self._plan_turn(self._inline_waiter)
        return True

    def make_room(self, item: T) -> bool:
        """Drop and count the oldest items until one more fits; return whether it does."""
        queue, sizes = self.items, self._sizes
        count = len(queue)
        if self._size_of is None:
            size_bytes = 0
        else:
            size_bytes = self._size_of(item)
            while len(sizes) > count:  # `_weight` written out
                self._bytes -= sizes.popleft()
        while count and (count >= self.depth or self._bytes + size_bytes > self.limit_bytes):
            self.stats.dropped += 1
            if count < self.depth and self._on_heavy is not None:
                heavy, self._on_heavy = self._on_heavy, None
                heavy()
            if self.keep_all:
                return False
            queue.popleft()
            count -= 1
            self._weight()
        if self._size_of is not None:
            sizes.append(size_bytes)
            self._bytes += size_bytes
            if size_bytes * self.depth > self.limit_bytes:
                self.own_from = self.weighed_from
            elif count == self.weighed_from:
                self.own_from = self.depth
        return True

    def _weight(self) -> int:
        """Return the total size of the weighed items that are still queued."""
        sizes, count = self._sizes, len(self.items)
        while len(sizes) > count:
            self._bytes -= sizes.popleft()
        return self._bytes

    def pop(self) -> tuple[int, T]:
        """Pop the oldest item, with the `perf_ns` of its arrival; IndexError if empty."""
        entry = self.items.popleft()
        if self._writers:
            _wake(self._writers)
        return entry

    def has_room(self) -> bool:
        """Return whether an item can be added without dropping one that must be kept."""
        return not self.keep_all or (
            len(self.items) < self.depth and (not self.items or self._weight() < self.limit_bytes)
        )

    @property
    def waiting(self) -> int:
        """The number of queued items."""
        return len(self.items)

    async def wait(self, waiter: asyncio.Future[None] | None = None) -> None:
        """Wait for an item, or for `wake`. Cancelling loses nothing.

        Args:
            waiter: A future that ends the wait when done; an item or `wake` sets it.
        """
        if not self.items:
            waiter = waiter or asyncio.get_running_loop().create_future()
            self._readers.append(waiter)
            try:
                await waiter
            finally:
                if waiter in self._readers:
                    self._readers.remove(waiter)

    async def wait_for_room(self) -> None:
        """Wait for room, or for `wake`."""
        if not self.has_room():
            waiter = asyncio.get_running_loop().create_future()
            self._writers.append(waiter)
            try:
                await waiter
            finally:
                if waiter in self._writers:
                    self._writers.remove(waiter)

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` soon after the next item is taken, or after `wake`."""
        waiter = asyncio.get_running_loop().create_future()
        waiter.add_done_callback(lambda _: callback())
        self._writers.append(waiter)

    def discard(self) -> list[T]:
        """Remove, count and return the remaining items."""
        unread = [item for _, item in self.items]
        self.stats.dropped += len(unread)
        self.items.clear()
        return unread

    def wake_readers(self) -> None:
        """Wake tasks that wait for an item."""
        for waiter in self._readers:
            if not waiter.done():
                waiter.set_result(None)
        self._readers.clear()

    def wake_writers(self) -> None:
        """Wake tasks that wait for room, as some items were dropped."""
        _wake(self._writers)

    def wake(self) -> None:
        """Wake all readers and writers: the entity is being destroyed."""
        self.wake_readers()
        _wake(self._writers)

    # Its consumer

    async def consume(
        self,
        handle: Callable[[int, T], Coroutine[object, object, None] | None],
        *,
        inline: bool = False,
    ) -> None:
        """Pass each item to `handle`, one at a time, until cancelled.

        Args:
            handle: Runs what can run at once, and returns the rest to await, if any.
            inline: Whether it may be called outside the consumer's task while that waits.

        Raises:
            BaseException: what `handle` raised.
        """
        if inline:
            self.prepare()
            self._handle = handle
            self._call_soon = asyncio.get_running_loop().call_soon
        while True:
            if not self.items:
                rest = await self._wait_for_rest(inline=inline)
                if rest is not None:
                    await rest
            now_ns = perf_ns()
            turn_ends_ns = now_ns + self.slice_ns
            while self.items:
                rest = self.handle_items(handle, now_ns, turn_ends_ns)
                if rest is not None:
                    await rest
                if self.items and (now_ns := perf_ns()) >= turn_ends_ns:
                    await checkpoint()
                    now_ns = perf_ns()
                    turn_ends_ns = now_ns + self.slice_ns

    def handle_items(
        self,
        handle: Callable[[int, T], Coroutine[object, object, None] | None],
        now_ns: int,  # noqa: ARG002  # for subclasses
        turn_ends_ns: int,  # noqa: ARG002  # for subclasses
    ) -> Coroutine[object, object, None] | None:
        """Pass the oldest item to `handle`, and return its result.

        A subclass may continue with further items while there is nothing to await, from `now_ns`
        until `turn_ends_ns` on the clock of `perf_ns`.

        Raises:
            BaseException: what `handle` raised.
        """
        return handle(*self.pop())

    async def _wait_for_rest(self, *, inline: bool) -> Coroutine[object, object, None] | None:
        """Wait for an item; return what an inline call left over to await, or raise its error."""
        waiter = asyncio.get_running_loop().create_future()
        if inline:
            self._inline_waiter = waiter
        if not (inline and self.slice_ns):
            # Where a test steps the clock, callbacks belong to a task: see `SteppedLoop`.
            self._readers.append(waiter)
        try:
            await waiter
        except asyncio.CancelledError:
            self.abandon()
            if self._error is None:
                raise
        finally:
            self._inline_waiter = None
            if waiter in self._readers:
                self._readers.remove(waiter)
        return self.take_rest()

    # Without its consumer

    def take_inline(self, item: T, inline_deadline_ns: int) -> bool:
        """Handle `item` now if possible before `inline_deadline_ns`; otherwise return False."""
        waiter = self._inline_waiter
        if waiter is None or waiter.done():
            return False
        now_ns = perf_ns()
        if now_ns >= inline_deadline_ns:
            return False
        self._inline_waiter = None
        try:
            self.context.run(self.run, self._handle, now_ns, item)
        finally:
            self._wait_on(waiter)
        return True

    def hand_over(self, item: T) -> None:
        """Handle `item` now if possible; otherwise queue it."""
        if not self.take_inline(item, perf_ns() + self.slice_ns):
            self.put(item)

    def _plan_turn(self, waiter: asyncio.Future[None]) -> None:
        """Handle the queue in the loop's next iteration, in which its consumer would wake up."""
        self._inline_waiter = None
        self._call_soon(self.take_turn, waiter, context=self.context)

    def take_turn(self, waiter: asyncio.Future[None]) -> None:
        """Handle the queued items while the consumer waits for `waiter`, for at most a slice.

        `run` and `_wait_on` are written out: calls that each message would pay for.
        """
        if waiter.done():
            return  # the consumer was cancelled
        now_ns = perf_ns()
        turn_ends_ns = now_ns + self.slice_ns
        try:
            while self.items:
                self._rest = self.handle_items(self._handle, now_ns, turn_ends_ns)
                if self._rest is not None:
                    break
                if self.items and (now_ns := perf_ns()) >= turn_ends_ns:
                    break
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # noqa: BLE001  # raised by the task, as if it had called
            self._error = error
        finally:
            if self.items or self._rest is not None or self._error is not None:
                self._wait_on(waiter)
            else:
                self._inline_waiter = waiter

    def _wait_on(self, waiter: asyncio.Future[None]) -> None:
        """Wake the consumer if an inline callback left something over; otherwise let it wait on.

        The callback itself may have cancelled it, or have queued an item.
        """
        if (self._rest is not None or self._error is not None) and not waiter.done():
            waiter.set_result(None)
        self._inline_waiter = waiter
        if self.items and not waiter.done():
            self._plan_turn(waiter)


def _wake(waiters: list[asyncio.Future[None]]) -> None:
    for waiter in waiters:
        if not waiter.done():
            waiter.set_result(None)
    waiters.clear()
