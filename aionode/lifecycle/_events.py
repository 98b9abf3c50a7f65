"""Events for any number of readers, each with its own queue."""

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
    """Passes each event to all current iterations."""

    def __init__(self) -> None:
        self._readers: dict[Reader[EventT], None] = {}  # ordered, so that they wake in order
        self._ended = False

    def emit(self, event: EventT) -> None:
        """Pass `event` to all readers."""
        for reader in self._readers:
            reader.events.append(event)
            reader.woken.set()

    def end(self) -> None:
        """End all iterations after their pending events; later ones end at once."""
        self._ended = True
        for reader in self._readers:
            reader.woken.set()

    async def iterate(self) -> AsyncIterator[EventT]:
        """Iterate over the events that occur from the first step of the iteration on."""
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
    """The pending events of one iteration."""

    def __init__(self) -> None:
        self.events: deque[EventT] = deque(maxlen=KEPT_EVENTS)
        self.woken = asyncio.Event()
