"""From one way to another in the middle of a stream, without losing, doubling or swapping messages.

A reader hears a publisher of another process over Zenoh first. When the two processes are linked:

1. The reader asks for the publisher (`OPEN`).
2. The publisher answers with the number of its last message (`OPENED`), and from the next one on
   writes to both ways.
3. The reader goes on with what comes over Zenoh, and holds what comes over the link, until Zenoh
   has brought that number or a later one: nothing older is under way then. If Zenoh stays silent,
   it has lost the message, or the two were not matched when it was sent: waiting ends as well.
4. The reader takes the link and says so (`SWITCHED`), and the publisher stops writing to Zenoh if
   nobody else listens there. A copy that Zenoh brings ahead of the link is held until then.

When the link ends, the publisher goes on over Zenoh, and sends what the reader has not confirmed
to the reader's process alone (its post), where nobody else can hear it twice; then it says that
this was all (`CAUGHT_UP`). Meanwhile the reader mends the stream: it takes the next number whatever
brings it, also a new link, and holds what is further ahead.
"""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.transport.base import Origin

__all__ = ["Handover", "Way"]

MAX_HELD: Final = 2_000
"""How many messages are held at most; with one more the reader waits for Zenoh no longer.

More than the window of a KEEP_ALL reader, which therefore always waits.
"""


MAX_MENDING: Final = 50_000
"""How many are held at most while what a broken link left unsaid is awaited."""


class Way(enum.Enum):
    """Where a reader takes a publisher's messages from."""

    ZENOH = "zenoh"
    BOTH = "both"
    """From Zenoh still; what the link brings is held."""
    LINK = "link"
    """From the link; what Zenoh brings ahead of it is held."""
    MENDING = "mending"
    """The next number from anywhere; what is further ahead is held."""


class Handover:
    """One reader and one publisher.

    Args:
        deliver: Takes the messages, each once and in order, with the time until when a callback
            may run at once.

    Attributes:
        way: Where they come from now.
        last: The number of the last one that was delivered.
        steady: Whether all that comes over the link from now on can be delivered if it is newer
            than `last`, which is then to be set: what `from_link` does, without the call.
    """

    __slots__ = ("_base", "_deliver", "_held", "_linked", "_owed", "last", "steady", "way")

    def __init__(self, deliver: Callable[[Any, Origin, int], None]) -> None:
        self.way = Way.ZENOH
        self.last = 0
        self.steady = False
        self._deliver = deliver
        self._base = 0
        self._linked = False
        self._owed = 0  # links that have ended, and whose publisher has not caught up
        self._held: dict[int, tuple[Any, Origin]] = {}

    @property
    def waits(self) -> bool:
        """Whether messages are held until others have come."""
        return bool(self._held) and self.way in (Way.BOTH, Way.MENDING)

    def opened(self, sequence: int) -> None:
        """Note that what follows number `sequence` comes over the link."""
        self._base = sequence
        self._linked = True
        if self.way is Way.MENDING:
            self._mend()
            return
        self.way = Way.BOTH
        if self.last >= sequence:
            self.switch()

    def from_zenoh(self, msg: Any, origin: Origin, until_ns: int = 0) -> None:
        """Take a message that came over Zenoh."""
        number = origin.sequence
        if number <= self.last:
            return
        if self.way is Way.LINK or self.way is Way.MENDING:
            self._hold(msg, origin)
            self._mend()
            return
        self._next(msg, origin, until_ns)
        if self.way is Way.BOTH and number >= self._base:
            self.switch()

    def from_link(self, msg: Any, origin: Origin, until_ns: int = 0) -> None:
        """Take a message that came over the link; before `opened` it is for another reader."""
        if self.way is Way.BOTH:
            self._hold(msg, origin)
            if len(self._held) >= MAX_HELD:
                self.switch()
        elif self.way is Way.LINK and origin.sequence > self.last:
            self._next(msg, origin, until_ns)
            held = self._held
            while held and (oldest := next(iter(held))) <= self.last:
                del held[oldest]
            self.steady = not held
        elif self.way is Way.MENDING and self._linked and origin.sequence > self.last:
            self._hold(msg, origin)
            self._mend()

    def from_post(self, msg: Any, origin: Origin) -> None:
        """Take a message that a broken link has left unsaid."""
        if origin.sequence <= self.last:
            return
        if self.way is Way.ZENOH:  # it was never opened here: what is older was sent over Zenoh
            self.way = Way.MENDING
            self._base = origin.sequence - 1
            self._owed = max(self._owed, 1)
        self._hold(msg, origin)
        self._mend()

    def switch(self) -> None:
        """Take the link from now on, and what it brought so far first."""
        if self.way is Way.BOTH:
            self._release()
            self.way = Way.LINK
            self.steady = True

    def broken(self) -> None:
        """Take Zenoh again, as soon as nothing is missing: the link has ended."""
        self._owed += 1
        self._linked = False
        self.steady = False
        if self.way is not Way.ZENOH:
            self.way = Way.MENDING
            self._mend()

    def caught_up(self) -> None:
        """Note that all that a broken link left unsaid has been said."""
        self._owed = max(self._owed - 1, 0)
        self._mend()

    def finish(self) -> None:
        """Mend no longer: what has not come by now was lost."""
        if self.way is Way.MENDING:
            self._owed = 0
            self._release()
            self.way = Way.LINK if self._linked else Way.ZENOH
            self.steady = self._linked

    def _next(self, msg: Any, origin: Origin, until_ns: int = 0) -> None:
        self.last = origin.sequence
        self._deliver(msg, origin, until_ns)

    def _hold(self, msg: Any, origin: Origin) -> None:
        self._held[origin.sequence] = (msg, origin)
        self.steady = False
        if self.way is Way.LINK and len(self._held) > MAX_HELD:
            del self._held[next(iter(self._held))]  # a copy: it comes over the link, or by post
        elif len(self._held) > MAX_MENDING:
            self.finish()

    def _mend(self) -> None:
        if self.way is not Way.MENDING:
            return
        while self.last + 1 in self._held:
            self._next(*self._held.pop(self.last + 1))
        if not self._owed and self.last >= self._base:
            if self._linked:  # what is held came over Zenoh, ahead of the link
                self.way = Way.LINK
                self.steady = not self._held
            else:
                self.finish()

    def _release(self) -> None:
        """Deliver all that is held."""
        held, self._held = self._held, {}
        for number in sorted(held):
            if number > self.last:
                self._next(*held[number])
