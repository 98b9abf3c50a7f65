"""The counts of nodes, endpoints and the gateway, in the text format of Prometheus."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final, Literal

import msgspec

from aionode.endpoints.stats import Distribution

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from aionode.gateway._clients import GatewayStats
    from aionode.observe import DurationReport, EntityReport, NodeReport

__all__ = ["MEDIA_TYPE", "Family", "gateway_metrics", "node_metrics", "prometheus"]

MEDIA_TYPE: Final = "text/plain; version=0.0.4; charset=utf-8"

QUANTILES: Final = (0.5, 0.9, 0.99)

Labels = dict[str, str]


class Family(msgspec.Struct):
    """One metric, with a sample for each set of labels.

    Attributes:
        name: Its name; names of counters end in ``_total``.
        kind: Its type.
        text: Its meaning, for people.
        samples: The suffix of the name (for summaries), the labels and the value of each sample.
    """

    name: str
    kind: Literal["counter", "gauge", "summary"]
    text: str
    samples: list[tuple[str, Labels, float]] = []

    def add(self, value: float, **labels: str) -> None:
        """Add a sample."""
        self.samples.append(("", labels, value))

    def add_durations(self, durations: Distribution, labels: Labels) -> None:
        """Add the quantiles of durations, in seconds, and their count."""
        for quantile in QUANTILES:
            seconds = durations.percentile_ns(quantile * 100) / 1e9
            self.samples.append(("", {**labels, "quantile": str(quantile)}, seconds))
        self.samples.append(("_count", labels, durations.count))


def prometheus(families: Iterable[Family]) -> str:
    """Return metrics in Prometheus's text format, omitting those without samples."""
    return "".join(f"{line}\n" for family in families if family.samples for line in lines(family))


def lines(family: Family) -> Iterator[str]:
    """Yield the lines of one metric."""
    yield f"# HELP {family.name} {family.text}"
    yield f"# TYPE {family.name} {family.kind}"
    for ending, labels, value in family.samples:
        shown = ",".join(f'{name}="{escaped(text)}"' for name, text in labels.items())
        yield (
            f"{family.name}{ending}{{{shown}}} {value!r}"
            if shown
            else (f"{family.name}{ending} {value!r}")
        )


def escaped(text: str) -> str:
    """Return the value of a label, escaped for quotes."""
    return text.replace("\\", "\\\\").replace("\n", "\\n").replace('"', '\\"')


def gateway_metrics(stats: GatewayStats, sees: Callable[[str, str], bool]) -> list[Family]:
    """Return the counts of a gateway, limited to the names that the caller may see.

    Args:
        stats: Its counts.
        sees: Returns whether the caller sees a topic of this name; its type is not given.
    """
    sessions = Family("aionode_gateway_sessions", "gauge", "Connected clients, by protocol.")
    for kind, count in stats.sessions.items():
        sessions.add(count, way=kind)
    totals = [
        ("refused", stats.refused, "Requests refused by the policy."),
        ("audit_lost", stats.audit_lost, "Audit log lines that were not written."),
    ]
    families = [sessions]
    for name, value, text in totals:
        families.append(Family(f"aionode_gateway_{name}_total", "counter", text))
        families[-1].add(value)
    reasons = Family("aionode_gateway_refusals_total", "counter", "Refused, dropped or late.")
    for reason, count in stats.refusals.items():
        reasons.add(count, reason=reason)
    queued = Family("aionode_gateway_sent", "gauge", "Frames sent to the connected clients.")
    queued.add(stats.sent)
    dropped = Family("aionode_gateway_dropped", "gauge", "Frames dropped for slow clients.")
    received = Family("aionode_gateway_received", "gauge", "Messages received for clients.")
    for family, by_topic in ((dropped, stats.dropped), (received, stats.received)):
        for topic, count in by_topic.items():
            if sees(topic, ""):
                family.add(count, topic=topic)
    held = Family("aionode_gateway_held", "gauge", "Whether a client commands the topic.")
    for topic in stats.holders:
        if sees(topic, ""):
            held.add(1, topic=topic)
    return [*families, reasons, queued, dropped, received, held]


COUNTERS: Final = {
    "published": "Messages published.",
    "calls": "Requests sent.",
    "received": "Messages, requests, ticks or goals passed to a callback or a reader.",
    "dropped": "Messages, requests or ticks dropped by a full queue or a slow reader.",
    "expired": "Messages older than their lifespan.",
    "filtered": "Messages rejected by a content filter.",
    "lost": "Messages missing in the sequence numbers of publishers.",
    "errors": "Callbacks that raised, and calls that failed.",
}
"""The counts of entities, by their names in reports."""

DURATIONS: Final = {
    "queue_wait": "Time from arrival to the start of the callback.",
    "run_time": "Time from the start of a callback to its end, and from a call to its response.",
    "blocking": "The longest stretch of a callback without an await.",
}
"""The durations measured by entities, by their names in reports."""


def node_metrics(nodes: Iterable[NodeReport], sees: Callable[[str, str], bool]) -> list[Family]:
    """Return the counts of the nodes' entities, limited to the names that the caller may see.

    Args:
        nodes: The reports of the nodes, as `aionode.observe` has them.
        sees: Returns whether the caller sees a topic, service or action of this name and type.
    """
    running = Family("aionode_node_running", "gauge", "Whether the node runs its callbacks.")
    counters = {
        name: Family(f"aionode_{name}_total", "counter", text) for name, text in COUNTERS.items()
    }
    durations = {
        name: Family(f"aionode_{name}_seconds", "summary", text) for name, text in DURATIONS.items()
    }
    for node in nodes:
        if not sees(node.name, ""):
            continue
        running.add(int(node.is_running), node=node.name)
        for (kind, name), entities in merged(node.entities, sees).items():
            labels = {"node": node.name, "entity": kind, "name": name}
            for count in entities[0].counts:
                counters[count].add(sum(each.counts[count] for each in entities), **labels)
            for duration in entities[0].durations:
                together = sum_of(each.durations[duration] for each in entities)
                durations[duration].add_durations(together, labels)
    return [running, *counters.values(), *durations.values()]


def merged(
    entities: Iterable[EntityReport], sees: Callable[[str, str], bool]
) -> dict[tuple[str, str], list[EntityReport]]:
    """Return the entities that the caller sees, by kind and name.

    Entities of one kind and name are merged, since Prometheus refuses duplicate labels.
    """
    groups: dict[tuple[str, str], list[EntityReport]] = {}
    for entity in entities:
        if not entity.name or sees(entity.name, entity.type_name):
            groups.setdefault((entity.kind, entity.name), []).append(entity)
    return groups


def sum_of(several: Iterable[DurationReport]) -> Distribution:
    """Return the durations of several entities as one distribution."""
    buckets: Counter[int] = Counter()
    longest_ns = 0
    for durations in several:
        buckets.update(durations.buckets)
        longest_ns = max(longest_ns, durations.max_ns)
    return Distribution.of(buckets, longest_ns)
