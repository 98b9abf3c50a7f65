"""Records what caused each message, request, response, goal and timer call.

A *run* is one call of a callback with its input: a message, a request, a goal, or the tick of a
timer. `CAUSES` holds the runs that the current task acts for; it is a context variable, so tasks,
threads of `offload` and callbacks of the event loop inherit it. What is sent is recorded with these
runs in the log of its context. Both are bounded: the oldest are dropped.

A message is identified by its publisher's gid and its sequence number, which every message carries
anyway; a request and its response by those of the client. So nothing is added to what is sent, and
the log of one process refers to the entries of another.
"""

from __future__ import annotations

import asyncio
import weakref
from collections import deque
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, Final, Literal, Protocol, TypeAlias

from msgspec import Struct

from aionode._process.recent import Recent
from aionode.clock import perf_ns

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo

__all__ = [
    "CAUSES",
    "CauseLog",
    "Kind",
    "Party",
    "Run",
    "Sent",
    "acting_for",
    "add_cause",
    "note_end",
    "take",
]

Kind: TypeAlias = Literal["message", "request", "response", "goal", "timer"]

MAX_KEPT: Final = 4096
"""How many sent items, and how many runs, a context keeps: about 2 MB of each."""

MAX_SENDERS: Final = 1024
"""Maximum number of publishers, clients and services whose last item is kept, however old."""

MAX_CAUSES: Final = 8
"""Maximum number of causes of an item; the latest are kept."""


class Party:
    """Something that sends or receives: an endpoint, a timer or an action server.

    It outlives its entity in the log, so it does not refer to it.

    Attributes:
        kind: ``publisher``, ``subscription``, ``client``, ``server``, ``timer``, ``action client``
            or ``action server``.
        node: The full name of its node.
        name: Its full name; for a timer, its period.
        gid: The 16 bytes that identify it.
        callback: Returns the name of its callback; empty if it has none.
    """

    __slots__ = ("callback", "gid", "kind", "name", "node")

    def __init__(
        self, kind: str, node: str, name: str, gid: bytes, callback: Callable[[], str] = str
    ) -> None:
        self.kind = kind
        self.node = node
        self.name = name
        self.gid = gid
        self.callback = callback

    @classmethod
    def of(cls, endpoint: EndpointInfo, callback: Callable[[], str] = str) -> Party:
        """Return the party of an endpoint in the graph."""
        node = endpoint.node.fully_qualified_name
        return cls(endpoint.kind.value, node, endpoint.name, endpoint.gid, callback)


class Run:
    """One call of a callback; or a message or response that a task has awaited.

    Attributes:
        party: What received the input.
        kind: The kind of the input.
        gid: The gid of the input.
        sequence: Its sequence number.
        entered_ns: When the input arrived, by `perf_ns`.
        began_ns: When the callback was called.
        ended_ns: When the callback had ended; 0 before.
        is_call: Whether it is the call of a callback.
        log: Where it is kept once it has ended; None for what was awaited.
        shared: What tasks that it started have awaited, each with its task; and the cancellation of
            a goal, with None.
    """

    __slots__ = (
        "began_ns",
        "ended_ns",
        "entered_ns",
        "gid",
        "is_call",
        "kind",
        "log",
        "party",
        "sequence",
        "shared",
    )

    def __init__(
        self, party: Party, kind: Kind, gid: bytes, sequence: int, entered_ns: int, began_ns: int
    ) -> None:
        self.party = party
        self.kind: Kind = kind
        self.gid = gid
        self.sequence = sequence
        self.entered_ns = entered_ns
        self.began_ns = began_ns
        self.ended_ns = 0
        self.is_call = False
        self.log: CauseLog | None = None
        self.shared: list[tuple[Run, weakref.ref[asyncio.Task[Any]] | None]] = []

    def end(self, now_ns: int) -> None:
        """Record the end of the callback."""
        if not self.ended_ns and self.log is not None:
            self.ended_ns = now_ns
            self.log.runs.append(self)
            self.log.runs_counted += 1
            for listener in self.log.listeners:
                listener.note_end(self)

    def share(self, run: Run, task: asyncio.Task[Any] | None) -> None:
        """Add a cause for what this run and its tasks send: once `task` has ended, or now."""
        reference = None if task is None else weakref.ref(task)
        others = [each for each in self.shared if each[0] is not run]
        self.shared = [*others, (run, reference)][-MAX_CAUSES:]


class Sent(Struct, frozen=True):
    """A sent item.

    Attributes:
        kind: What it is.
        party: What sent it.
        gid: Its gid: that of the publisher; of the client for a request, its response and a goal.
        sequence: Its sequence number.
        at_ns: When it was sent, by `perf_ns`.
        causes: The runs that caused it.
        goal: The id of the goal that it is about, if any.
    """

    kind: Kind
    party: Party
    gid: bytes
    sequence: int
    at_ns: int
    causes: tuple[Run, ...]
    goal: bytes = b""


CAUSES: ContextVar[tuple[Run, ...]] = ContextVar("aionode_causes", default=())
"""The runs that the current task acts for, the callback's own first."""


def acting_for() -> tuple[Run, ...]:
    """Return the runs that cause what the current task sends now.

    Input of another task of the same callback counts once that task has ended: until then, only
    that task can have used it.
    """
    causes = CAUSES.get()
    if not any(run.shared for run in causes):
        return causes
    found = list(causes)
    for run in causes:
        for shared, reference in run.shared:
            task = None if reference is None else reference()
            if (task is None or task.done()) and shared not in found:
                found.append(shared)
    return tuple(found[:1] + found[1:][1 - MAX_CAUSES :])


def add_cause(*runs: Run) -> None:
    """Add `runs` to the causes of what the current task sends from now on.

    A run replaces an earlier one of the same party, unless that is the callback's own.
    """
    causes = list(CAUSES.get())
    for run in runs:
        places = (
            place
            for place, before in enumerate(causes)
            if before.party is run.party and not (place == 0 and before.is_call)
        )
        place = next(places, None)
        if run in causes:
            continue
        if place is None:
            causes.append(run)
        else:
            causes[place] = run
    if len(causes) > MAX_CAUSES:
        del causes[1 : 1 + len(causes) - MAX_CAUSES]
    CAUSES.set(tuple(causes))


def take(run: Run) -> None:
    """Add a cause that the current task has awaited.

    Once the task has ended, it is a cause for the other tasks of its callback as well. It is never
    the first cause of a task that has others, so that chains of runs do not grow.
    """
    causes = CAUSES.get()
    add_cause(run)
    try:
        task = asyncio.current_task()
    except RuntimeError:  # in a thread
        task = None
    if causes and task is not None:
        causes[0].share(run, task)


def note_end(now_ns: int) -> None:
    """Record the end of the callback for which the current task acts."""
    for run in CAUSES.get()[:1]:  # the callback's own is the first
        run.end(now_ns)


class Listener(Protocol):
    """Is notified of each new entry of a log."""

    def note_sent(self, sent: Sent) -> None:
        """Process a sent item."""

    def note_end(self, run: Run) -> None:
        """Process a callback that has ended."""


class CauseLog:
    """What the nodes of one context have sent, and why.

    Entries are added from any thread: each is one step of a deque.

    Attributes:
        sent: The items sent last, the oldest first.
        listeners: Notified of each entry immediately.
        sent_counted: How many items were ever sent.
        runs: The callbacks that ended last, in the order of their ends.
        runs_counted: How many have ever ended.
    """

    def __init__(self) -> None:
        self.sent: deque[Sent] = deque(maxlen=MAX_KEPT)
        self.runs: deque[Run] = deque(maxlen=MAX_KEPT)
        self.listeners: list[Listener] = []
        self.sent_counted = 0
        self.runs_counted = 0
        self._last: Recent[tuple[Kind, bytes, str], Sent] = Recent(MAX_SENDERS)

    def note(
        self,
        kind: Kind,
        party: Party,
        sequence: int,
        *,
        gid: bytes = b"",
        goal: bytes = b"",
        causes: tuple[Run, ...] | None = None,
    ) -> None:
        """Record an item that is being sent, by the current task unless its causes are given."""
        if causes is None:
            causes = acting_for()
        sent = Sent(kind, party, gid or party.gid, sequence, perf_ns(), causes, goal)
        self.sent.append(sent)
        self.sent_counted += 1
        for listener in self.listeners:
            listener.note_sent(sent)
        self._last.put((kind, party.gid, party.name), sent)

    def begin(self, party: Party, kind: Kind, gid: bytes, sequence: int, entered_ns: int) -> Run:
        """Begin a run, for which the current task acts from now on, and return it."""
        run = Run(party, kind, gid, sequence, entered_ns, perf_ns())
        run.is_call = True
        run.log = self
        CAUSES.set((run,))
        return run

    def everything(self) -> list[Sent]:
        """Return all entries, the oldest first."""
        kept = list(self.sent)
        before = kept[0].at_ns if kept else 0
        return [*(sent for sent in list(self._last.values()) if sent.at_ns < before), *kept]
