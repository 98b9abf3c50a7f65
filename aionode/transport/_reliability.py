"""Each message once, in order and complete, over a way that may lose any: without input or output.

A writer keeps what its readers have not acknowledged, and sends no more ahead of them than a
window, so that nothing between them ever fills up. A reader acknowledges now and then, and asks
again for what it lacks. A KEEP_ALL writer waits for its slowest reader; a KEEP_LAST writer waits
only while all of them lag, keeps its last messages, and counts what it drops.

What is lost at the end of a burst shows by a heartbeat: the writer says how far it got once it has
been silent for a moment, and again at growing intervals until it is answered.
"""

from __future__ import annotations

from collections import OrderedDict, deque
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

from aionode.wire._acknack import MAX_RANGES

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = [
    "NEVER",
    "OVERHEAD_BYTES",
    "RETURN_NS",
    "Entry",
    "ReaderProxy",
    "ReaderSide",
    "WriterHistory",
    "WriterProxy",
    "WriterSide",
]

WINDOW_BYTES: Final = 512 * 1024
"""How much a writer sends ahead of a reader's acknowledgement."""

WINDOW_MESSAGES: Final = 4
"""So many messages may be under way whatever their size."""

OVERHEAD_BYTES: Final = 128
"""What a message takes besides its payload, about."""

RESEND_BYTES: Final = 128 * 1024
"""How much is sent again for one acknowledgement."""

RESEND_NS: Final = 50_000_000
"""What was sent again may be on its way for so long before it is sent once more."""

QUIET_NS: Final = 50_000_000
"""For so long a writer is silent before it asks what has arrived."""

HEARTBEAT_NS: Final = 1_000_000_000
"""So often it asks at most, of a reader that does not answer or while it goes on sending."""

SILENT_NS: Final = 3_000_000_000
"""A reader that vanishes after so long without an answer was frozen or cut off, and may return."""

RETURN_NS: Final = 120_000_000_000
"""For so long the place of such a reader is kept."""

ACK_MESSAGES: Final = 64
ACK_BYTES: Final = 64 * 1024
"""After so many messages, or bytes, a reader acknowledges without being asked."""

NACK_NS: Final = 5_000_000
"""So often a reader says at most what it lacks, unless it is asked."""

MAX_HELD: Final = 10_000
"""How many messages a reader holds for want of earlier ones; more will be sent again."""

MAX_GAPS: Final = 1_000
"""How many gaps a reader notes ahead of what it waits for; it asks again for the rest."""

TOLD_RANGES: Final = 16

NEVER: Final = 1 << 62


class Entry(NamedTuple):
    """One message of a writer.

    Attributes:
        sequence: Its number.
        payload: Its bytes.
        extra: What goes with them.
        end: How many bytes the writer had sent when this one was, from the first message on.
    """

    sequence: int
    payload: bytes
    extra: bytes
    end: int


class WriterSide(Protocol):
    """What a `WriterHistory` does to others."""

    def put(self, payload: bytes, extra: bytes) -> None:
        """Send a message to every reader."""

    def resend(self, reader: ReaderProxy, entry: Entry) -> None:
        """Send a message again to one reader."""

    def heartbeat(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Tell one reader how far the messages go, and ask what it has."""

    def gap(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Tell one reader that some will not come."""

    def lost(self, count: int) -> None:
        """Note that messages were dropped before a reader had them."""


class ReaderProxy:
    """A reader as its writer sees it.

    Attributes:
        gid: Its id.
        participant: Its process.
        acked: The number up to which it has everything.
    """

    __slots__ = (
        "acked",
        "asked_ns",
        "away_ns",
        "end",
        "gid",
        "heard_ns",
        "interval_ns",
        "participant",
        "resent",
    )

    def __init__(self, gid: bytes, participant: str, acked: int, end: int, now_ns: int) -> None:
        self.gid = gid
        self.participant = participant
        self.acked = acked
        self.end = end  # of the last one acknowledged, see `Entry`
        self.heard_ns = now_ns
        self.asked_ns = now_ns
        self.interval_ns = QUIET_NS
        self.away_ns = 0  # since when it is not there; 0 while it is
        self.resent: dict[int, int] = {}  # when each missing one was sent again


class WriterHistory:
    """What one writer has sent, or will, and its readers do not have yet.

    Args:
        depth: How many messages are kept at most.
        keep_all: Whether nothing may be dropped.
        side: Sends.
        now_ns: Tells the time; any zero will do.

    Attributes:
        entries: The messages, by number.
        readers: Those that acknowledge, by gid.
        sent: The number of the last one that was sent.
        others: Whether there are readers that do not acknowledge.
    """

    def __init__(
        self, depth: int, *, keep_all: bool, side: WriterSide, now_ns: Callable[[], int]
    ) -> None:
        self.entries: OrderedDict[int, Entry] = OrderedDict()  # its oldest is found at once
        self.readers: dict[bytes, ReaderProxy] = {}
        self.sent = 0
        self.others = False
        self._depth = depth
        self._keep_all = keep_all
        self._side = side
        self._now_ns = now_ns
        self._last = 0  # the last number that was written
        self._end = 0
        self._sent_end = 0
        self._sent_ns = 0
        self._jumped_to = 0  # numbers below this one that are not here were never written here
        self._told: list[tuple[int, int]] = []  # what was lost and told, from first to last
        self._unsent: deque[Entry] = deque()
        self._pumping = False

    # Who reads

    def add(self, gid: bytes, participant: str) -> None:
        """Send to a reader from the next message on; or go on with one that was away."""
        now_ns = self._now_ns()
        reader = self.readers.get(gid)
        if reader is None:
            reader = ReaderProxy(gid, participant, self._last, self._end, now_ns)
            if self._unsent:  # what waits to be sent is for it too
                reader.acked, reader.end = self.sent, self._sent_end
            self.readers[gid] = reader
        else:
            reader.away_ns = 0
            reader.resent.clear()
        reader.heard_ns = reader.asked_ns = now_ns
        reader.interval_ns = QUIET_NS
        self._side.heartbeat(reader, reader.acked + 1, self.sent)

    def remove(self, gid: bytes) -> None:
        """Note that a reader has vanished: it has ended, or it may return."""
        reader = self.readers.get(gid)
        if reader is None or reader.away_ns:
            return
        now_ns = self._now_ns()
        if reader.acked < self.sent and now_ns - reader.heard_ns >= SILENT_NS:
            reader.away_ns = now_ns
        else:
            del self.readers[gid]
        self._trim()
        self.pump()

    # Writing

    def write(self, sequence: int, payload: bytes, extra: bytes) -> None:
        """Send a message, at once or as soon as the window is open."""
        if not self.readers and not self._unsent:
            self._last = self.sent = sequence
            self._jumped_to = sequence + 1
            self._side.put(payload, extra)
            return
        if sequence != self._last + 1:
            self._jumped_to = sequence
            for reader in self.readers.values():
                self._side.gap(reader, self._last + 1, sequence - 1)
        self._last = sequence
        self._end += len(payload) + OVERHEAD_BYTES
        entry = self.entries[sequence] = Entry(sequence, payload, extra, self._end)
        if not self._unsent and self._admits(entry):
            self._send(entry)
        else:
            self._unsent.append(entry)
            self.pump()
        if not self._keep_all:
            self._drop_oldest()

    def _drop_oldest(self) -> None:
        """Drop what is more than the depth, the oldest first."""
        entries = self.entries
        while len(entries) > self._depth:
            sequence, _ = entries.popitem(last=False)
            if sequence > self.sent:  # nobody gets it
                self._unsent.popleft()
                self._lose(sequence, sequence)

    def _lose(self, first: int, last: int) -> None:
        """Tell of lost messages, each number once."""
        count = last - first + 1
        if count <= 0:
            return
        others: list[tuple[int, int]] = []
        begin, end = first, last
        for one in self._told:
            if one[1] < first - 1 or one[0] > last + 1:
                others.append(one)
            else:
                count -= max(min(one[1], last) - max(one[0], first) + 1, 0)
                begin, end = min(begin, one[0]), max(end, one[1])
        self._told = [*others, (begin, end)]
        if count:
            self._side.lost(count)

    def _admits(self, entry: Entry) -> bool:
        """Whether the window is open for the next message."""
        if self.others and not self._keep_all:
            return True
        some = False
        for reader in self.readers.values():
            if reader.away_ns:
                continue
            some = True
            is_open = (
                reader.acked >= self.sent  # what was dropped unsent lies between the two ends too
                or entry.end - reader.end <= WINDOW_BYTES
                or entry.sequence - reader.acked <= WINDOW_MESSAGES
            )
            if is_open is not self._keep_all:
                return is_open  # KEEP_LAST waits only if all lag, KEEP_ALL if one does
        return self._keep_all or not some

    def _send(self, entry: Entry) -> None:
        self.sent = entry.sequence
        self._sent_end = entry.end
        self._sent_ns = self._now_ns()
        self._side.put(entry.payload, entry.extra)

    def pump(self) -> None:
        """Send what waits, as far as the window is open."""
        unsent = self._unsent
        if self._pumping or not unsent:
            return
        self._pumping = True
        try:
            while unsent and self._admits(unsent[0]):
                self._send(unsent.popleft())
        finally:
            self._pumping = False
        if not self.readers:
            self._trim()

    def has_room(self) -> bool:
        """Whether one more can be kept without dropping any."""
        return len(self.entries) < self._depth

    @property
    def done(self) -> bool:
        """Whether every reader has everything."""
        return not self.entries

    @property
    def unsent(self) -> bool:
        """Whether something waits for the window."""
        return bool(self._unsent)

    # What readers say

    def acknack(self, gid: bytes, first: int, ranges: list[tuple[int, int]]) -> None:
        """Note that a reader has everything before `first`, and send it again what it lacks."""
        reader = self.readers.get(gid)
        if reader is None:
            return
        now_ns = reader.heard_ns = self._now_ns()
        if self.sent >= first - 1 > reader.acked:
            reader.acked = first - 1
            entry = self.entries.get(reader.acked)
            if entry is not None:
                reader.end = entry.end
            elif reader.acked >= self.sent:
                reader.end = self._sent_end
            elif self.entries:  # it was dropped, and all that is left is newer
                oldest = self.entries[next(iter(self.entries))]
                reader.end = oldest.end - len(oldest.payload) - OVERHEAD_BYTES
            reader.interval_ns = QUIET_NS
            if reader.resent:
                reader.resent = {n: at for n, at in reader.resent.items() if n > reader.acked}
            self._trim()
        if ranges:
            self._resend(reader, ranges, now_ns)
        self.pump()

    def _resend(self, reader: ReaderProxy, ranges: list[tuple[int, int]], now_ns: int) -> None:
        left = RESEND_BYTES
        entries = self.entries
        for begin, end in ranges[:MAX_RANGES]:
            first, last = max(begin, reader.acked + 1), min(end, self.sent)
            oldest = next(iter(entries), NEVER)
            if first < oldest:
                absent = min(last, oldest - 1)
                if absent >= first:
                    if any(
                        n <= absent and now_ns - at < RESEND_NS for n, at in reader.resent.items()
                    ):
                        return  # it was sent again before it was dropped, and may be on its way
                    self._lose(max(first, self._jumped_to), absent)
                    self._side.gap(reader, first, absent)
                first = absent + 1
            number = first
            while number <= last:
                entry = entries.get(number)
                if entry is None:  # it was never written here, nor were some after it
                    after = min(next((n for n in entries if n > number), NEVER), last + 1)
                    self._side.gap(reader, number, after - 1)
                    number = after
                    continue
                if now_ns - reader.resent.get(number, -RESEND_NS) >= RESEND_NS:
                    reader.resent[number] = now_ns
                    self._side.resend(reader, entry)
                    left -= len(entry.payload) + OVERHEAD_BYTES
                    if left <= 0:
                        return
                number += 1

    def _trim(self) -> None:
        """Forget what every reader has."""
        everyone = min((reader.acked for reader in self.readers.values()), default=self.sent)
        entries = self.entries
        while entries and (oldest := next(iter(entries))) <= min(everyone, self.sent):
            del entries[oldest]
        if len(self._told) > TOLD_RANGES:
            self._told = [one for one in self._told if one[1] > everyone]

    # Time

    def tick(self) -> bool:
        """Ask readers what they have, where it is time to; return whether to come again."""
        now_ns = self._now_ns()
        quiet = now_ns - self._sent_ns >= QUIET_NS
        for reader in list(self.readers.values()):
            if reader.away_ns:
                if now_ns - reader.away_ns >= RETURN_NS:
                    del self.readers[reader.gid]
                    self._lose(max(reader.acked + 1, self._jumped_to), self.sent)
                    self._trim()
                    self.pump()
            elif reader.acked < self.sent:
                waited_ns = now_ns - reader.asked_ns
                if waited_ns >= HEARTBEAT_NS or (quiet and waited_ns >= reader.interval_ns):
                    reader.asked_ns = now_ns
                    reader.interval_ns = min(reader.interval_ns * 2, HEARTBEAT_NS)
                    self._side.heartbeat(reader, reader.acked + 1, self.sent)
        return bool(self.entries) or any(reader.away_ns for reader in self.readers.values())

    def give_up(self) -> int:
        """Forget everything; return how many messages some reader will not have."""
        acked = min((reader.acked for reader in self.readers.values()), default=self.sent)
        missing = sum(1 for sequence in self.entries if sequence > acked)
        self.entries.clear()
        self._unsent.clear()
        self.readers.clear()
        self.sent = self._last
        return missing


class ReaderSide(Protocol):
    """What a `WriterProxy` does to others."""

    def accept(self, item: Any, proxy: WriterProxy) -> bool:
        """Take the next message; return whether it is used, or else waits (see `used`)."""

    def acknack(self, proxy: WriterProxy, first: int, ranges: list[tuple[int, int]]) -> None:
        """Tell the writer what is here and what is not."""


class WriterProxy:
    """A writer as one of its readers sees it.

    Args:
        gid: Its id.
        first: The number of the first message for this reader.
        side: Takes the messages, each once and in order, and acknowledges.
        now_ns: Tells the time; any zero will do.
        span: How many messages it waits for at most; older ones are left out when newer ones are
            there, as a KEEP_LAST reader would drop them anyway.

    Attributes:
        participant: Its process.
        heard_ns: When it last said something besides its messages.
        next: The number that is accepted next.
        last: The highest number known of.
    """

    __slots__ = (
        "_bytes",
        "_count",
        "_gaps",
        "_held",
        "_nacked_ns",
        "_now_ns",
        "_side",
        "_span",
        "_waiting",
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
        self.next = first
        self.last = first - 1
        self.heard_ns = now_ns()
        self._span = span
        self._side = side
        self._now_ns = now_ns
        self._held: dict[int, tuple[Any, int]] = {}
        self._gaps: list[tuple[int, int]] = []  # ahead of `next`, of what will not come
        self._waiting: deque[int] = deque()  # accepted, but not used yet
        self._count = 0
        self._bytes = 0
        self._nacked_ns = 0

    @property
    def lacks(self) -> bool:
        """Whether something is missing that is known of."""
        return self.next <= self.last

    def takes_at_once(self, sequence: int, size: int) -> bool:
        """Whether a message is just the next, which is then to be used at once.

        That is what `take` does for most messages, in fewer calls.
        """
        if sequence != self.next or self._held or self._gaps or self._waiting:
            return False
        self.next = sequence + 1
        self.last = max(self.last, sequence)
        self._count += 1
        self._bytes += size
        if self._count >= ACK_MESSAGES or self._bytes >= ACK_BYTES:
            self.acknowledge()
        return True

    def take(self, sequence: int, item: Any, size: int) -> None:
        """Take a message, new or sent again."""
        if sequence == self.next:
            self.next = sequence + 1
            self.last = max(self.last, sequence)
            self._accept(sequence, item, size)
            if self._held or self._gaps:
                self._release()
        elif sequence > self.next:
            if len(self._held) < MAX_HELD:
                self._held.setdefault(sequence, (item, size))
            self.last = max(self.last, sequence)
            if sequence - self.next >= self._span:
                self._skip(sequence - self._span + 1)
            if self.lacks:
                self._nack_soon()

    def _accept(self, sequence: int, item: Any, size: int) -> None:
        if self._side.accept(item, self):
            self._note_used(size)
        else:
            self._waiting.append(sequence)

    def _note_used(self, size: int) -> None:
        self._count += 1
        self._bytes += size
        if self._count >= ACK_MESSAGES or self._bytes >= ACK_BYTES:
            self.acknowledge()

    def _release(self) -> None:
        """Accept what was held for want of what has come now."""
        held = self._held
        while True:
            one = held.pop(self.next, None)
            if one is not None:
                self.next += 1
                self._accept(self.next - 1, *one)
            elif self._gaps and (end := self._gap_end()):
                self.next = end + 1
            else:
                break
        if self.lacks:
            self._nack_soon()

    def _gap_end(self) -> int:
        """Return the last of those from `next` on that will not come; 0 if that one will."""
        self._gaps = [gap for gap in self._gaps if gap[1] >= self.next]
        return max((last for first, last in self._gaps if first <= self.next), default=0)

    def used(self, size: int) -> None:
        """Note that the oldest message that waited is used now."""
        self._waiting.popleft()
        self._note_used(size)

    def heartbeat(self, first: int, last: int, *, ask: bool = True) -> None:
        """Note how far the messages go, and answer; without `ask` some may wait to be taken."""
        self.heard_ns = self._now_ns()
        self._skip(first)
        self.last = max(self.last, last)
        if self.last - self.next >= self._span and ask:
            self._skip(self.last - self._span + 1)
        self.acknowledge(ask=ask)

    def gap(self, first: int, last: int) -> None:
        """Note that some will not come."""
        self.heard_ns = self._now_ns()
        self.last = max(self.last, last)
        if last >= self.next and len(self._gaps) < MAX_GAPS:
            self._gaps.append((first, last))
            self._release()

    def _skip(self, number: int) -> None:
        """Wait for nothing before `number`."""
        if number > self.next:
            for held in sorted(n for n in self._held if n < number):
                self.next = held + 1
                self._accept(held, *self._held.pop(held))
            self.next = number
            self._release()

    def _nack_soon(self) -> None:
        now_ns = self._now_ns()
        if now_ns - self._nacked_ns >= NACK_NS:
            self.acknowledge()

    def acknowledge(self, *, ask: bool = True) -> None:
        """Tell the writer what is here, and with `ask` what is not."""
        self._count = self._bytes = 0
        missing: list[tuple[int, int]] = []
        if ask and self.lacks:
            self._nacked_ns = self._now_ns()
            missing = self._missing()
        self._side.acknack(self, self._waiting[0] if self._waiting else self.next, missing)

    def _missing(self) -> list[tuple[int, int]]:
        ranges: list[tuple[int, int]] = []
        begin = self.next
        here = [(number, number) for number in self._held]
        for first, last in sorted(here + self._gaps):
            if first > begin:
                ranges.append((begin, first - 1))
                if len(ranges) == MAX_RANGES:
                    return ranges
            begin = max(begin, last + 1)
        if begin <= self.last:
            ranges.append((begin, self.last))
        return ranges

    def remind(self) -> None:
        """Ask again for what is missing, if that is some time ago."""
        if self._now_ns() - self._nacked_ns >= QUIET_NS:
            self.acknowledge()

    def give_up(self) -> None:
        """Accept what is held, with its gaps: the writer is gone."""
        self._skip(self.last + 1)
