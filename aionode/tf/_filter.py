"""Messages that wait until their transform is available, like tf2's MessageFilter."""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from typing import TYPE_CHECKING, Any, Generic, TypeVar
from weakref import finalize, ref

from aionode._process.concurrency import checkpoint
from aionode.clock import perf_ns
from aionode.endpoints.subscription import reader_of, take_from
from aionode.tf.buffer_core import time_ns_of
from aionode.tf.frame_listing import seconds_text
from aionode.tf.waiters import Waiter

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.endpoints.subscription import Subscription
    from aionode.interfaces.geometry_msgs.msg import TransformStamped
    from aionode.tf._node_buffer_core import NodeBufferCore
    from aionode.tf._walk import Failure
    from aionode.tf.waiters import Waiters

__all__ = ["Filtered"]

MsgT = TypeVar("MsgT")

EMPTY = "the frame id of the message is empty"
FULL = "discarding message because the queue is full"
OLD = "the timestamp on the message is earlier than all the data in the transform cache"


class Filtered(Generic[MsgT]):
    """Iterates over pairs of a message and its transform; see `Buffer.filter`.

    Attributes:
        dropped: How many messages were dropped, by reason.
    """

    def __init__(
        self, buffer: NodeBufferCore, subscription: Subscription[MsgT], target: str, queue_size: int
    ) -> None:
        if queue_size < 1:
            raise ValueError(f"queue_size={queue_size}; it must be at least 1")
        self.dropped: Counter[str] = Counter()
        self._buffer = buffer
        self._subscription = subscription
        self._target = target
        self._queue_size = queue_size
        self._waiting: dict[Waiter, None] = {}  # oldest first
        self._ready: deque[tuple[MsgT, TransformStamped]] = deque()
        self._wake: asyncio.Future[None] | None = None
        self._turn_ends_ns = 0
        # An abandoned iterator leaves no waiters in the buffer.
        finalize(self, remove_all, buffer._BufferCore__waiters, self._waiting)

    @property
    def waiting(self) -> int:
        """The number of messages that wait for their transform."""
        return len(self._waiting)

    def __aiter__(self) -> AsyncIterator[tuple[MsgT, TransformStamped]]:
        """Iterate until the subscription is destroyed."""
        return self

    async def __anext__(self) -> tuple[MsgT, TransformStamped]:
        """Return the next message whose transform is available. Cancelling loses nothing."""
        subscription = self._subscription
        reader = reader_of(subscription)
        if perf_ns() >= self._turn_ends_ns:
            # If all messages are ready this never waits, so nothing else would run.
            await checkpoint()
            self._turn_ends_ns = perf_ns() + reader.slice_ns
        while True:
            while reader and not self._ready:
                self._take(take_from(subscription))
            if self._ready:
                return self._ready.popleft()
            if subscription.destroyed or self._buffer._BufferCore__entity.destroyed:
                raise StopAsyncIteration
            self._wake = asyncio.get_running_loop().create_future()
            await reader.wait(self._wake)

    def _take(self, msg: Any) -> None:
        """Make a message wait for its transform, if necessary."""
        header = msg.header
        source = header.frame_id.removeprefix("/")
        if not source:
            self._drop(msg, EMPTY)
            return
        if len(self._waiting) + len(self._ready) >= self._queue_size:
            self._drop_oldest()
        weak = ref(self)

        def end(failure: Failure | None) -> None:
            filtered = weak()
            if filtered is not None:
                filtered._end(waiter, msg, source, failure)

        waiter = Waiter(((self._target, source, time_ns_of(header.stamp)),), end)
        self._waiting[waiter] = None
        self._buffer._BufferCore__waiters.add(waiter)

    def _end(self, waiter: Waiter, msg: Any, source: str, failure: Failure | None) -> None:
        """Handle a message whose wait has ended."""
        self._waiting.pop(waiter, None)
        if failure is not None:
            self._drop(msg, OLD)
            return
        transform = self._buffer.lookup_transform_core(self._target, source, msg.header.stamp)
        self._ready.append((msg, transform))
        if self._wake is not None and not self._wake.done():
            self._wake.set_result(None)

    def _drop_oldest(self) -> None:
        if self._ready:
            msg, _ = self._ready.popleft()
            self._drop(msg, FULL)
            return
        waiter = next(iter(self._waiting))
        del self._waiting[waiter]
        self._buffer._BufferCore__waiters.remove(waiter)
        self._count(FULL, waiter.parts[0][1], waiter.parts[0][2])

    def _drop(self, msg: Any, reason: str) -> None:
        self._count(reason, msg.header.frame_id, time_ns_of(msg.header.stamp))

    def _count(self, reason: str, frame: str, time_ns: int) -> None:
        """Count a dropped message; the first one for each reason is logged."""
        self.dropped[reason] += 1
        if self.dropped[reason] == 1:
            topic = self._subscription.topic_name
            self._buffer._BufferCore__logger.warning(
                f"Message Filter dropping message: frame '{frame}' at time {seconds_text(time_ns)} "
                f"for reason '{reason}'; further ones of {topic} are only counted"
            )


def remove_all(waiters: Waiters, waiting: dict[Waiter, None]) -> None:
    """End the waits of an abandoned iterator."""
    for waiter in list(waiting):
        waiters.remove(waiter)
