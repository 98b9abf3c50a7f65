"""A snapshot of all processes of a system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from aionode.engine.observation import ProcessReport, decoded
from aionode.names import is_hidden

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = ["Snapshot", "observe"]

ANSWER_S: Final = 0.5
"""Time within which any responsive process answers, in seconds; most take milliseconds."""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The counts of the processes of a system so far.

    Attributes:
        processes: The reports of all contexts that answered, this one's first.
        silent: Contexts that did not: frozen, blocked, or dead without having been noticed; each
            with the names of its nodes, as far as the graph knows them.
        older: Contexts whose version of aionode makes no reports, in the same form.
        unreached: Descriptions of processes that accept no connection, whose nodes are unknown.
        foreign: Nodes that do not use aionode, such as those of ROS 2, which make none either.
        unreadable: Contexts whose report this version cannot read.
    """

    processes: list[ProcessReport]
    silent: dict[str, list[str]]
    older: dict[str, list[str]]
    unreached: list[str]
    foreign: list[str]
    unreadable: dict[str, list[str]]


async def observe(node: Node, *, timeout_sec: float = ANSWER_S) -> Snapshot:
    """Ask all aionode processes in the domain for their counts.

    All are asked at once, and one that does not answer delays the result by at most `timeout_sec`.
    Hidden nodes, such as those of tools, are left out of reports. Cancelling is safe.

    Args:
        node: A running node.
        timeout_sec: Maximum time to wait for answers, in seconds.
    """
    context = node.context
    named: dict[str, list[str]] = {}
    for info in context.graph.nodes():
        if not is_hidden(info.fully_qualified_name):
            named.setdefault(info.participant, []).append(info.fully_qualified_name)
    answers: dict[str, bytes | None] = {}
    unreached: list[str] = []
    for transport in context.transports:
        answers |= await transport.observe("report", b"", timeout_sec)
        unreached += transport.silent_processes()
    found = Snapshot([context.report()], {}, {}, [], [], {})
    found.unreached.extend(dict.fromkeys(unreached))
    for participant, answer in sorted(answers.items()):
        nodes = sorted(named.get(participant, []))
        if answer is None:
            if nodes:  # others have just ended, or are tools
                found.silent[participant] = nodes
        elif not answer:
            found.older[participant] = nodes
        elif (report := decoded(answer)) is not None:
            found.processes.append(report)
        else:
            found.unreadable[participant] = nodes
    for process in found.processes:
        process.nodes = [each for each in process.nodes if not is_hidden(each.name)]
    known = {*answers, context.participant}
    found.foreign.extend(
        sorted(name for each, names in named.items() if each not in known for name in names)
    )
    return found
