"""What happened between two snapshots of a system."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from aionode.endpoints.stats import Distribution

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.engine.observation import EntityReport, ProcessReport
    from aionode.observe._snapshot import Snapshot

__all__ = ["EntityRate", "ProcessRate", "Rates", "rates"]

RATED: Final = ("published", "received", "calls")
"""The counts from which an entity's rate is computed: the first one that it has."""


@dataclass(frozen=True, slots=True)
class EntityRate:
    """What one endpoint, timer or action did between two snapshots.

    Attributes:
        node: The full name of its node.
        report: Its counts at the second snapshot.
        hz: How often it published, received or called per second.
        new: How much each count has grown.
        durations: The durations between the snapshots, by name.
    """

    node: str
    report: EntityReport
    hz: float
    new: dict[str, int]
    durations: dict[str, Distribution] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ProcessRate:
    """What one process did between two snapshots.

    Attributes:
        report: Its report at the second snapshot.
        cpu: The share of one processor that it used.
        entities: What its endpoints, timers and actions did.
    """

    report: ProcessReport
    cpu: float
    entities: list[EntityRate]


@dataclass(frozen=True, slots=True)
class Rates:
    """What a system did between two snapshots.

    Attributes:
        processes: What each process did that is in both snapshots.
        snapshot: The second snapshot.
    """

    processes: list[ProcessRate]
    snapshot: Snapshot

    def entities(self) -> Iterator[EntityRate]:
        """Yield what each endpoint, timer and action did."""
        for process in self.processes:
            yield from process.entities

    def topic_hz(self) -> dict[str, float]:
        """Return the rate of each topic per second, over all its publishers."""
        found: dict[str, float] = {}
        for entity in self.entities():
            if entity.report.kind == "publisher":
                name = entity.report.name
                found[name] = found.get(name, 0.0) + entity.hz
        return found


def rates(before: Snapshot, after: Snapshot) -> Rates:
    """Return what happened between two snapshots, by the clocks of the processes themselves."""
    known = {process.participant: process for process in before.processes}
    return Rates(
        [
            process_rate(known[process.participant], process)
            for process in after.processes
            if process.participant in known
        ],
        after,
    )


def process_rate(before: ProcessReport, after: ProcessReport) -> ProcessRate:
    """Return what one process did."""
    seconds = max((after.now_ns - before.now_ns) / 1e9, 1e-9)
    known = {key: entity for key, _, entity in entities_of(before)}
    return ProcessRate(
        after,
        (after.cpu_ns - before.cpu_ns) / 1e9 / seconds,
        [
            entity_rate(node, known.get(key), entity, seconds)
            for key, node, entity in entities_of(after)
        ],
    )


Key = tuple[str, str, str, str, int]


def entities_of(process: ProcessReport) -> Iterator[tuple[Key, str, EntityReport]]:
    """Yield the entities of a process with keys; those of the same kind and name are numbered."""
    seen: dict[tuple[str, str, str, str], int] = {}
    for node in process.nodes:
        for entity in node.entities:
            named = (node.name, entity.kind, entity.name, entity.callback)
            seen[named] = seen.get(named, 0) + 1
            yield (*named, seen[named]), node.name, entity


def entity_rate(
    node: str, before: EntityReport | None, after: EntityReport, seconds: float
) -> EntityRate:
    """Return what one entity did; everything, if it is new."""
    old = {} if before is None else before.counts
    new = {name: count - old.get(name, 0) for name, count in after.counts.items()}
    counted = next((new[name] for name in RATED if name in new), 0)
    durations = {}
    for name, measured in after.durations.items():
        earlier = before.durations.get(name) if before is not None else None
        buckets = {} if earlier is None else earlier.buckets
        durations[name] = Distribution.of(
            {
                bucket: count - buckets.get(bucket, 0)
                for bucket, count in measured.buckets.items()
                if count > buckets.get(bucket, 0)
            },
            measured.max_ns,
        )
    return EntityRate(node, after, counted / seconds, new, durations)
