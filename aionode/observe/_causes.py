"""Why something was sent: its causes, queried from the processes that took part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import msgspec

from aionode.clock import perf_ns
from aionode.engine.cause_reports import (
    MAX_TOLD,
    CauseQuestion,
    CauseReport,
    Key,
    RunReport,
    SentReport,
    answer,
    clock_id,
    decoded,
    encoded,
    is_internal,
)
from aionode.engine.causes import MAX_CAUSES, Kind
from aionode.graph import EndpointKind
from aionode.names import is_hidden
from aionode.observe._snapshot import ANSWER_S

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from aionode.node import Node

__all__ = ["Cause", "Caused", "Findings", "Sender", "Why", "named_in", "senders_in", "why"]

MAX_ROUNDS: Final = 64
"""Maximum number of rounds of questions for earlier causes, hence of processes in a chain."""

MAX_ENTRIES: Final = 1000
"""Maximum number of sent items that are traced back."""

MAX_DRAWN: Final = 2 * MAX_ENTRIES
"""Maximum number of sent items that a tree shows with their causes."""

Unknown: TypeAlias = Literal[
    "", "no aionode", "older", "silent", "not kept", "not sent", "forgotten", "above", "too far",
    "hidden",
]  # fmt: skip
"""Why the causes of an item are unknown: its process does not use aionode, has too old a version,
does not answer, keeps no causes, or has sent nothing yet; it was too long ago; they are shown
above; the chain is too long; the client may not see them. Empty if they are known.
"""


class Cause(msgspec.Struct, frozen=True):
    """A callback that sent something, or something that a task had awaited before it sent.

    Attributes:
        node: The full name of its node.
        party: What received the input, such as ``subscription``, ``timer`` or ``action server``.
        name: The topic, service or action; for a timer, its period.
        callback: The name of the callback; empty if a task awaited the input.
        waited_ns: How long the input had waited until then, in nanoseconds.
        ran_ns: How long the callback had run when it sent, in nanoseconds.
        source: The input; None for a timer that was not started by a callback.
    """

    node: str
    party: str
    name: str
    callback: str
    waited_ns: int
    ran_ns: int
    source: Caused | None


class Caused(msgspec.Struct, frozen=True):
    """Something that was sent, and what caused it.

    Attributes:
        kind: ``message``, ``request``, ``response``, ``goal``, or ``timer`` for the start of one.
        name: The topic, service or action; for a timer, its period.
        node: The full name of the node that sent it; empty if unknown.
        gid: The gid of its publisher or client, in hexadecimal.
        sequence: Its sequence number.
        ago_ns: How long ago it was sent, in nanoseconds; if that is unknown, how long ago it was
            received; None if neither is known.
        causes: What caused it; empty if it was not sent by a callback.
        unknown: Why its causes are unknown; empty if they are known.
    """

    kind: Kind
    name: str
    node: str
    gid: str
    sequence: int
    ago_ns: int | None
    causes: tuple[Cause, ...] = ()
    unknown: Unknown = ""


class Why(msgspec.Struct):
    """What led to the latest item with a name.

    Attributes:
        name: The requested name.
        sent: The item sent last; for a node, the last one of each topic, service and action.
        not_kept: Contexts that keep no causes, each with the names of its nodes.
        silent: Contexts that did not answer, in the same form.
        older: Contexts whose version of aionode cannot keep causes.
        unreadable: Contexts whose answer this version cannot read.
    """

    name: str
    sent: list[Caused] = []
    not_kept: dict[str, list[str]] = {}
    silent: dict[str, list[str]] = {}
    older: dict[str, list[str]] = {}
    unreadable: dict[str, list[str]] = {}


async def why(node: Node, name: str, *, timeout_sec: float = ANSWER_S) -> Why:
    """Return what led to the latest message, call or goal with a name, or of a node.

    All aionode processes are asked for it, and then those that sent its causes, process by process.
    Times are by the clock of each process, and ages are as of its answer: between hosts they are
    off by the time that the answer took. Cancelling is safe.

    Args:
        node: A running node.
        name: The name of a topic, service, action or node, or the id of a goal in hexadecimal.
        timeout_sec: Maximum time to wait for the answers of a process, in seconds.
    """
    inquiry = Inquiry(node, name, timeout_sec)
    await inquiry.ask(CauseQuestion(name), None)
    roots = inquiry.roots()
    for _ in range(MAX_ROUNDS):
        keys = inquiry.missing()
        if not keys or len(inquiry.sent) >= MAX_ENTRIES:
            break
        owners = {owner for owners in keys.values() for owner in owners}
        await inquiry.ask(CauseQuestion(keys=list(keys)), owners)
    inquiry.found.sent = [inquiry.caused(entry, ()) for entry in roots] or inquiry.leaves()
    return inquiry.found


class Sender(msgspec.Struct, array_like=True, frozen=True):
    """An endpoint in the graph, which may have sent something.

    Attributes:
        gid: Its gid.
        kind: What it is.
        name: Its topic or service.
        node: The full name of its node.
        participant: The context of its node.
    """

    gid: bytes
    kind: EndpointKind
    name: str
    node: str
    participant: str


def senders_in(node: Node) -> list[Sender]:
    """Return all endpoints that a node sees."""
    return [
        Sender(
            each.gid, each.kind, each.name, each.node.fully_qualified_name, each.node.participant
        )
        for each in node.graph.endpoints()
    ]  # fmt: skip


def named_in(node: Node) -> dict[str, list[str]]:
    """Return the nodes of each context that a node sees, except hidden ones."""
    named: dict[str, list[str]] = {}
    for info in node.graph.nodes():
        if not is_hidden(info.fully_qualified_name):
            named.setdefault(info.participant, []).append(info.fully_qualified_name)
    return {participant: sorted(names) for participant, names in named.items()}


class Findings:
    """The answers of processes, from which the tree of causes is built.

    Attributes:
        found: The result, without the tree.
        sent: The sent items with their reports, by key.
        now_ns: The moment from which ages count back.
        senders: The endpoints of the graph, by gid.
        named: The nodes of each context.
        offsets: The offset from the clock of each context to that of `now_ns`.
    """

    def __init__(self, name: str, now_ns: int) -> None:
        self.found = Why(name)
        self.sent: dict[Key, tuple[SentReport, CauseReport]] = {}
        self.now_ns = now_ns
        self.senders: dict[bytes, Sender] = {}
        self.named: dict[str, list[str]] = {}
        self.offsets: dict[str, int] = {}
        self._drawn: set[Key] = set()

    def note(self, report: CauseReport, offset_ns: int) -> None:
        """Record who answered, and the offset of its clock."""
        nodes = self.named.get(report.participant, [])
        if not report.is_kept and nodes:
            self.found.not_kept[report.participant] = nodes
        known = self.offsets.get(report.participant, offset_ns)
        self.offsets[report.participant] = min(known, offset_ns)

    def roots(self) -> list[SentReport]:
        """Return the requested items: the latest with the name; for a node, one of each name."""
        full = "/" + self.found.name.lstrip("/")
        entries = [
            entry
            for entry, _ in self.sent.values()
            if entry.name == full or (entry.goal and entry.goal == self.found.name)
        ]
        if entries:
            return [max(entries, key=self._at_ns)]
        latest: dict[tuple[str, str], SentReport] = {}
        for entry, _ in self.sent.values():
            if entry.node == full and entry.kind != "timer" and not is_internal(entry.name):
                key = entry.kind, entry.name
                if key not in latest or self._at_ns(latest[key]) < self._at_ns(entry):
                    latest[key] = entry
        return sorted(latest.values(), key=self._at_ns, reverse=True)

    def _servers(self, run: RunReport) -> list[Sender]:
        return [
            each
            for each in self.senders.values()
            if each.kind is EndpointKind.SERVER and each.name == run.name
        ]

    def _at_ns(self, entry: SentReport) -> int:
        _, report = self.sent[entry.kind, entry.gid, entry.sequence]
        return entry.at_ns + self.offsets[report.participant]

    def caused(self, entry: SentReport, above: tuple[Key, ...]) -> Caused:
        """Return a sent item with its causes."""
        key = entry.kind, entry.gid, entry.sequence
        _, report = self.sent[key]
        is_known = key not in self._drawn and not (
            len(above) >= MAX_ROUNDS * 2 or len(self._drawn) >= MAX_DRAWN
        )
        unknown: Unknown = "" if is_known else "above" if key in self._drawn else "too far"
        self._drawn.add(key)
        causes = (
            self._cause(entry, run, report, (*above, key)) for run in entry.causes[:MAX_CAUSES]
        )
        return Caused(
            entry.kind,
            entry.name,
            entry.node,
            entry.gid.hex(),
            entry.sequence,
            max(self.now_ns - self._at_ns(entry), 0),
            tuple(causes) if is_known else (),
            unknown if entry.causes else "",
        )

    def _cause(
        self, entry: SentReport, run: RunReport, report: CauseReport, above: tuple[Key, ...]
    ) -> Cause:
        return Cause(
            run.node,
            run.party,
            run.name,
            run.callback,
            max(run.began_ns - run.entered_ns, 0),
            max(entry.at_ns - run.began_ns, 0),
            self._source(run, report, above),
        )

    def _source(self, run: RunReport, report: CauseReport, above: tuple[Key, ...]) -> Caused | None:
        """Return the input of a run; None for a timer that was not started by a callback."""
        known = self.sent.get((run.kind, run.gid, run.sequence))
        if known is not None:
            return self.caused(known[0], above)
        if run.kind == "timer" and not run.sequence:
            return None
        arrived_ns = run.entered_ns + self.offsets[report.participant]
        senders = self._servers(run) if run.kind == "response" else []
        if run.gid in self.senders and run.kind != "response":
            senders = [self.senders[run.gid]]
        return Caused(
            run.kind,
            run.name,
            senders[0].node if senders else "",
            run.gid.hex(),
            run.sequence,
            max(self.now_ns - arrived_ns, 0),
            unknown=self._reason(senders[0].participant) if senders else "forgotten",
        )

    def _reason(self, participant: str, kept: Unknown = "forgotten") -> Unknown:
        """Return why a context reported no causes; `kept` if it keeps them."""
        reasons: tuple[tuple[Unknown, Iterable[str]], ...] = (
            ("not kept", self.found.not_kept),
            ("silent", self.found.silent),
            ("older", (*self.found.older, *self.found.unreadable)),
            (kept, self.offsets),
        )
        return next((reason for reason, those in reasons if participant in those), "no aionode")

    def leaves(self) -> list[Caused]:
        """Return the endpoints that send with the name, when no item of theirs is known."""
        full = "/" + self.found.name.lstrip("/")
        kinds: dict[EndpointKind, Kind] = {
            EndpointKind.PUBLISHER: "message",
            EndpointKind.CLIENT: "request",
        }
        return [
            Caused(
                kinds[each.kind], each.name, each.node, each.gid.hex(), 0,
                None, unknown=self._reason(each.participant, "not sent"),
            )
            for each in self.senders.values()
            if each.name == full and each.kind in kinds and not is_hidden(
                each.node
            )
        ]  # fmt: skip


class Inquiry(Findings):
    """The answers of the processes so far, and further questions to them."""

    def __init__(self, node: Node, name: str, timeout_sec: float) -> None:
        super().__init__(name, perf_ns())
        self._node = node
        self._timeout_sec = timeout_sec
        self._asked: set[Key] = set()
        self.senders = {each.gid: each for each in senders_in(node)}
        self.named = named_in(node)

    async def ask(self, question: CauseQuestion, participants: Collection[str] | None) -> None:
        """Ask some contexts, or all of them, and keep their answers."""
        self._asked.update(question.keys)
        context = self._node.context
        if participants is None or context.participant in participants:
            self._keep(answer(context.causes, context.participant, question))
        gone = {*self.found.silent, *self.found.older, *self.found.unreadable}
        others = None if participants is None else set(participants) - gone - {context.participant}
        if others is not None and not others:
            return
        data = encoded(question)
        for transport in context.transports:
            told = await transport.observe("causes", data, self._timeout_sec, others)
            for participant, told_of in told.items():
                self._take(participant, told_of)

    def _take(self, participant: str, told: bytes | None) -> None:
        nodes = self.named.get(participant, [])
        if told is None:
            if nodes:  # others have just ended, or are tools
                self.found.silent[participant] = nodes
        elif not told:
            self.found.older[participant] = nodes
        elif (report := decoded(told)) is not None and report.participant == participant:
            self._keep(report)
        else:
            self.found.unreadable[participant] = nodes

    def _keep(self, report: CauseReport) -> None:
        self.note(report, 0 if report.clock == clock_id() else perf_ns() - report.now_ns)
        for entry in report.sent:
            sender = None if entry.kind == "response" else self.senders.get(entry.gid)
            if sender is None or sender.participant == report.participant:
                self.sent[entry.kind, entry.gid, entry.sequence] = entry, report

    def missing(self) -> dict[Key, list[str]]:
        """Return earlier items that were not asked for yet, with the contexts that may know them.

        At most as many as fit into one question; the next call returns more.
        """
        found: dict[Key, list[str]] = {}
        for entry, _ in self.sent.values():
            for run in entry.causes:
                if len(found) == MAX_TOLD:
                    return found
                key = run.kind, run.gid, run.sequence
                if key not in self.sent and key not in self._asked and run.kind != "timer":
                    owners = self._owners(run)
                    self._asked.add(key)
                    if owners:
                        found[key] = owners
        return found

    def _owners(self, run: RunReport) -> list[str]:
        """Return the contexts that may have sent the input of a run."""
        if run.kind == "response":
            return sorted({each.participant for each in self._servers(run)})
        sender = self.senders.get(run.gid)
        return [] if sender is None else [sender.participant]
