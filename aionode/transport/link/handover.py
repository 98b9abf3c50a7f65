"""From one way to another in the middle of a stream, without losing, doubling or swapping messages.

A reader hears a publisher of another process over Zenoh first. When the two processes are linked:

1. The reader asks for the publisher (`OPEN`).
2. The publisher answers with the number of its last message (`OPENED`), and from the next one on
   writes to both ways.
3. The reader goes on with what comes over Zenoh, and holds what comes over the link. The first
   message over Zenoh that has come over the link as well shows that everything before it is here:
   from then on the reader takes the link, and forgets Zenoh. If that message does not come soon,
   Zenoh has lost it, or never had the two matched: then the reader takes the link as well.
4. It says so (`SWITCHED`), and the publisher stops writing to Zenoh if nobody else listens there.

A publisher that has sent nothing yet, or nothing that is still under way, needs no step 3.
When the link ends, the publisher sends over Zenoh what it has no confirmation for, and goes on
there; the reader takes what comes from the number after its last. The publisher may notice first:
what Zenoh brings ahead of the link is kept until the link brings it too, or has ended.
"""

from __future__ import annotations

import enum
from collections import deque
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.transport.base import Origin

__all__ = ["Handover", "Way"]

MAX_HELD = 2_000
"""How many messages are held at most; with one more the reader waits for Zenoh no longer.

More than the window of a KEEP_ALL reader, which therefore always waits.
"""


class Way(enum.Enum):
    """Where a reader takes a publisher's messages from."""

    ZENOH = "zenoh"
    BOTH = "both"
    """From Zenoh still; what the link brings is held."""
    LINK = "link"


class Handover:
    """One reader and one publisher. Each call returns whether it made the reader take the link.

    Args:
        deliver: Takes the messages, each once and in order.

    Attributes:
        way: Where they come from now.
    """

    __slots__ = ("_ahead", "_base", "_deliver", "_held", "_last", "way")

    def __init__(self, deliver: Callable[[Any, Origin], None]) -> None:
        self.way = Way.ZENOH
        self._deliver = deliver
        self._last = 0
        self._base = 0
        self._held: deque[tuple[Any, Origin]] = deque()
        self._ahead: deque[tuple[Any, Origin]] = deque(maxlen=MAX_HELD)

    def opened(self, sequence: int) -> bool:
        """Note that what follows number `sequence` comes over the link."""
        self._base = sequence
        self.way = Way.BOTH
        return self.switch() if sequence <= self._last else False

    def from_zenoh(self, msg: Any, origin: Origin) -> bool:
        """Take a message that came over Zenoh."""
        number = origin.sequence
        if number <= self._last:
            return False
        if self.way is Way.LINK:
            self._ahead.append((msg, origin))
            return False
        self._last = number
        self._deliver(msg, origin)
        return self.switch() if self.way is Way.BOTH and number > self._base else False

    def from_link(self, msg: Any, origin: Origin) -> bool:
        """Take a message that came over the link."""
        if self.way is Way.LINK:
            if origin.sequence > self._last:
                self._last = origin.sequence
                self._deliver(msg, origin)
                while self._ahead and self._ahead[0][1].sequence <= self._last:
                    self._ahead.popleft()
        elif self.way is Way.BOTH:
            self._held.append((msg, origin))
            return self.switch() if len(self._held) >= MAX_HELD else False
        return False

    @property
    def waits(self) -> bool:
        """Whether messages are held."""
        return bool(self._held)

    def switch(self) -> bool:
        """Take the link from now on, and what was held first."""
        if self.way is not Way.BOTH:
            return False
        self.way = Way.LINK
        while self._held:
            self.from_link(*self._held.popleft())
        return True

    def broken(self) -> None:
        """Take Zenoh again: the link has ended. What was held comes, or came, over Zenoh too."""
        self.way = Way.ZENOH
        self._held.clear()
        while self._ahead:
            self.from_zenoh(*self._ahead.popleft())
