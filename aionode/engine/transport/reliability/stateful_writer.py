"""The writer's end of reliable delivery over a lossy transport; a state machine without I/O.

A writer keeps what its readers have not acknowledged, and sends at most one window ahead of them,
so that no queue on the way to them fills up. A KEEP_ALL writer waits for its slowest reader; a
KEEP_LAST writer waits only while all of them lag, keeps its last messages, and counts what it
drops. The reader's end is `stateful_reader`.

The loss of a burst's last message is detected by heartbeats: a writer that has been idle for a
moment announces its last sequence number, and repeats this at growing intervals until it is
acknowledged. The terms are RTPS's.

A reader that vanishes after not answering for a while was frozen, and is waited for. One that
vanishes while answering was cut off, or has ended: messages are kept for it while that holds
nothing up, but only briefly if its connection turns out to be alive. A reader that was asked for a
long time and has never answered does not count: any program may announce one. A reader that has
everything gets no heartbeats, so a KEEP_ALL writer probes it.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import deque
from operator import itemgetter
from typing import TYPE_CHECKING, Final, Protocol, TypeAlias

from aionode.engine.transport.reliability.limits import (
    NEVER,
    OVERHEAD_BYTES,
    QUIET_NS,
    WINDOW_BYTES,
    WINDOW_MESSAGES,
)
from aionode.engine.transport.reliability.reader_proxy import ReaderProxy
from aionode.engine.transport.reliability.submessage import MAX_RANGES, SubmessageKind, pack

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.reliability.submessage import Submessage

__all__ = ["MUTE_TICKS", "StatefulWriter", "WriterOutput"]

RESEND_BYTES: Final = 128 * 1024
"""Maximum number of bytes to resend for one acknowledgement."""

RESEND_NS: Final = 50_000_000
"""Minimum interval between copies of a message, as the last one may still be on its way."""

HEARTBEAT_NS: Final = 1_000_000_000
"""Interval of heartbeats to a reader that does not answer, and while the writer is busy."""

SILENT_NS: Final = 3_000_000_000
"""A reader that vanishes after not answering for this long was frozen, and may return."""

UNHEARD_NS: Final = 500_000_000
"""A reader that has everything, and has been silent for this long, is probed."""

FLAPPING_NS: Final = 10_000_000_000
"""A reader that vanishes again within this time of its return is waited for as long again; so is
one that was cut off."""

KNOWN_NS: Final = 1_000_000_000
"""How long after its readers have vanished the loss of a connection is known."""

RETURN_NS: Final = 120_000_000_000
"""How long to keep messages for a reader that vanished after `SILENT_NS` of silence."""

MAX_READERS: Final = 1_000
"""A writer with more readers than this does not wait for any that vanishes: any process may
announce and withdraw thousands, repeatedly."""

LOST_RANGES: Final = 16
"""Number of ranges of reported losses to remember before acknowledged ones are dropped."""

UNANSWERED_EACH_TICK: Final = 10
"""Number of readers that have never answered to ask at once, the others later, so that announcing
thousands of them costs no more."""

MUTE_TICKS: Final = 200
"""A reader that has never answered, and lacked messages at this many ticks (about ten seconds),
does not acknowledge. Ticks are counted, not time, as those of a stalled writer are late too."""


Entry: TypeAlias = tuple[int, bytes, bytes, int]
"""A message of a writer: sequence number, payload, attachment, and its end, which is the total size
of this writer's messages up to and including it, with `OVERHEAD_BYTES` for each.

A message costs one append and one popleft, so this is a plain tuple: a NamedTuple costs more."""


class WriterOutput(Protocol):
    """The output of a `StatefulWriter`."""

    def put(self, payload: bytes, extra: bytes) -> None:
        """Send a message to every reader."""

    def send(self, participant: str, submessage: bytes) -> None:
        """Send a submessage to one reader's context; it may be lost. Called from any thread."""

    def source_ns(self, extra: bytes) -> int:
        """Return when a message was published, from its attachment, in nanoseconds since 1970."""

    def lost(self, count: int) -> None:
        """Count messages that were dropped before every reader had them."""

    def mute(self, reader: ReaderProxy) -> None:
        """Report that a reader that is being removed has never answered."""


class StatefulWriter:
    """The messages of one writer that some reader has not acknowledged; the term is RTPS's.

    Args:
        gid: The id of the writer.
        participant: The id of its context, to which readers reply.
        output: Sends messages and submessages.
        depth: Maximum number of messages to keep.
        limit_bytes: Maximum number of bytes to keep; the newest message is kept whatever its size.
        keep_all: Whether nothing may be dropped.
        now_ns: A monotonic clock with an arbitrary epoch.
        has_lost: Returns whether the connection to a context was lost in the last seconds; by
            default never.

    Attributes:
        entries: The messages, in order of sequence.
        readers: The readers that acknowledge, by gid, including those that may return.
        sent: Sequence number of the last message sent.
        has_other_readers: Whether there are readers that do not acknowledge.
    """

    def __init__(
        self,
        gid: bytes,
        participant: str,
        output: WriterOutput,
        depth: int,
        limit_bytes: int = NEVER,
        *,
        keep_all: bool,
        now_ns: Callable[[], int],
        has_lost: Callable[[str], bool] = lambda _: False,
    ) -> None:
        self._gid = gid
        self._participant = participant.encode()
        self.entries: deque[Entry] = deque()
        self.readers: dict[bytes, ReaderProxy] = {}
        self.sent = 0
        self.has_other_readers = False
        self._depth = depth
        self._keep_all = keep_all
        self._limit = NEVER if keep_all else depth  # of `entries`
        self._limit_bytes = limit_bytes
        self._output = output
        self._put = output.put
        self._now_ns = now_ns
        self._has_lost = has_lost
        # Invariants: `sent` <= `_last`, no reader has acknowledged more than `sent`, and `_unsent`
        # holds the `entries` after `sent`.
        self._last = 0  # the last sequence number that was written
        self._end = 0  # of the last message that was written, as `Entry.end`
        self._sent_end = 0  # of the last message that was sent
        self._sent_ns = 0
        # A message that ends before this is within the window, whatever `_admits` says. Recomputed
        # for the next message after readers come or go, so that many at once cost no more.
        self._window_end = -1
        # Sequence numbers below this one that are not in `entries` were never written here.
        self._jumped_to = 0
        # Ranges that were reported as lost, so that none is counted twice.
        self._lost: list[tuple[int, int]] = []
        self._unsent: deque[Entry] = deque()  # the end of `entries`
        self._pumping = False

    # Submessages

    def _heartbeat(self, reader: ReaderProxy, first: int, last: int) -> None:
        self._send(SubmessageKind.HEARTBEAT, reader, first, last, self._participant)

    def _gap(self, reader: ReaderProxy, first: int, last: int) -> None:
        self._send(SubmessageKind.GAP, reader, first, last)

    def _send_again(self, reader: ReaderProxy, entry: Entry) -> None:
        sequence, payload, extra, _ = entry
        self._send(SubmessageKind.DATA, reader, sequence, self._output.source_ns(extra), payload)

    def _send(
        self, kind: SubmessageKind, reader: ReaderProxy, first: int, last: int, rest: bytes = b""
    ) -> None:
        data = pack(kind, self._gid, reader.gid, first, last, rest)
        self._output.send(reader.participant, data)

    def announce_only(self, sequence: int) -> None:
        """Tell current readers not to wait for anything before a message that is sent another way.

        May be called from another thread than the writer's.
        """
        for reader in list(self.readers.values()):
            if not reader.away_until_ns:
                self._heartbeat(reader, sequence, sequence)

    # Readers

    def add(self, gid: bytes, participant: str) -> None:
        """Add a reader, which gets the next message and all later ones, or resume one."""
        now_ns = self._now_ns()
        reader = self.readers.get(gid)
        if reader is None:
            reader = ReaderProxy(gid, participant, self._last, self._end, now_ns)
            if self._unsent:  # pending messages are for this reader too
                reader.acked, reader.end = self.sent, self._sent_end
            self.readers[gid] = reader
        else:
            reader.away_until_ns = 0
            reader.is_cut_off = False
            reader.returned_ns = now_ns
            reader.resent.clear()
        reader.heartbeat_ns = now_ns
        reader.interval_ns = QUIET_NS
        self._window_end = -1
        self._heartbeat(reader, reader.acked + 1, self.sent)

    def remove(self, gid: bytes) -> None:
        """Remove a reader that has vanished, or wait for its return.

        While connections are re-established, a reader can vanish and return more than once. Whether
        its connection was lost may be known only after it has vanished: `tick` checks for that.
        """
        reader = self.readers.get(gid)
        if reader is None or reader.away_until_ns:
            return
        now_ns = self._now_ns()
        # One that has never answered is not an aionode reader, and nothing is kept for it.
        asked = reader.answered and (self._keep_all or reader.acked < self.sent)
        if len(self.readers) > MAX_READERS:
            del self.readers[gid]
        elif asked and now_ns - reader.heard_ns >= SILENT_NS:
            reader.away_until_ns = now_ns + RETURN_NS
        elif reader.returned_ns and now_ns - reader.returned_ns < FLAPPING_NS:
            reader.away_until_ns = now_ns + FLAPPING_NS
        elif reader.answered:
            reader.away_until_ns = now_ns + FLAPPING_NS
            reader.is_cut_off = True
        else:
            del self.readers[gid]
        self._window_end = -1
        self._trim()
        self.pump()

    def _update_window(self) -> None:
        """Recompute `_window_end` after readers, or what they have, have changed."""
        ends = [reader.end for reader in self.readers.values() if not reader.away_until_ns]
        if ends:
            self._window_end = (min(ends) if self._keep_all else max(ends)) + WINDOW_BYTES
        else:
            self._window_end = NEVER if self.readers else -1

    # Writing

    def write(self, sequence: int, payload: bytes, extra: bytes) -> None:
        """Send a message now, or as soon as the window is open."""
        end = self._end + len(payload) + OVERHEAD_BYTES
        if end <= self._window_end and sequence == self._last + 1 and not self._unsent:
            # The common case: `_write_slowly` would do the same.
            self._last = self.sent = sequence
            self._end = self._sent_end = end
            self._sent_ns = self._now_ns()
            entries = self.entries
            entries.append((sequence, payload, extra, end))
            if len(entries) > self._limit or end - entries[0][3] > self._limit_bytes:
                self._drop_oldest()
            self._put(payload, extra)
        elif self.readers or self._unsent:
            self._write_slowly((sequence, payload, extra, end))
        else:
            self._last = self.sent = sequence
            self._jumped_to = sequence + 1
            self._put(payload, extra)

    def _write_slowly(self, entry: Entry) -> None:
        """Send a message after a jump of sequence numbers, or as the window permits."""
        sequence = entry[0]
        readers_changed = self._window_end < 0
        if readers_changed:
            self._update_window()
        if sequence != self._last + 1:
            self._jumped_to = sequence
            for reader in self.readers.values():
                self._gap(reader, self._last + 1, sequence - 1)
        self._last = sequence
        self._end = entry[3]
        self.entries.append(entry)
        self._unsent.append(entry)
        # Behind a waiting message, only an acknowledgement opens the window, and that also pumps.
        if len(self._unsent) == 1 or readers_changed or self.has_other_readers:
            self.pump()
        self._drop_oldest()

    def _drop_oldest(self) -> None:
        """Drop messages beyond the limits; a KEEP_ALL writer checks `has_room` instead."""
        entries, limit_bytes = self.entries, NEVER if self._keep_all else self._limit_bytes
        while len(entries) > self._limit or self._end - entries[0][3] > limit_bytes:
            oldest = entries.popleft()[0]
            if oldest > self.sent:  # no reader gets it
                self._unsent.popleft()
                self._lose(oldest, oldest)

    def write_stop(
        self, sequence: int, payload: bytes, extra: bytes, put: Callable[[bytes, bytes], None]
    ) -> None:
        """Send the last message of a lease immediately, dropping messages waiting for the window.

        Args:
            sequence: Its number.
            payload: Its bytes.
            extra: Its attachment.
            put: Sends it to every reader, unless it was already sent.
        """
        if self._unsent:
            first, last = self._unsent[0][0], self._unsent[-1][0]
            while self.entries and self.entries[-1][0] >= first:
                self.entries.pop()
            self._unsent.clear()
            self._lose(first, last)
        if sequence != self.sent + 1:
            self._jumped_to = sequence
            for reader in self.readers.values():
                self._gap(reader, self.sent + 1, sequence - 1)
        end = self._end + len(payload) + OVERHEAD_BYTES
        self._last = self.sent = sequence
        self._sent_ns = self._now_ns()
        if self.readers:
            self._end = self._sent_end = end
            self.entries.append((sequence, payload, extra, end))
            self._drop_oldest()
        else:
            self._jumped_to = sequence + 1
        put(payload, extra)

    def _lose(self, first: int, last: int) -> None:
        """Report lost messages, each sequence number once."""
        count = last - first + 1
        if count <= 0:
            return
        disjoint: list[tuple[int, int]] = []
        begin, end = first, last
        for lost in self._lost:
            if lost[1] < first - 1 or lost[0] > last + 1:
                disjoint.append(lost)
            else:
                count -= max(min(lost[1], last) - max(lost[0], first) + 1, 0)
                begin, end = min(begin, lost[0]), max(end, lost[1])
        self._lost = [*disjoint, (begin, end)]
        if count:
            self._output.lost(count)

    def _admits(self, entry: Entry) -> bool:
        """Return whether the window is open for the next message."""
        if self.has_other_readers and not self._keep_all:
            return True
        sequence, _, _, end = entry
        is_read = False
        for reader in self.readers.values():
            if reader.away_until_ns:
                continue
            is_read = True
            is_open = (
                reader.acked >= self.sent  # `end` includes messages that were dropped unsent
                or end - reader.end <= WINDOW_BYTES
                or sequence - reader.acked <= WINDOW_MESSAGES
            )
            if is_open is not self._keep_all:
                return is_open  # KEEP_LAST waits only if all lag, KEEP_ALL if one does
        return self._keep_all or not is_read

    def pump(self) -> None:
        """Send waiting messages as far as the window is open."""
        unsent = self._unsent
        if self._pumping or not unsent:
            return
        self._pumping = True
        sent = self.sent
        try:
            while unsent and (unsent[0][3] <= self._window_end or self._admits(unsent[0])):
                self.sent, payload, extra, self._sent_end = unsent.popleft()
                self._put(payload, extra)
        finally:
            self._pumping = False
        if self.sent != sent:
            self._sent_ns = self._now_ns()
        if not self.readers:
            self._trim()

    def has_room(self) -> bool:
        """Return whether another message can be kept without dropping one.

        A KEEP_ALL writer first drops the messages that only cut-off readers lack.
        """
        if not self._is_full:
            return True
        if self._keep_all:
            for reader in self.readers.values():
                if reader.is_cut_off:
                    reader.acked, reader.end = self.sent, self._sent_end
            self._trim()
        return not self._is_full

    @property
    def _is_full(self) -> bool:
        entries = self.entries
        return bool(entries) and (
            len(entries) >= self._depth or self._end - entries[0][3] >= self._limit_bytes
        )

    @property
    def done(self) -> bool:
        """Whether every reader has acknowledged everything, except for those that were cut off."""
        return not self.entries or self.entries[-1][0] <= self._acked

    @property
    def unsent(self) -> bool:
        """Whether a message waits for the window to open."""
        return bool(self._unsent)

    # Acknowledgements

    def acknack(self, submessage: Submessage) -> None:
        """Handle an ACKNACK of a reader, if that is known."""
        reader = self.readers.get(submessage.reader)
        if reader is None:
            return
        first, ranges = submessage.first, submessage.ranges()
        reader.answered = True
        now_ns = reader.heard_ns = self._now_ns()
        if self.sent >= first - 1 > reader.acked:
            reader.acked = first - 1
            reader.end = self._end_of(reader.acked)
            reader.interval_ns = QUIET_NS
            if reader.resent:
                reader.resent = {n: at for n, at in reader.resent.items() if n > reader.acked}
            self._update_window()
            self._trim()
        if ranges:
            self._resend(reader, ranges, now_ns)
        self.pump()

    def _end_of(self, sequence: int) -> int:
        """Return the `Entry.end` of the last message up to a sequence number that was sent."""
        entries = self.entries
        if sequence >= self.sent or not entries:
            return self._sent_end
        index = self._index(sequence + 1)
        if index:
            return entries[index - 1][3]
        _, payload, _, end = entries[0]  # it was dropped, and only newer ones are left
        return end - len(payload) - OVERHEAD_BYTES

    def _index(self, sequence: int) -> int:
        """Return the index of the first entry from a sequence number on."""
        entries = self.entries
        guess = sequence - entries[0][0] if entries else 0
        if guess <= 0:
            return 0
        if guess < len(entries) and entries[guess][0] == sequence:  # no jump in between
            return guess
        return bisect_left(entries, sequence, hi=min(guess, len(entries)), key=itemgetter(0))

    def _resend(self, reader: ReaderProxy, ranges: list[tuple[int, int]], now_ns: int) -> None:
        """Resend what a reader lacks, and announce a gap for what is no longer kept."""
        left = RESEND_BYTES
        entries = self.entries
        for begin, end in ranges[:MAX_RANGES]:
            first, last = max(begin, reader.acked + 1), min(end, self.sent)
            oldest = entries[0][0] if entries else NEVER
            if first < oldest:
                absent = min(last, oldest - 1)
                if absent >= first:
                    if any(
                        n <= absent and now_ns - at < RESEND_NS for n, at in reader.resent.items()
                    ):
                        return  # it was resent before it was dropped, and may be on its way
                    self._lose(max(first, self._jumped_to), absent)
                    self._gap(reader, first, absent)
                first = absent + 1
            number, index = first, self._index(first)
            while number <= last:
                following = entries[index][0] if index < len(entries) else NEVER
                if following != number:  # sequence numbers jumped here
                    after = min(following, last + 1)
                    self._gap(reader, number, after - 1)
                    number = after
                    continue
                if now_ns - reader.resent.get(number, -RESEND_NS) >= RESEND_NS:
                    reader.resent[number] = now_ns
                    self._send_again(reader, entries[index])
                    left -= len(entries[index][1]) + OVERHEAD_BYTES
                    if left <= 0:
                        return
                number += 1
                index += 1

    def _trim(self) -> None:
        """Drop what every reader has."""
        if not (self.entries or self._lost):
            return
        acked = min((reader.acked for reader in self.readers.values()), default=self.sent)
        entries, through = self.entries, min(acked, self.sent)
        while entries and entries[0][0] <= through:
            entries.popleft()
        if len(self._lost) > LOST_RANGES:
            self._lost = [lost for lost in self._lost if lost[1] > acked]

    # Time

    def tick(self) -> bool:
        """Send the heartbeats that are due; return whether to call again."""
        now_ns = self._now_ns()
        is_quiet = now_ns - self._sent_ns >= QUIET_NS
        unanswered = 0
        for reader in list(self.readers.values()):
            if reader.away_until_ns:
                if now_ns >= reader.away_until_ns or self._has_ended(reader, now_ns):
                    self._give_up(reader)
            elif reader.acked < self.sent:
                if not reader.answered:
                    reader.asked_ticks += 1
                    if reader.asked_ticks > MUTE_TICKS:
                        self._output.mute(reader)
                        self._give_up(reader)
                        continue
                waited_ns = now_ns - reader.heartbeat_ns
                if waited_ns >= HEARTBEAT_NS or (is_quiet and waited_ns >= reader.interval_ns):
                    if not reader.answered:
                        unanswered += 1
                        if unanswered > UNANSWERED_EACH_TICK:
                            continue
                        self.readers[reader.gid] = self.readers.pop(reader.gid)  # others are next
                    reader.heartbeat_ns = now_ns
                    reader.interval_ns = min(reader.interval_ns * 2, HEARTBEAT_NS)
                    self._heartbeat(reader, reader.acked + 1, self.sent)
        return bool(self.entries) or any(reader.away_until_ns for reader in self.readers.values())

    def _has_ended(self, reader: ReaderProxy, now_ns: int) -> bool:
        """Return whether an absent reader was considered cut off, but still has a connection."""
        waited_ns = now_ns - (reader.away_until_ns - FLAPPING_NS)
        is_known = reader.is_cut_off and waited_ns >= KNOWN_NS
        return is_known and not self._has_lost(reader.participant)

    def _give_up(self, reader: ReaderProxy) -> None:
        """Stop waiting for a reader; it has lost what it lacks, unless it has ended."""
        del self.readers[reader.gid]
        if not reader.is_cut_off:
            self._lose(max(reader.acked + 1, self._jumped_to), self.sent)
        self._update_window()
        self._trim()
        self.pump()

    def probe(self) -> bool:
        """Ask readers that have everything for an answer; return whether to call again.

        Must be called more often than every `SILENT_NS` for a KEEP_ALL writer, for which the
        silence of a reader that vanishes means that it may return.
        """
        now_ns = self._now_ns()
        for reader in self.readers.values():
            if (
                not reader.away_until_ns
                and reader.acked >= self.sent
                and now_ns - reader.heard_ns >= UNHEARD_NS
            ):
                self._heartbeat(reader, reader.acked + 1, self.sent)
        return bool(self.readers)

    @property
    def _acked(self) -> int:
        """The last message that all readers have, not counting those that were cut off."""
        readers = self.readers.values()
        return min((reader.acked for reader in readers if not reader.is_cut_off), default=self.sent)

    def give_up(self) -> int:
        """Drop everything; return how many messages some reader does not have."""
        acked = self._acked
        missing = sum(1 for entry in self.entries if entry[0] > acked)
        self.entries.clear()
        self._unsent.clear()
        self.readers.clear()
        self.sent = self._last
        self._update_window()
        return missing
