"""Findings from the counts of running processes, and from the diagnostics that nodes publish."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from aionode.cli._nouns.doctor.diagnosis import Finding
from aionode.errors import escaped
from aionode.graph import EndpointKind
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.observe import observe, rates

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from aionode.endpoints.stats import Distribution
    from aionode.engine.observation import ProcessReport
    from aionode.node import Node
    from aionode.observe import EntityRate, Rates

__all__ = ["findings_of_work"]

BUDGET_MS: Final = 10.0
"""How long a callback may hold the event loop by default, in milliseconds."""

LATE_MS: Final = 100.0
"""How long messages wait before they count as late for their callback, in milliseconds."""

ENOUGH: Final = 5
"""Minimum number of calls between two snapshots for a callback to be judged."""

MANY: Final = 0.01
"""Fraction of dropped messages from which drops are reported."""

LOOKING_S = 1.2
"""Time between two snapshots, during which statuses are received, in seconds: most nodes publish
theirs once a second, and counts from the start of a process say nothing about the present.
"""

MAX_STATUSES: Final = 20
"""Maximum number of statuses that are reported."""

MAX_KNOWN: Final = 10_000
"""Maximum number of statuses that are kept."""

LEVELS: Final = {
    DiagnosticStatus.WARN: "a warning",
    DiagnosticStatus.ERROR: "an error",
    DiagnosticStatus.STALE: "stale: it is no longer updated",
}


async def findings_of_work(node: Node) -> list[Finding]:
    """Take two snapshots of all processes, receive diagnostics, and return what is wrong."""
    before = await observe(node)
    statuses = await statuses_of(node)
    found = rates(before, await observe(node))
    return [*work_findings(found), *status_findings(statuses)]


def work_findings(found: Rates) -> Iterator[Finding]:
    """Yield what is late, dropped, failed or over its budget."""
    for process in found.processes:
        if process.report.nodes:
            yield from waits_of(process.report)
        for entity in process.entities:
            yield from findings_of(entity)
    for names in found.snapshot.silent.values():
        yield Finding(
            "problem",
            ", ".join(names),
            "its process does not answer: it is stopped, its event loop is blocked, or it is dead",
            "inspect it with `ps` or `py-spy dump --pid PID`; `kill -CONT PID` resumes a stopped "
            "process",
        )
    for names in found.snapshot.older.values():
        yield Finding(
            "hint",
            ", ".join(names),
            "its version of aionode is too old to report its counts",
            "update aionode there",
        )


def waits_of(process: ProcessReport) -> Iterator[Finding]:
    """Yield a finding if callbacks of a process had to wait for a processor."""
    if not process.processor_waits:
        return
    busy = process.load > process.cores
    why = f"the load of {process.host} is {process.load:.1f} on {process.cores} cores"
    yield Finding(
        "hint",
        f"process {process.pid} ({escaped(process.program, one_line=True)})",
        f"{process.processor_waits} of its callbacks were late because no processor was free, "
        f"{process.processor_waited_ns / 1e6:.0f} ms in all since its start; {why}",
        "stop other programs there: `aionode top` shows which of them use the processors"
        if busy
        else f"check whether it is bound to few processors: taskset -pc {process.pid}",
    )


def findings_of(entity: EntityRate) -> Iterator[Finding]:
    """Yield the findings about one endpoint, timer or action."""
    report, new = entity.report, entity.new
    subject = f"{report.kind} {report.name}".strip()
    whose = f"{report.callback or 'the reader'} of {entity.node}"
    received, dropped, lost = (new.get(name, 0) for name in ("received", "dropped", "lost"))
    if (held := percentile_ms(entity.durations.get("blocking"))) > BUDGET_MS:
        yield Finding(
            "problem" if held > LATE_MS else "hint",
            subject,
            f"{whose} holds the event loop for {held:.0f} ms (p99); nothing else of its process"
            " runs meanwhile",
            "await the slow part, or run the callback in a thread: offload=True",
        )
    if (late := percentile_ms(entity.durations.get("queue_wait"))) > LATE_MS:
        yield Finding(
            "problem",
            subject,
            f"{whose} begins {late:.0f} ms (p99) after its input has arrived",
            "see which callback holds the event loop: `aionode top`, table callbacks",
        )
    if report.kind == "subscription" and dropped > MANY * (received + dropped):
        yield Finding(
            "hint",
            subject,
            f"{dropped} of {received + dropped} messages for {whose} were dropped: they arrive "
            "faster than it handles them",
            "increase its depth if they arrive in bursts, otherwise publish less often",
        )
    if lost > MANY * (received + lost):
        yield Finding(
            "hint",
            subject,
            f"{lost} messages from other processes did not reach {entity.node}",
            "use reliable QoS, or check the network",
        )
    if errors := report.counts.get("errors", 0):
        yield Finding(
            "problem" if new["errors"] else "hint",
            subject,
            f"{whose} has failed {errors} times, {new['errors']} of them just now",
            "its traceback is in the log of its process",
        )


def percentile_ms(measured: Distribution | None) -> float:
    """Return the 99th percentile of a duration in milliseconds; 0 before there are enough."""
    if measured is None or measured.count < ENOUGH:
        return 0.0
    return measured.percentile_ns(99) / 1e6


async def statuses_of(node: Node) -> list[DiagnosticStatus]:
    """Return the newest statuses that nodes publish on /diagnostics until the next snapshot."""
    newest: dict[str, DiagnosticStatus] = {}

    def note(message: DiagnosticArray) -> None:
        for status in message.status:
            if status.name in newest or len(newest) < MAX_KNOWN:
                newest[status.name] = status

    subscription = None
    if node.graph.count(EndpointKind.PUBLISHER, "/diagnostics"):
        subscription = node.create_subscription(DiagnosticArray, "/diagnostics", note, 100)
    with suppress(TimeoutError):
        async with asyncio.timeout(LOOKING_S):
            await node.until_destroyed()
    if subscription is not None:
        subscription.destroy()
    return list(newest.values())


def status_findings(statuses: Sequence[DiagnosticStatus]) -> list[Finding]:
    """Return findings about the statuses that are not OK, the worst first."""
    bad = [status for status in statuses if status.level in LEVELS]
    bad.sort(key=lambda status: status.level, reverse=True)
    return [
        Finding(
            "hint" if status.level == DiagnosticStatus.WARN else "problem",
            escaped(f"diagnostics of {status.name}", one_line=True),
            escaped(f"{LEVELS[status.level]}: {status.message}", one_line=True),
            "see its values: aionode topic echo --once /diagnostics",
        )
        for status in bad[:MAX_STATUSES]
    ]
