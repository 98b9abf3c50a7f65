"""The waiting messages of one subscription of a client, limited in number and in bytes."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from aionode.gateway.session.feed import Received

__all__ = ["Waiting"]

MAX_BYTES: Final = 32 << 20
"""Bytes of one subscription's messages that may wait; beyond that, the oldest are dropped."""


class Waiting:
    """The newest messages of a subscription, oldest first.

    Args:
        depth: Maximum number of messages.
    """

    def __init__(self, depth: int) -> None:
        self._depth = depth
        self._messages: deque[Received] = deque()
        self._bytes = 0

    def __len__(self) -> int:
        return len(self._messages)

    def put(self, received: Received) -> int:
        """Add a message, and return how many of the oldest were dropped for it."""
        self._messages.append(received)
        self._bytes += len(received.raw)
        dropped = 0
        while len(self._messages) > self._depth or (
            self._bytes > MAX_BYTES and len(self._messages) > 1
        ):
            self.take()
            dropped += 1
        return dropped

    def take(self) -> Received:
        """Remove and return the oldest message."""
        received = self._messages.popleft()
        self._bytes -= len(received.raw)
        return received

    def clear(self) -> None:
        """Forget all messages."""
        self._messages.clear()
        self._bytes = 0
