"""Asks all processes repeatedly for the causes recorded since the last time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._process.recent import Recent
from aionode.clock import perf_ns
from aionode.engine.cause_reports import (
    CauseQuestion,
    CauseReport,
    answer,
    clock_id,
    decoded,
    encoded,
)
from aionode.observe._causes import named_in
from aionode.observe._snapshot import ANSWER_S

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = ["AFTER_ALL", "Following"]

AFTER_ALL: Final = 2**60
"""A number higher than that of any callback."""

MAX_ANSWERS: Final = 16
"""Maximum number of questions to a context at a time: it returns up to 1000 of 4096 log entries."""

MAX_CONTEXTS: Final = 10_000
"""How many contexts are remembered: each command run during a day is one."""


class Following:
    """The answers of the processes so far.

    Attributes:
        told: The latest answer of each context that keeps causes, without its runs and entries.
        offsets: The offset from the clock of each context to this one, in nanoseconds.
        lost: How many callbacks and sent items were no longer kept when asked for.
        not_kept: Contexts that keep no causes, each with the names of its nodes.
        silent: Contexts that did not answer the last time, in the same form.
        older: Contexts whose version of aionode cannot keep causes.
        unreadable: Contexts whose answer this version cannot read.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.told: Recent[str, CauseReport] = Recent(MAX_CONTEXTS)
        self.offsets: Recent[str, int] = Recent(MAX_CONTEXTS)
        self.lost = 0
        self.not_kept: Recent[str, list[str]] = Recent(MAX_CONTEXTS)
        self.silent: dict[str, list[str]] = {}
        self.older: Recent[str, list[str]] = Recent(MAX_CONTEXTS)
        self.unreadable: Recent[str, list[str]] = Recent(MAX_CONTEXTS)

    def add(self, report: CauseReport) -> None:
        """Process an answer with new items."""
        raise NotImplementedError

    def nodes_of(self, participant: str) -> list[str]:
        """Return the names of the nodes of a context, except hidden ones."""
        return named_in(self._node).get(participant, [])

    async def look(self, first: int) -> None:
        """Ask for new items; contexts seen for the first time are asked from number `first` on."""
        context = self._node.context
        self.silent = {}
        for _ in range(MAX_ANSWERS):
            question = self._next(context.participant, first)
            own = answer(context.causes, context.participant, question)
            self._keep(own)
            if not own.runs and not own.sent:
                break
        for transport in context.transports:
            # An empty question finds new contexts.
            told = await transport.observe("causes", encoded(CauseQuestion()), ANSWER_S)
            for participant, data in told.items():
                if data is None:
                    if nodes := self.nodes_of(participant):  # others have just ended, or are tools
                        self.silent[participant] = nodes
                    continue
                report = decoded(data)
                if not data:
                    self.older.put(participant, self.nodes_of(participant))
                elif report is None or report.participant != participant:
                    self.unreadable.put(participant, self.nodes_of(participant))
                elif not report.is_kept:
                    self._keep(report)
                else:
                    await self._ask(transport, participant, first)

    async def _ask(self, transport: Any, participant: str, first: int) -> None:
        """Ask one context for all new items."""
        for _ in range(MAX_ANSWERS):
            question = self._next(participant, first)
            told = await transport.observe("causes", encoded(question), ANSWER_S, {participant})
            data = told.get(participant)
            report = decoded(data) if data else None
            if report is None or report.participant != participant:
                return
            self._keep(report)
            if not report.runs and not report.sent:
                return

    def _next(self, participant: str, first: int) -> CauseQuestion:
        told = self.told.get(participant)
        return CauseQuestion(since=(first, first) if told is None else told.next)

    def _keep(self, report: CauseReport) -> None:
        participant = report.participant
        offset = 0 if report.clock == clock_id() else perf_ns() - report.now_ns
        # Removed and added again: those that answered least recently are forgotten first.
        self.offsets.put(participant, min(self.offsets.pop(participant, offset), offset))
        if not report.is_kept:
            if nodes := self.nodes_of(participant):
                self.not_kept.put(participant, nodes)
        else:
            before = self.told.pop(participant, None)
            self.told.put(participant, msgspec.structs.replace(report, runs=[], sent=[]))
            if before is not None:
                # Items that one context repeats do not reduce what others have lost.
                self.lost += max(sum(report.begin) - sum(before.next), 0)
        self.add(report)
