"""Causes in a recording: the reports of processes, and answers from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeVar

import msgspec

from aionode._process.recent import Recent
from aionode.clock import perf_ns
from aionode.engine.cause_reports import (
    MAX_AT_ONCE,
    MAX_REPORT,
    UNREADABLE,
    CauseReport,
    Key,
    SentReport,
)
from aionode.engine.causes import MAX_SENDERS, Kind
from aionode.observe._causes import Findings, Sender, Why, named_in, senders_in
from aionode.observe._following import Following

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = ["CauseRecorder", "RecordedCauses"]

MAX_READ: Final = 100_000
"""How many of the latest sent items are kept while a recording is read."""

MAX_ENDPOINTS: Final = 20_000
"""How many endpoints, and how many contexts, are kept while a recording is read."""

MAX_BYTES: Final = 128 << 20
"""Maximum bytes of each kind of them, as JSON, since anyone may have written a recording."""

K = TypeVar("K")
V = TypeVar("V")


class CauseRecord(msgspec.Struct):
    """The answer of one context or, without a report, the graph after all were asked.

    Attributes:
        now_ns: The time of the answer, by the steady clock of the recorder.
        time_ns: The same, by the clock of the recorder's node, as in the recording.
        report: The answer of a context, without its runs.
        offset_ns: The offset from the clock of that context to the recorder's.
        named: The nodes of each context.
        senders: The endpoints of the graph.
        silent: The contexts that did not answer.
        older: Contexts whose version of aionode cannot keep causes.
        unreadable: Contexts whose answer could not be read.
    """

    now_ns: int
    time_ns: int
    report: CauseReport | None = None
    offset_ns: int = 0
    named: dict[str, list[str]] = {}
    senders: list[Sender] = []
    silent: list[str] = []
    older: list[str] = []
    unreadable: list[str] = []


RECORDS: Final = msgspec.json.Decoder(CauseRecord)


class RecentParts(Recent[K, V]):
    """Parts of records, of which the oldest are evicted by their number and their size.

    Args:
        max_keys: The maximum number of keys.
    """

    __slots__ = ("_bytes", "_sizes")

    def __init__(self, max_keys: int) -> None:
        super().__init__(max_keys)
        self._sizes: dict[K, int] = {}
        self._bytes = 0

    def put_part(self, key: K, value: V, part: Any) -> None:
        """Set the value of a key, which is as large as a part of a record."""
        if key not in self and len(self) == self._max_keys:
            self._evict()
        size = len(msgspec.json.encode(part))
        self._bytes += size - self._sizes.get(key, 0)
        self._sizes[key] = size
        self[key] = value
        while self._bytes > MAX_BYTES:
            self._evict()

    def _evict(self) -> None:
        oldest = next(iter(self))
        del self[oldest]
        self._bytes -= self._sizes.pop(oldest)


class CauseRecorder(Following):
    """Asks the processes repeatedly for the causes kept since the last time.

    Args:
        node: A running node. It is not listed among those that keep no causes.
    """

    def __init__(self, node: Node) -> None:
        super().__init__(node)
        self._texts: list[str] = []

    def add(self, report: CauseReport) -> None:
        """Process an answer; one that could not be read from a recording counts as unreadable."""
        participant = report.participant
        told = msgspec.structs.replace(report, runs=[], sent=report.sent[:MAX_AT_ONCE])
        text = encoded(CauseRecord(*self._now(), told, self.offsets[participant]))
        if decoded(text) is None:
            self.unreadable.put(participant, self.nodes_of(participant))
        else:
            self._texts.append(text)

    async def texts(self) -> list[str]:
        """Ask all processes once; return what to record, as texts for `RecordedCauses`.

        The first texts contain all that is still kept, later ones what is new. Cancelling is safe.
        """
        await self.look(0)
        named = named_in(self._node)
        own = self._node.context.participant
        name = self._node.get_fully_qualified_name()
        named[own] = [each for each in named.get(own, []) if each != name]
        graph = CauseRecord(
            *self._now(),
            named=named,
            senders=senders_in(self._node)[:MAX_ENDPOINTS],
            silent=list(self.silent),
            older=list(self.older),
            unreadable=list(self.unreadable),
        )
        texts, self._texts = [*self._texts, encoded(graph)], []
        return texts

    def _now(self) -> tuple[int, int]:
        """Return the time by both clocks of the recorder."""
        return perf_ns(), self._node.get_clock().now_ns()


class RecordedCauses:
    """The causes in a recording, which is read in order of time.

    The latest 100,000 sent items are kept, and the last one of each sender, at most 128 MiB of JSON
    each.
    """

    def __init__(self) -> None:
        self._sent: RecentParts[Key, tuple[SentReport, CauseReport]] = RecentParts(MAX_READ)
        self._last: RecentParts[tuple[Kind, bytes, str], tuple[SentReport, CauseReport]] = (
            RecentParts(MAX_SENDERS)
        )
        self._reports: RecentParts[str, tuple[CauseReport, int]] = RecentParts(MAX_ENDPOINTS)
        self._named: RecentParts[str, list[str]] = RecentParts(MAX_ENDPOINTS)
        self._senders: RecentParts[bytes, Sender] = RecentParts(MAX_ENDPOINTS)
        self._graph = CauseRecord(0, 0)  # the latest
        self._moment = 0, 0  # the time of the last record, by both clocks

    def add(self, text: str) -> bool:
        """Read a text; return whether a `CauseRecorder` of this version wrote it."""
        record = decoded(text)
        if record is None:
            return False
        self._moment = record.now_ns, record.time_ns
        if record.report is None:
            self._graph = record
            for participant, names in record.named.items():
                self._named.put_part(participant, names, names)
            for sender in record.senders:
                self._senders.put_part(sender.gid, sender, sender)
            return True
        report = msgspec.structs.replace(record.report, sent=[])
        offset_ns = record.offset_ns
        if report.participant in self._reports:
            offset_ns = min(offset_ns, self._reports[report.participant][1])
        self._reports.put_part(report.participant, (report, offset_ns), report)
        for entry in record.report.sent:
            self._sent.put_part((entry.kind, entry.gid, entry.sequence), (entry, report), entry)
            self._last.put_part((entry.kind, entry.gid, entry.name), (entry, report), entry)
        return True

    def why(self, name: str, at_ns: int | None = None) -> Why:
        """Return what `observe.why` would have answered at a time.

        Args:
            name: The name of a topic, service, action or node, or the id of a goal in hexadecimal.
            at_ns: The time, by the clock of the recording; by default that of the last text.
        """
        now_ns, time_ns = self._moment
        findings = Findings(name, now_ns if at_ns is None else now_ns - (time_ns - at_ns))
        findings.senders = self._senders
        findings.named = self._named
        for report, offset_ns in self._reports.values():
            findings.note(report, offset_ns)
        found = findings.found
        for those, participants in (
            (found.silent, self._graph.silent),
            (found.older, self._graph.older),
            (found.unreadable, self._graph.unreadable),
        ):
            those.update({each: self._named.get(each, []) for each in participants})
        found.silent = {each: names for each, names in found.silent.items() if names}
        for entry, report in (*self._last.values(), *self._sent.values()):
            offset = findings.offsets.get(report.participant)
            if offset is not None and entry.at_ns + offset <= findings.now_ns:
                findings.sent[entry.kind, entry.gid, entry.sequence] = entry, report
        found.sent = [findings.caused(each, ()) for each in findings.roots()] or findings.leaves()
        return found


def encoded(record: CauseRecord) -> str:
    """Return a record as text."""
    return msgspec.json.encode(record).decode()


def decoded(text: str) -> CauseRecord | None:
    """Return the record in a text; None if this version cannot read it."""
    if len(text) > MAX_REPORT:
        return None
    try:
        record = RECORDS.decode(text)
        msgspec.msgpack.encode(record)  # refuses integers of more than 64 bits
    except (*UNREADABLE, UnicodeEncodeError, OverflowError):
        return None
    return record
