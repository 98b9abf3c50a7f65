"""The reader's end of reliable delivery over a lossy transport. A state machine without I/O.

The writer's end is `_reliability`, which describes both.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final, Protocol

from aionode.transport._reliability import NEVER, QUIET_NS, WINDOW_BYTES, WINDOW_MESSAGES
from aionode.wire._acknack import MAX_RANGES

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["ReaderSide", "WriterProxy"]

ACK_BYTES: Final = 64 * 1024
"""A reader acknowledges unasked after so many bytes."""

ACK_OVERHEAD_BYTES: Final = 256
"""What each message counts besides its payload: 256 messages without any make one acknowledgement,
and a writer's window is more than ten times that."""

NACK_NS: Final = 5_000_000
"""A reader asks for missing messages no more often than this, unless it gets a heartbeat."""

MAX_HELD: Final = 10_000
"""How many messages a reader holds while earlier ones are missing; more will be sent again."""

HELD_BYTES: Final = 2 * WINDOW_BYTES
"""How many bytes it holds: a writer sends a window ahead, and may send it again."""

MAX_GAPS: Final = 1_000
"""How many gaps a reader notes ahead of the next message; it asks again for more."""

NOT_NOW: Final = -1


class ReaderSide(Protocol):
    """The output of a `WriterProxy`."""

    def accept(self, item: Any, proxy: WriterProxy) -> bool:
        """Take the next message; return whether it is used, or else waits for room."""

    def acknack(self, proxy: WriterProxy, first: int, ranges: list[tuple[int, int]]) -> None:
        """Send an ACKNACK to the writer."""


class WriterProxy:
    """A writer, as one of its readers sees it.

    Args:
        gid: Its id.
        participant: Its context.
        first: The sequence number of the first message for this reader.
        side: The output; each message is given to it once and in order.
        now_ns: A monotonic clock with any zero.
        span: How many messages later ones wait for at most; more are skipped, as a KEEP_LAST reader
            would drop them anyway.

    Attributes:
        participant: Its context.
        heard_ns: When it last sent anything besides its messages.
        absent_ticks: For how many ticks in a row its endpoint was missing in the graph.
        next: The sequence number that is accepted next.
        expected: As `next` while nothing is held back or missing; else no sequence number.
        last: The highest known sequence number; not updated by messages in order.
    """

    __slots__ = (
        "_gaps",
        "_held",
        "_held_bytes",
        "_nacked_ns",
        "_now_ns",
        "_side",
        "_span",
        "_unacked_bytes",
        "_waiting",
        "absent_ticks",
        "expected",
        "gid",
        "heard_ns",
        "last",
        "next",
        "participant",
    )

    def __init__(
        self,
        gid: bytes,
        participant: str,
        first: int,
        side: ReaderSide,
        now_ns: Callable[[], int],
        span: int = NEVER,
    ) -> None:
        self.gid = gid
        self.participant = participant
        self.next = self.expected = first
        self.last = first - 1
        self.heard_ns = now_ns()
        self.absent_ticks = 0
        self._span = span
        self._side = side
        self._now_ns = now_ns
        # Messages that came before an earlier one: item and size by sequence number.
        self._held: dict[int, tuple[Any, int]] = {}
        self._held_bytes = 0
        # Ranges from `next` on that will not be sent.
        self._gaps: list[tuple[int, int]] = []
        # Sequence numbers of messages that were accepted, but wait for room.
        self._waiting: deque[int] = deque()
        self._unacked_bytes = 0
        self._nacked_ns = 0

    @property
    def lacks(self) -> bool:
        """Whether a message is known to be missing."""
        return self.next <= self.last

    def note_in_order(self, size: int) -> None:
        """Count the message `expected`, which is used by the caller. The common case of `take`."""
        self.next = self.expected = self.expected + 1
        self._unacked_bytes = unacked = self._unacked_bytes + size + ACK_OVERHEAD_BYTES
        if unacked >= ACK_BYTES:
            self.acknowledge()

    def take(self, sequence: int, item: Any, size: int) -> None:
        """Handle a message, whether it is new or was sent again."""
        if sequence == self.next:
            self.next = sequence + 1
            self._accept(sequence, item, size)
            if self._held or self._gaps:
                self._release()
        elif sequence > self.next:
            if sequence not in self._held and self._may_hold(size):
                self._held[sequence] = item, size
                self._held_bytes += size
            self.last = max(self.last, sequence)
            if sequence - self.next >= self._span:
                self._skip(sequence - self._span + 1)
            if self.lacks:
                self._nack_soon()
        self._update_expected()

    def _may_hold(self, size: int) -> bool:
        """Return whether one more message can be held; what is not will be sent again."""
        count = len(self._held)
        return count < WINDOW_MESSAGES or (
            count < MAX_HELD and self._held_bytes + size <= HELD_BYTES
        )

    def _unhold(self, sequence: int) -> tuple[Any, int] | None:
        """Return a message that was held, and no longer is; None if it is not here."""
        message = self._held.pop(sequence, None)
        if message is not None:
            self._held_bytes -= message[1]
        return message

    def _update_expected(self) -> None:
        is_steady = not (self._held or self._gaps or self._waiting)
        self.expected = self.next if is_steady else NOT_NOW

    def _accept(self, sequence: int, item: Any, size: int) -> None:
        if self._side.accept(item, self):
            self._note_used(size)
        else:
            self._waiting.append(sequence)

    def _note_used(self, size: int) -> None:
        self._unacked_bytes += size + ACK_OVERHEAD_BYTES
        if self._unacked_bytes >= ACK_BYTES:
            self.acknowledge()

    def _release(self) -> None:
        """Accept the held messages that are next now."""
        while True:
            message = self._unhold(self.next)
            if message is not None:
                self.next += 1
                self._accept(self.next - 1, *message)
            elif self._gaps and (end := self._gap_end()):
                self.next = end + 1
            else:
                break
        if self.lacks:
            self._nack_soon()

    def _gap_end(self) -> int:
        """Return the end of the gap that begins at `next`; 0 if there is none."""
        self._gaps = [gap for gap in self._gaps if gap[1] >= self.next]
        return max((last for first, last in self._gaps if first <= self.next), default=0)

    def used(self, size: int) -> None:
        """Count the oldest message that waited for room; it is used now."""
        self._waiting.popleft()
        self._update_expected()
        self._note_used(size)

    def heartbeat(self, first: int, last: int, *, ask: bool = True) -> None:
        """Handle a heartbeat.

        Args:
            first: Messages before this one are not for this reader.
            last: The last message that was sent.
            ask: Whether to ask for missing messages. Without it they may be here, unhandled.
        """
        self.heard_ns = self._now_ns()
        self._skip(first)
        self.last = max(self.last, last)
        if self.last - self.next >= self._span and ask:
            self._skip(self.last - self._span + 1)
        self._update_expected()
        self.acknowledge(ask=ask)

    def gap(self, first: int, last: int) -> None:
        """Handle a GAP: a range that will not be sent."""
        self.heard_ns = self._now_ns()
        self.last = max(self.last, last)
        if last >= self.next and len(self._gaps) < MAX_GAPS:
            self._gaps.append((first, last))
            self._release()
        self._update_expected()

    def _skip(self, number: int) -> None:
        """Stop waiting for messages before `number`."""
        if number > self.next:
            for held in sorted(n for n in self._held if n < number):
                self.next = held + 1
                message = self._unhold(held)
                if message is not None:
                    self._accept(held, *message)
            self.next = number
            self._release()

    def _nack_soon(self) -> None:
        now_ns = self._now_ns()
        if now_ns - self._nacked_ns >= NACK_NS:
            self.acknowledge()

    def acknowledge(self, *, ask: bool = True) -> None:
        """Send an ACKNACK that names what is here and, with `ask`, what is missing."""
        self._unacked_bytes = 0
        missing: list[tuple[int, int]] = []
        if ask and self.lacks:
            self._nacked_ns = self._now_ns()
            missing = self._missing()
        self._side.acknack(self, self._waiting[0] if self._waiting else self.next, missing)

    def _missing(self) -> list[tuple[int, int]]:
        ranges: list[tuple[int, int]] = []
        begin = self.next
        present = [(number, number) for number in self._held]
        for first, last in sorted(present + self._gaps):
            if first > begin:
                ranges.append((begin, first - 1))
                if len(ranges) == MAX_RANGES:
                    return ranges
            begin = max(begin, last + 1)
        if begin <= self.last:
            ranges.append((begin, self.last))
        return ranges

    def remind(self) -> None:
        """Ask again for missing messages, unless this was done a moment ago."""
        if self._now_ns() - self._nacked_ns >= QUIET_NS:
            self.acknowledge()

    def give_up(self) -> None:
        """Accept what is held, with its gaps: the writer is gone."""
        self._skip(self.last + 1)
        self._update_expected()
