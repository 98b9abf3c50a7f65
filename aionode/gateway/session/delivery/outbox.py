"""The frames waiting for one client: a bounded queue per topic, which slows down nobody else."""

from __future__ import annotations

import asyncio
from collections import defaultdict, deque
from collections.abc import AsyncIterator, Callable, Hashable, Sequence
from typing import Final, TypeAlias

__all__ = ["Frame", "LongFrame", "Outbox", "binary_frame"]


class LongFrame:
    """A long frame in pieces: joining them would take time, and twice the memory.

    Attributes:
        pieces: Its parts; text in UTF-8.
        is_text: Whether it is text.
    """

    __slots__ = ("_size", "is_text", "pieces")

    def __init__(self, pieces: Sequence[bytes | memoryview], *, is_text: bool) -> None:
        self.pieces = tuple(pieces)
        self.is_text = is_text
        self._size = sum(map(len, self.pieces))

    def __len__(self) -> int:
        return self._size

    def __bytes__(self) -> bytes:
        return b"".join(self.pieces)

    def __str__(self) -> str:
        return bytes(self).decode()


Frame: TypeAlias = bytes | str | LongFrame
"""A WebSocket frame, or a chunk of an HTTP response."""

LONG_BYTES: Final = 256 << 10
"""Size from which a frame made of pieces is kept in pieces."""


def binary_frame(head: bytes, data: bytes | memoryview) -> bytes | LongFrame:
    """Return a frame of a header and data, which must not change; long data are not copied."""
    if len(data) > LONG_BYTES:
        return LongFrame((head, data), is_text=False)
    return b"".join((head, data))


MAX_ANSWERS: Final = 1000
"""Number of answers that may wait: a client that reads none of them is disconnected."""


def ignore(*_: object) -> None:
    """Do nothing."""


class Outbox:
    """The frames that wait for one client, and the order in which they are sent.

    Answers are sent first. Topics take turns, and each keeps its newest frames: the oldest are
    dropped and counted.

    Args:
        max_bytes: The most bytes that may wait. Beyond that, the topic with the most waiting bytes
            loses its oldest frames.

    Attributes:
        dropped: Number of frames dropped, by key.
        sent: Number of frames sent.
        overflowed: Whether it was closed because the client reads no answers.
        direct: Sends a frame at once if possible, and returns whether it did: while nothing waits,
            a frame need not go through the writing task. None if that is not possible.
        on_drop: Called with the key of each frame that is dropped, unless only the newest was
            wanted.
        on_overflow: Called when it is closed because the client reads no answers.
    """

    def __init__(self, max_bytes: int = 64 << 20) -> None:
        self.dropped: dict[Hashable, int] = defaultdict(int)
        self.sent = 0
        self.overflowed = False
        self.direct: Callable[[Frame], bool] | None = None
        self.on_drop: Callable[[Hashable], object] = ignore
        self.on_overflow: Callable[[], object] = ignore
        self._max_bytes = max_bytes
        self._bytes = 0
        self._answers: deque[Frame] = deque()
        self._answer_bytes = 0
        self._queues: dict[Hashable, deque[Frame]] = {}
        self._key_bytes: dict[Hashable, int] = defaultdict(int)
        self._turns: deque[Hashable] = deque()  # each key that has frames, once
        self._filled = asyncio.Event()
        self._closed = False
        self._is_leaving = False  # a frame that no frame of a later message may overtake

    @property
    def waiting_bytes(self) -> int:
        """The bytes of topics that wait."""
        return self._bytes

    def put(self, key: Hashable, frame: Frame, depth: int = 10) -> None:
        """Add a frame of a topic; beyond `depth` frames, the oldest is dropped.

        Args:
            key: The key of its queue, such as the name of the topic.
            frame: The frame.
            depth: Maximum number of waiting frames with this key.
        """
        if self._closed:
            return
        if self.direct is not None and self._is_empty() and self.direct(frame):
            self.sent += 1
            return
        queue = self._queues.setdefault(key, deque())
        if not queue:
            self._turns.append(key)
        queue.append(frame)
        self._count(key, len(frame))
        if len(queue) > depth:
            self._drop(key)
            if depth > 1:
                self.on_drop(key)
        while self._bytes > self._max_bytes:
            largest = max(self._key_bytes, key=self._key_bytes.__getitem__)
            self._drop(largest)
            self.on_drop(largest)
        self._filled.set()

    def send(self, frame: Frame) -> None:
        """Add an answer, which is sent before all frames of topics.

        If too many answers wait, the outbox is closed, which disconnects the client.
        """
        if self._closed:
            return
        self._answers.append(frame)
        self._answer_bytes += len(frame)
        if len(self._answers) > MAX_ANSWERS or self._answer_bytes > self._max_bytes:
            self.overflowed = True
            self.on_overflow()
            self.close()
        self._filled.set()

    def discard(self, key: Hashable) -> None:
        """Forget a topic that the client has unsubscribed from: its frames, and their count."""
        while self._queues.get(key):
            self._take(key)
        for by_key in (self._queues, self._key_bytes, self.dropped):
            by_key.pop(key, None)

    def close(self) -> None:
        """End the iteration, and forget all frames."""
        self._closed = True
        self._answers.clear()
        self._queues.clear()
        self._turns.clear()
        self._key_bytes.clear()
        self._bytes = self._answer_bytes = 0
        self._filled.set()

    async def __aiter__(self) -> AsyncIterator[Frame]:
        """Yield the frames until the outbox is closed. For the one writing task."""
        while not self._closed:
            frame = self.next_frame()
            if frame is None:
                self._filled.clear()
                await self._filled.wait()
            else:
                self.sent += 1
                self._is_leaving = True
                yield frame
                self._is_leaving = False

    def _is_empty(self) -> bool:
        return not (self._turns or self._answers or self._is_leaving)

    def next_frame(self) -> Frame | None:
        """Remove and return the next frame to send; None if nothing waits."""
        if self._answers:
            answer = self._answers.popleft()
            self._answer_bytes -= len(answer)
            return answer
        if not self._turns:
            return None
        key = self._turns[0]
        frame = self._take(key)
        if self._turns and self._turns[0] == key:
            self._turns.rotate(-1)
        return frame

    def _take(self, key: Hashable) -> Frame:
        """Return the oldest frame of a topic."""
        queue = self._queues[key]
        frame = queue.popleft()
        self._count(key, -len(frame))
        if not queue:
            self._turns.remove(key)
        return frame

    def _drop(self, key: Hashable) -> None:
        self._take(key)
        self.dropped[key] += 1

    def _count(self, key: Hashable, size: int) -> None:
        self._bytes += size
        self._key_bytes[key] += size
