"""The counts of nodes, endpoints and the gateway, in the text format of Prometheus."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

import msgspec

from aionode.endpoints.core.node_core import core_of
from aionode.endpoints.stats import CallbackStats, ClientStats, Distribution, PublisherStats
from aionode.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from aionode.gateway._clients import GatewayStats
    from aionode.node import Node

__all__ = ["MEDIA_TYPE", "Family", "gateway_metrics", "node_metrics", "prometheus"]

MEDIA_TYPE: Final = "text/plain; version=0.0.4; charset=utf-8"

QUANTILES: Final = (0.5, 0.9, 0.99)

Labels = dict[str, str]

Stats: TypeAlias = PublisherStats | CallbackStats | ClientStats

KINDS: Final = {
    "Publisher": "publisher",
    "Subscription": "subscription",
    "Service": "service",
    "Client": "client",
    "ActionServer": "action server",
    "Timer": "timer",
}
"""The classes of entities with stats, and the name of each in the metrics."""


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
"""The counts of entities, by the attributes of their stats."""

DURATIONS: Final = {
    "queue_wait": "Time from arrival to the start of the callback.",
    "run_time": "Time from the start of a callback to its end, and from a call to its response.",
    "blocking": "The longest stretch of a callback without an await.",
}
"""The durations measured by entities, by the attributes of their stats."""


def node_metrics(nodes: Iterable[Node], sees: Callable[[str, str], bool]) -> list[Family]:
    """Return the counts of the nodes' entities, limited to the names that the caller may see.

    Args:
        nodes: The nodes.
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
        full_name = node.get_fully_qualified_name()
        if not sees(full_name, ""):
            continue
        running.add(int(node.is_running), node=full_name)
        for (kind, name), stats in entities_of(node, sees).items():
            labels = {"node": full_name, "entity": kind, "name": name}
            for attribute, family in counters.items():
                if hasattr(stats[0], attribute):
                    family.add(sum(getattr(stat, attribute) for stat in stats), **labels)
            for attribute, family in durations.items():
                if hasattr(stats[0], attribute):
                    family.add_durations(merged(getattr(stat, attribute) for stat in stats), labels)
    return [running, *counters.values(), *durations.values()]


def entities_of(node: Node, sees: Callable[[str, str], bool]) -> dict[tuple[str, str], list[Stats]]:
    """Return the stats of the entities that the caller sees, by kind and name.

    Entities of one kind and name are merged, since Prometheus refuses duplicate labels.
    """
    entities: dict[tuple[str, str], list[Stats]] = {}
    for entity in list(core_of(node).entities):
        kind = kind_of(entity)
        if kind is None:
            continue
        name, type_name = name_and_type(entity)
        if not name or (not is_hidden(name) and sees(name, type_name)):
            entities.setdefault((kind, name), []).append(entity.stats)  # type: ignore[attr-defined]  # of KINDS
    return entities


def kind_of(entity: object) -> str | None:
    """Return the name of an entity's kind; None if it has no stats."""
    names = (cls.__name__ for cls in type(entity).__mro__)
    return next((KINDS[name] for name in names if name in KINDS), None)


def name_and_type(entity: Any) -> tuple[str, str]:
    """Return the full name of an entity and of its type; a timer has neither."""
    if hasattr(entity, "_endpoint"):
        return entity._endpoint.name, entity._endpoint.type_name
    if hasattr(entity, "action_type"):
        return entity.action_name, entity.action_type.__ros_type__
    return "", ""


def merged(several: Iterable[Distribution]) -> Distribution:
    """Merge the durations of several entities."""
    together = Distribution()
    for durations in several:
        together._merge(durations._read(), durations.max_ns)
    return together
