"""What a context reports from its log of causes when a tool asks: entries, or the latest runs."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, TypeAlias, TypeVar

import msgspec

from aionode.clock import perf_ns
from aionode.engine.causes import Kind
from aionode.engine.observation import unchanging

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.engine.causes import CauseLog, Party, Run, Sent

__all__ = [
    "CauseQuestion",
    "CauseReport",
    "RunReport",
    "SentReport",
    "answer",
    "asked",
    "decoded",
    "encoded",
]

MAX_REPORT: Final = 16 * 2**20
"""Maximum bytes of an answer of another process."""

MAX_TOLD: Final = 200
"""Maximum number of entries in the answer to a question for single ones and their causes."""

MAX_AT_ONCE: Final = 1000
"""Maximum number of runs, and of entries, in the answer to a question for all."""

T = TypeVar("T")

Word: TypeAlias = Annotated[str, msgspec.Meta(max_length=1000)]
"""A text of bounded length, such as a name: more than any that ROS allows."""

Key = tuple[Kind, bytes, int]
"""What identifies a sent item: its kind, gid and sequence number."""


class CauseQuestion(msgspec.Struct, array_like=True):
    """The question of a tool.

    Attributes:
        name: The topic, service, action, node or goal whose latest sent item to get.
        keys: The keys of entries to get.
        since: The numbers from which to get all runs and entries; None for none.
    """

    name: str = ""
    keys: list[Key] = []
    since: tuple[int, int] | None = None


class RunReport(msgspec.Struct, array_like=True):
    """One call of a callback, or an item that a task has awaited.

    Attributes:
        kind: Its input: ``message``, ``request``, ``response``, ``goal`` or ``timer``.
        party: What received the input, such as ``subscription``.
        node: The full name of its node.
        name: The topic, service or action; the period of a timer.
        callback: The name of the callback; empty if it was awaited.
        gid: The gid of the input.
        sequence: Its sequence number.
        entered_ns: When it arrived, by the clock of the process.
        began_ns: When the callback was called.
        ended_ns: When the callback had ended; 0 if it has not.
    """

    kind: Kind
    party: Word
    node: Word
    name: Word
    callback: Word
    gid: bytes
    sequence: int
    entered_ns: int
    began_ns: int
    ended_ns: int


class SentReport(msgspec.Struct, array_like=True):
    """A sent item.

    Attributes:
        kind: What it is; for ``timer``, its start by a callback.
        party: What sent it, such as ``publisher``.
        node: The full name of its node.
        name: The topic, service or action; the period of a timer.
        gid: Its gid.
        sequence: Its sequence number.
        at_ns: When it was sent, by the clock of the process.
        causes: The runs that caused it.
        goal: The id of the goal that it is about, in hexadecimal; empty if none.
    """

    kind: Kind
    party: Word
    node: Word
    name: Word
    gid: bytes
    sequence: int
    at_ns: int
    causes: list[RunReport]
    goal: Word = ""


class CauseReport(msgspec.Struct):
    """The answer of one context.

    Attributes:
        participant: The id of the context in the graph, in hexadecimal.
        host: The name of the host.
        pid: The id of the process.
        program: The command line, shortened.
        clock: Identifies the clock: processes with the same text share one.
        now_ns: The time of the answer, by that clock.
        is_kept: Whether it keeps causes at all.
        sent: The sent items, the oldest first.
        runs: Runs that have ended, in the order of their ends.
        begin: The numbers of the first run and the first entry that were still kept.
        next: The numbers of the next ones.
    """

    participant: Word
    host: Word
    pid: int
    program: Word
    clock: Word
    now_ns: int
    is_kept: bool
    sent: list[SentReport] = []
    runs: list[RunReport] = []
    begin: tuple[int, int] = (0, 0)
    next: tuple[int, int] = (0, 0)


@cache
def clock_id() -> str:
    """Return the identity of the clock, which is shared by all processes of one boot."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    except OSError:
        return f"{unchanging()['host']} {os.getpid()}"


def answer(log: CauseLog | None, participant: str, question: CauseQuestion) -> CauseReport:
    """Return the answer of a context with a log of causes, or with None if it keeps none."""
    same = unchanging()
    report = CauseReport(
        participant, same["host"], os.getpid(), same["program"], clock_id(), perf_ns(),
        log is not None,
    )  # fmt: skip
    if log is None:
        return report
    if question.since is not None:
        add_all(report, log, question.since)
        return report
    entries = log.everything()
    by_key = {key_of(sent): sent for sent in entries}
    wanted = [by_key[key] for key in question.keys[:MAX_TOLD] if key in by_key]
    if question.name:
        wanted += latest(entries, question.name)
    report.sent = [reported(sent) for sent in with_causes(wanted, by_key)]
    return report


def add_all(report: CauseReport, log: CauseLog, since: tuple[int, int]) -> None:
    """Add the kept runs and entries from the given numbers on, up to a limit."""
    first_run, runs = newer(list(log.runs), log.runs_counted, since[0])
    first_sent, sent = newer(list(log.sent), log.sent_counted, since[1])
    report.runs = [run_report(run) for run in runs]
    report.sent = [reported(each) for each in sent]
    report.begin = first_run, first_sent
    report.next = first_run + len(runs), first_sent + len(sent)


def newer(kept: list[T], count: int, since: int) -> tuple[int, list[T]]:
    """Return the number of the first kept item from `since` on, and the items from there."""
    oldest = count - len(kept)
    begin = min(max(since, oldest), count)
    return begin, kept[begin - oldest :][:MAX_AT_ONCE]


def key_of(sent: Sent) -> Key:
    """Return the key of a sent item."""
    return sent.kind, sent.gid, sent.sequence


def latest(entries: list[Sent], name: str) -> list[Sent]:
    """Return the latest entry with this name; for a node, the latest of each name."""
    full = "/" + name.lstrip("/")
    found: dict[str, Sent] = {}
    of_node: dict[tuple[str, str], Sent] = {}
    for sent in reversed(entries):
        if sent.kind == "timer":
            continue
        if sent.party.name == full or (sent.goal and sent.goal.hex() == name):
            found.setdefault(sent.kind, sent)
        elif sent.party.node == full and not is_internal(sent.party.name):
            of_node.setdefault((sent.kind, sent.party.name), sent)
    if found:
        return [max(found.values(), key=lambda sent: sent.at_ns)]
    return list(of_node.values())


def is_internal(name: str) -> bool:
    """Return whether a name belongs to the parts of an action, or to ROS itself."""
    return "/_action/" in name or name in {"/rosout", "/parameter_events"}


def with_causes(wanted: Iterable[Sent], by_key: dict[Key, Sent]) -> list[Sent]:
    """Return entries with everything that led to them in this process, the nearest first."""
    found: dict[Key, Sent] = {}
    left = list(wanted)
    for sent in left:  # which grows meanwhile
        if key_of(sent) in found or len(found) == MAX_TOLD:
            continue
        found[key_of(sent)] = sent
        for run in sent.causes:
            before = by_key.get((run.kind, run.gid, run.sequence))
            if before is not None:
                left.append(before)
    return list(found.values())


def run_report(run: Run) -> RunReport:
    """Return the report of a run."""
    party: Party = run.party
    return RunReport(
        run.kind, party.kind, party.node, party.name, party.callback() if run.is_call else "",
        run.gid, run.sequence, run.entered_ns, run.began_ns, run.ended_ns,
    )  # fmt: skip


def reported(sent: Sent) -> SentReport:
    """Return the report of an entry."""
    party = sent.party
    return SentReport(
        sent.kind, party.kind, party.node, party.name, sent.gid, sent.sequence, sent.at_ns,
        [run_report(run) for run in sent.causes], sent.goal.hex(),
    )  # fmt: skip


ENCODER: Final = msgspec.msgpack.Encoder()
QUESTIONS: Final = msgspec.msgpack.Decoder(CauseQuestion)
REPORTS: Final = msgspec.msgpack.Decoder(CauseReport)
UNREADABLE: Final = (msgspec.DecodeError, UnicodeDecodeError, RecursionError)


def encoded(told: CauseQuestion | CauseReport) -> bytes:
    """Return a question or an answer as bytes."""
    return ENCODER.encode(told)


def decoded(data: bytes) -> CauseReport | None:
    """Return the answer of another process; None if this version cannot read it."""
    if len(data) > MAX_REPORT:
        return None
    try:
        return REPORTS.decode(data)
    except UNREADABLE:
        return None


def asked(data: bytes) -> CauseQuestion:
    """Return a question of another process; an empty one if this version cannot read it."""
    try:
        return QUESTIONS.decode(data)
    except UNREADABLE:
        return CauseQuestion()
