"""Events for any number of readers, each with a queue of its own."""

from __future__ import annotations

import asyncio
from collections import deque
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

__all__ = ["EventSource"]

EventT = TypeVar("EventT")

KEPT_EVENTS = 100
"""Maximum number of events kept for a slow reader; the oldest are dropped first."""


class EventSource(Generic[EventT]):
    """Hands each event to all that iterate over them."""

    def __init__(self) -> None:
        self._readers: dict[Reader[EventT], None] = {}  # in order, to wake them in order
        self._ended = False

    def emit(self, event: EventT) -> None:
        """Hand `event` to all readers."""
        for reader in self._readers:
            reader.events.append(event)
            reader.woken.set()

    def end(self) -> None:
        """End all iterations once they have yielded what there was; later ones end at once."""
        self._ended = True
        for reader in self._readers:
            reader.woken.set()

    async def iterate(self) -> AsyncIterator[EventT]:
        """Iterate over the events from the first step of the iteration on."""
        reader: Reader[EventT] = Reader()
        self._readers[reader] = None
        try:
            while True:
                while reader.events:
                    yield reader.events.popleft()
                if self._ended:
                    return
                reader.woken.clear()
                await reader.woken.wait()
        finally:
            del self._readers[reader]


class Reader(Generic[EventT]):
    """The events that one iteration has not yielded yet."""

    def __init__(self) -> None:
        self.events: deque[EventT] = deque(maxlen=KEPT_EVENTS)
        self.woken = asyncio.Event()
