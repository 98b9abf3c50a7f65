"""The callbacks of all processes on a common time axis, for Perfetto and Chrome."""

from __future__ import annotations

import heapq
from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.clock import S_TO_NS, perf_ns
from aionode.engine.cause_reports import encoded
from aionode.observe._following import AFTER_ALL, Following

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.engine.cause_reports import CauseReport, RunReport, SentReport
    from aionode.node import Node

__all__ = ["Trace", "record_trace"]

LOOK_S: Final = 0.2
"""The interval at which processes are asked, in seconds; each keeps 4096 callbacks meanwhile."""

MAX_EVENTS: Final = 1_000_000
"""Maximum number of callbacks and sent items in a trace."""

MAX_BYTES: Final = 256 << 20
"""Maximum bytes of the answers in a trace; a callback takes about 150."""


class Trace(msgspec.Struct):
    """What the processes did during a period.

    Attributes:
        events: The events in Chrome's trace event format, which Perfetto reads.
        callbacks: The number of callbacks in it.
        lost: How many callbacks and sent items are missing: they were no longer kept when asked
            for, or the trace was full.
        not_kept: Contexts that keep no causes, each with the names of its nodes.
        silent: Contexts that did not answer at the end, in the same form.
        older: Contexts whose version of aionode cannot keep causes, or reports them differently.
    """

    events: list[dict[str, Any]]
    callbacks: int = 0
    lost: int = 0
    not_kept: dict[str, list[str]] = {}
    silent: dict[str, list[str]] = {}
    older: dict[str, list[str]] = {}

    def to_json(self) -> bytes:
        """Return the file that https://ui.perfetto.dev and chrome://tracing open."""
        return msgspec.json.encode({"traceEvents": self.events, "displayTimeUnit": "ms"})


async def record_trace(node: Node, duration_sec: float) -> Trace:
    """Record the callbacks of all processes that keep causes, and what they send each other.

    Callbacks that are still running at the end are left out. Cancelling is safe.

    Args:
        node: A running node.
        duration_sec: The length of the trace, in seconds.
    """
    recording = Recording(node)
    await recording.look(AFTER_ALL)
    ends_ns = perf_ns() + round(duration_sec * S_TO_NS)
    while (left_s := (ends_ns - perf_ns()) / S_TO_NS) > 0:
        await node.get_clock().sleep(min(left_s, LOOK_S))
        await recording.look(0)
    return recording.trace()


class Recording(Following):
    """The answers of the processes so far, up to a limit."""

    def __init__(self, node: Node) -> None:
        super().__init__(node)
        self._runs: list[tuple[str, RunReport]] = []
        self._sent: list[tuple[str, SentReport]] = []
        self._bytes = 0

    def add(self, report: CauseReport) -> None:
        """Keep new items, up to a number and a size."""
        participant = report.participant
        room = MAX_EVENTS - len(self._runs) - len(self._sent)
        self._bytes += len(encoded(report))
        if self._bytes > MAX_BYTES:
            room = 0
        self.lost += max(len(report.runs) + len(report.sent) - room, 0)
        self._runs += [(participant, run) for run in report.runs[:room]]
        self._sent += [
            (participant, sent) for sent in report.sent[: max(room - len(report.runs), 0)]
        ]

    def trace(self) -> Trace:
        """Return the trace, whose time begins at its first event."""
        runs = [each for each in self._runs if each[0] in self.told]
        sent = [each for each in self._sent if each[0] in self.told]
        forgotten = len(self._runs) + len(self._sent) - len(runs) - len(sent)
        trace = Trace(
            [], len(runs), self.lost + forgotten, self.not_kept, self.silent,
            self.older | self.unreadable,
        )  # fmt: skip
        began_ns = min(
            [
                *(run.began_ns + self.offsets[participant] for participant, run in runs),
                *(entry.at_ns + self.offsets[participant] for participant, entry in sent),
            ],
            default=0,
        )
        zeros = {each: began_ns - offset for each, offset in self.offsets.items()}
        drawing = Drawing(trace.events, zeros)
        for participant, report in self.told.items():
            nodes = ", ".join(self.nodes_of(participant))
            drawing.add_process(
                participant, f"{nodes or report.program} ({report.host} {report.pid})"
            )
        drawing.add_runs(runs)
        drawing.add_sent(sent)
        return trace


class Lanes:
    """The tracks of an entity: callbacks that overlap are on different ones."""

    def __init__(self) -> None:
        self._busy: list[tuple[int, int]] = []  # when each ends, and its track; a heap
        self._free: list[int] = []  # a heap as well

    def take(self, began_ns: int, ended_ns: int) -> int:
        """Return the first track that is free when a callback starts, and occupy it."""
        while self._busy and self._busy[0][0] <= began_ns:
            heapq.heappush(self._free, heapq.heappop(self._busy)[1])
        lane = heapq.heappop(self._free) if self._free else len(self._busy)
        heapq.heappush(self._busy, (ended_ns, lane))
        return lane


class Drawing:
    """Makes events from reports.

    Each entity has a track for its callbacks, and further ones for those that overlap.

    Args:
        events: Receives the events.
        zeros: The start of the trace, by the clock of each context.
    """

    def __init__(self, events: list[dict[str, Any]], zeros: dict[str, int]) -> None:
        self._events = events
        self._zeros = zeros
        self._processes: dict[str, int] = {}
        self._tracks: dict[tuple[str, str, int], int] = {}
        self._lanes: dict[tuple[str, str], Lanes] = defaultdict(Lanes)
        self._places: dict[tuple[str, str, bytes, int, int], int] = {}  # the track of each run
        self._takers: dict[tuple[str, bytes, int], list[tuple[str, int, int]]] = {}

    def add_process(self, participant: str, name: str) -> None:
        """Name a process."""
        number = self._processes[participant] = len(self._processes) + 1
        self._events.append(
            {"ph": "M", "name": "process_name", "pid": number, "tid": 0, "args": {"name": name}}
        )

    def add_runs(self, runs: Iterable[tuple[str, RunReport]]) -> None:
        """Draw callbacks."""
        for participant, run in sorted(runs, key=lambda each: each[1].began_ns):
            entity = f"{run.node} {run.callback.rpartition('.')[2]} ({run.name})"
            lane = self._lanes[participant, entity].take(run.began_ns, run.ended_ns)
            track = self._track(participant, entity, lane)
            self._places[place_of(participant, run)] = track
            taken = run.kind, run.gid, run.sequence
            self._takers.setdefault(taken, []).append((participant, track, run.began_ns))
            self._events.append(
                {
                    "ph": "X",
                    "name": run.callback.rpartition(".")[2],
                    "cat": run.party,
                    "pid": self._processes[participant],
                    "tid": track,
                    "ts": self._us(participant, run.began_ns),
                    "dur": (run.ended_ns - run.began_ns) / 1e3,
                    "args": {
                        run.kind: run.name,
                        "number": run.sequence,
                        "waited_ms": (run.began_ns - run.entered_ns) / 1e6,
                    },
                }
            )

    def add_sent(self, entries: Iterable[tuple[str, SentReport]]) -> None:
        """Draw sent items, with an arrow to each callback that received them."""
        for number, (participant, sent) in enumerate(entries, 1):
            calls = [run for run in sent.causes if run.callback]
            places = (self._places.get(place_of(participant, run)) for run in calls)
            track = next((place for place in places if place is not None), None)
            if track is None:
                track = self._track(participant, f"{sent.node} sends", 0)
            place = {
                "pid": self._processes[participant],
                "tid": track,
                "ts": self._us(participant, sent.at_ns),
            }
            name = f"{sent.kind} {sent.name}"
            number_of = {"number": sent.sequence}
            self._events.append(
                {"ph": "X", "name": name, "cat": "sent", "dur": 0.001, **place, "args": number_of}
            )
            arrow = {"name": name, "cat": "cause", "id": number}
            takers = self._takers.get((sent.kind, sent.gid, sent.sequence), [])
            if takers:
                self._events.append({"ph": "s", **arrow, **place})
            for step, (taker, track_of_taker, began_ns) in enumerate(takers, 1):
                self._events.append(
                    {
                        "ph": "f" if step == len(takers) else "t",
                        "bp": "e",
                        **arrow,
                        "pid": self._processes[taker],
                        "tid": track_of_taker,
                        "ts": self._us(taker, began_ns),
                    }
                )

    def _us(self, participant: str, at_ns: int) -> float:
        return (at_ns - self._zeros[participant]) / 1e3

    def _track(self, participant: str, entity: str, lane: int) -> int:
        key = participant, entity, lane
        if key not in self._tracks:
            self._tracks[key] = track = len(self._tracks) + 1
            self._events.append(
                {
                    "ph": "M",
                    "name": "thread_name",
                    "pid": self._processes[participant],
                    "tid": track,
                    "args": {"name": entity},
                }
            )
        return self._tracks[key]


def place_of(participant: str, run: RunReport) -> tuple[str, str, bytes, int, int]:
    """Return what identifies a run among all reports."""
    return participant, f"{run.node} {run.name}", run.gid, run.sequence, run.began_ns
