"""A reader's view of one writer (the term is RTPS's); a state machine without I/O.

`stateful_writer` describes the protocol.

Whoever may publish on the topic can send a HEARTBEAT or GAP in a writer's name. So neither moves a
reader further past the received messages than a writer may send ahead. Anything beyond that is a
claim: the reader asks for its last message, and believes the claim once a message has reached it. A
message that was announced as missing, but arrives, is accepted.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final, Protocol

from aionode.engine.transport.reliability.limits import (
    NEVER,
    OVERHEAD_BYTES,
    QUIET_NS,
    WINDOW_BYTES,
    WINDOW_MESSAGES,
)
from aionode.engine.transport.reliability.submessage import (
    MAX_RANGES,
    SubmessageKind,
    pack,
    pack_ranges,
)

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["ProxyOutput", "WriterProxy"]

ACK_BYTES: Final = 64 * 1024
"""Number of bytes after which a reader acknowledges unasked."""

ACK_OVERHEAD_BYTES: Final = 256
"""Bytes that each message counts besides its payload: 256 empty messages cause one acknowledgement,
and a writer's window is more than ten times that."""

NACK_NS: Final = 5_000_000
"""Minimum interval between requests for missing messages, unless a heartbeat arrives."""

MAX_HELD: Final = 10_000
"""Number of messages held while earlier ones are missing; further ones will be resent."""

HELD_BYTES: Final = 2 * WINDOW_BYTES
"""Number of bytes held: a writer sends a window ahead, and may resend it."""

MAX_GAPS: Final = 1_000
"""Number of gaps noted ahead of the next message; the reader asks again for further ones."""

BELIEVED: Final = WINDOW_BYTES // OVERHEAD_BYTES
"""A HEARTBEAT or GAP is believed for this many messages beyond those that have arrived: a full
window of empty ones."""

ANEW_AFTER: Final = 16
ANEW_NS: Final = 1_000_000_000
"""A reader starts over after this many consecutive messages far below `next`, over this long: a
wrong number has moved it. Messages that were merely overtaken arrive in less time."""

NOT_NOW: Final = -1


class ProxyOutput(Protocol):
    """The output of a `WriterProxy`."""

    def accept(self, item: Any, proxy: WriterProxy) -> bool:
        """Accept the next message; return whether it is used now, rather than waiting for room."""

    def send(self, participant: str, submessage: bytes) -> None:
        """Send a submessage to the context of a writer; it may be lost."""

    def refused(self, last: int) -> None:
        """Report a HEARTBEAT or GAP up to `last` that the writer cannot have sent."""

    def started_anew(self, first: int) -> None:
        """Report that messages from `first` on are accepted that were announced as missing."""


class WriterProxy:
    """A reader's view of one writer.

    Args:
        gid: Its id.
        participant: Its context.
        reader: The id of the reader.
        output: Receives each message once and in order.
        now_ns: A monotonic clock with an arbitrary epoch.
        first: Sequence number of the first message for this reader, according to the writer.
        span: Maximum number of messages that later ones wait for.
        delivered: The last message of this writer that the reader already has.

    Attributes:
        participant: Its context.
        heard_ns: When it last sent anything besides messages.
        absent_ticks: Number of consecutive ticks at which its endpoint was missing from the graph.
        next: The sequence number to be accepted next.
        expected: Like `next` while nothing is held back or missing; otherwise no sequence number.
        last: The highest known sequence number; not updated by messages in order.
    """

    __slots__ = (
        "_claim",
        "_claimed",
        "_delivered",
        "_gaps",
        "_held",
        "_held_bytes",
        "_nacked_ns",
        "_now_ns",
        "_old",
        "_output",
        "_reached",
        "_reader",
        "_seen",
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
        reader: bytes,
        output: ProxyOutput,
        now_ns: Callable[[], int],
        *,
        first: int,
        span: int,
        delivered: int,
    ) -> None:
        self.gid = gid
        self.participant = participant
        self.next = self.expected = first
        self.last = first - 1
        self.heard_ns = now_ns()
        self.absent_ticks = 0
        self._reader = reader
        self._span = span
        self._output = output
        self._now_ns = now_ns
        # Invariants: `_delivered` < `next`, and everything in `_held` is beyond `next`.
        # Messages that arrived before an earlier one: item and size by sequence number.
        self._held: dict[int, tuple[Any, int]] = {}
        self._held_bytes = 0
        # Ranges from `next` on that will not be sent.
        self._gaps: list[tuple[int, int]] = []
        # Sequence numbers of accepted messages that wait for room.
        self._waiting: deque[int] = deque()
        self._unacked_bytes = 0
        self._nacked_ns = 0
        # The last message that arrived, and the last one delivered. `receive_expected` leaves both
        # to `_catch_up`, which detects by `_seen` that `next` has moved.
        self._reached = first - 1
        self._delivered = delivered
        self._seen = first
        # Up to where the writer has said that nothing will come, and the last claim beyond what is
        # believed: a range that will not come, and the last message sent.
        self._claimed = first
        self._claim: tuple[int, int, int] | None = None
        # Messages far below `next`, in ascending order: how many, the last one, and since when.
        self._old = 0, 0, 0

    @property
    def delivered(self) -> int:
        """The last message that was delivered."""
        self._catch_up()
        return self._delivered

    @property
    def lacks(self) -> bool:
        """Whether a message is known to be missing."""
        return self.next <= self.last

    def receive_expected(self, size: int) -> None:
        """Count the message `expected`, which the caller uses: the common case of `receive`."""
        self.next = self.expected = self.expected + 1
        self._unacked_bytes = unacked = self._unacked_bytes + size + ACK_OVERHEAD_BYTES
        if unacked >= ACK_BYTES:
            self.acknowledge()

    def receive(self, sequence: int, item: Any, size: int, *, is_resent: bool = False) -> None:
        """Handle a message, whether new or resent.

        Args:
            sequence: Its number.
            item: The message.
            size: How many bytes it has.
            is_resent: Whether it was sent to this reader only.
        """
        self._catch_up()
        if self._delivered < sequence < self.next:
            self._start_anew(sequence)
        if sequence == self.next:
            self.next = sequence + 1
            self._accept(sequence, item, size)
            self._note_reached(sequence)
            if self._held or self._gaps:
                self._release()
        elif self.next < sequence < NEVER:
            if sequence not in self._held and self._may_hold(size):
                self._held[sequence] = item, size
                self._held_bytes += size
            self.last = max(self.last, sequence)
            self._note_reached(sequence)
            if sequence - self.next >= self._span:
                self._skip(sequence - self._span + 1)
            if self.lacks:
                self._nack_soon()
        elif not is_resent and 0 < sequence < self.next - BELIEVED and self._is_anew(sequence):
            self._start_anew(sequence)
            self.receive(sequence, item, size)
        self._update_expected()

    def _catch_up(self) -> None:
        """Account for what `receive_expected` has counted."""
        if self.next > self._seen:
            self._delivered = self.next - 1
            self._reached = max(self._reached, self._delivered)
            self._old = 0, 0, 0

    def _note_reached(self, sequence: int) -> None:
        """Record how far messages have arrived, and believe a claim up to that point."""
        self._old = 0, 0, 0
        self._reached = max(self._reached, sequence)
        claim = self._claim
        if claim is not None and claim[2] <= self._limit:
            self._claim = None
            self.last = max(self.last, claim[2])
            self._add_gap(*claim[:2])

    def _start_anew(self, sequence: int) -> None:
        """Go back to a message that arrived although it is below `next`."""
        if self._claimed - sequence >= ANEW_AFTER:  # fewer may have been overtaken
            self._output.started_anew(sequence)
        self._start_at(sequence)

    def _start_at(self, sequence: int) -> None:
        """Expect a message below `next`; nothing after it was delivered."""
        self._claimed = self.next = self._seen = sequence
        self._gaps.clear()
        for held in [number for number in self._held if number > sequence + BELIEVED]:
            self._unhold(held)
        self.last = max(self._held, default=sequence - 1)
        self._reached = max(self.last, sequence - 1)

    def _is_anew(self, sequence: int) -> bool:
        """Return whether a message far below `next` completes a run of such messages."""
        count, last, since_ns = self._old
        now_ns = self._now_ns()
        if sequence <= last:
            count = 0
        self._old = count + 1, sequence, since_ns if count else now_ns
        if count + 1 < ANEW_AFTER or now_ns - self._old[2] < ANEW_NS:
            return False
        self._delivered, self._claimed = sequence - 1, self.next
        return True

    def _may_hold(self, size: int) -> bool:
        """Return whether another message can be held; one that cannot will be resent."""
        count = len(self._held)
        return count < WINDOW_MESSAGES or (
            count < MAX_HELD and self._held_bytes + size <= HELD_BYTES
        )

    def _unhold(self, sequence: int) -> tuple[Any, int] | None:
        """Remove and return a held message; None if there is none."""
        message = self._held.pop(sequence, None)
        if message is not None:
            self._held_bytes -= message[1]
        return message

    def _update_expected(self) -> None:
        self._seen = self.next
        is_steady = not (self._held or self._gaps or self._waiting)
        self.expected = self.next if is_steady else NOT_NOW

    def _accept(self, sequence: int, item: Any, size: int) -> None:
        self._delivered = sequence
        if self._output.accept(item, self):
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
                self._pass(end + 1)
            else:
                break
        if self.lacks:
            self._nack_soon()

    def _gap_end(self) -> int:
        """Return the end of the gap that starts at `next`; 0 if there is none."""
        self._gaps = [gap for gap in self._gaps if gap[1] >= self.next]
        return max((last for first, last in self._gaps if first <= self.next), default=0)

    def used(self, size: int) -> None:
        """Count the oldest message that waited for room, which is now used."""
        self._waiting.popleft()
        self._update_expected()
        self._note_used(size)

    def heartbeat(self, first: int, last: int, *, ask: bool = True) -> None:
        """Handle a heartbeat.

        Args:
            first: Messages before this one are not for this reader.
            last: The last message that was sent.
            ask: Whether to ask for missing messages. If not, they may have arrived unhandled.
        """
        self.heard_ns = self._now_ns()
        self._catch_up()
        claim, limit = self._claim, self._limit
        if claim is not None and last < claim[2]:  # a writer never claims less than before
            self._claim = None
            self._output.refused(claim[2])
        if first > limit + 1 or last > limit:
            self._claim = 0, first - 1, max(first - 1, last)
        if self._delivered <= last and last + 1 < self.next:  # nor did it claim what moved `next`
            self._start_at(max(self._delivered + 1, min(first, last + 1)))
        if first <= limit + 1:
            self._claimed = max(self._claimed, first)
            self._skip(first)
        if last <= limit:
            self.last = max(self.last, last)
        if self.last - self.next >= self._span and ask:
            self._skip(self.last - self._span + 1)
        self._update_expected()
        self.acknowledge(ask=ask, claimed=last if last > limit else 0)

    @property
    def _limit(self) -> int:
        """The message up to which a HEARTBEAT or GAP is believed."""
        return self._reached + BELIEVED

    def gap(self, first: int, last: int) -> None:
        """Handle a GAP: a range that will not be sent."""
        self.heard_ns = self._now_ns()
        self._catch_up()
        if last > self._limit:
            self._claim = first, last, last
            last = self._limit
        self._add_gap(first, last)
        self._update_expected()

    def _add_gap(self, first: int, last: int) -> None:
        """Stop waiting for a range, if it is valid and extends beyond `next`."""
        if first <= last and last >= self.next and len(self._gaps) < MAX_GAPS:
            self.last = max(self.last, last)
            self._claimed = max(self._claimed, last + 1)
            self._gaps.append((first, last))
            self._release()

    def _skip(self, number: int) -> None:
        """Stop waiting for messages before `number`."""
        if number > self.next:
            self._pass(number)
            self._release()

    def _pass(self, number: int) -> None:
        """Accept what is held before `number`, which becomes next."""
        for held in sorted(n for n in self._held if n < number):
            self.next = held + 1
            message = self._unhold(held)
            if message is not None:
                self._accept(held, *message)
        self.next = number

    def _nack_soon(self) -> None:
        now_ns = self._now_ns()
        if now_ns - self._nacked_ns >= NACK_NS:
            self.acknowledge()

    def acknowledge(self, *, ask: bool = True, claimed: int = 0) -> None:
        """Send an ACKNACK that lists what has arrived and, with `ask`, what is missing.

        Args:
            ask: Whether to ask for what is missing.
            claimed: The last message of a claim, to request as well; 0 for none.
        """
        self._unacked_bytes = 0
        missing: list[tuple[int, int]] = []
        if ask and (self.lacks or claimed):
            self._nacked_ns = self._now_ns()
            missing = self._missing(claimed)
        first = self._waiting[0] if self._waiting else self.next
        kind, ranges = SubmessageKind.ACKNACK, pack_ranges(missing)
        self._output.send(self.participant, pack(kind, self.gid, self._reader, first, 0, ranges))

    def _missing(self, claimed: int) -> list[tuple[int, int]]:
        # The end of a claim first: it alone shows whether the claim is true.
        ranges = [(claimed, claimed)] if claimed else []
        known = max(self.last, self._limit) if claimed else self.last
        begin = self.next
        present = [(number, number) for number in self._held]
        for first, last in sorted(present + self._gaps):
            if first > begin:
                ranges.append((begin, first - 1))
                if len(ranges) == MAX_RANGES:
                    return ranges
            begin = max(begin, last + 1)
        if begin <= known:
            ranges.append((begin, known))
        return ranges

    def remind(self) -> None:
        """Ask again for missing messages, unless that was done a moment ago."""
        if self._now_ns() - self._nacked_ns >= QUIET_NS:
            self.acknowledge()

    def give_up(self) -> None:
        """Accept what is held despite its gaps, as the writer is gone."""
        self._catch_up()
        self._skip(self.last + 1)
        self._update_expected()
