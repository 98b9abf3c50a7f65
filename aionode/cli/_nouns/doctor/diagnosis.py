"""Diagnose why endpoints do not communicate, from the graph."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from aionode.cli._support.lookup import ALIKE, likeness
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from aionode.graph import EndpointInfo, NodeInfo

__all__ = ["Finding", "diagnose", "diagnose_names"]

CLOCK = "/clock"

NAMED = 5
"""Maximum number of nodes that one finding names."""

USED_BY_TOOLS = {"/rosout", "/parameter_events", CLOCK}
"""Topics that normally have publishers without subscriptions, or vice versa."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that keeps endpoints from communicating, or may do so.

    Attributes:
        severity: ``problem`` for what does not work, ``hint`` for what may be unintended.
        subject: The topic, service, node or setting concerned.
        text: What was found.
        remedy: How to fix it.
    """

    severity: Literal["problem", "hint"]
    subject: str
    text: str
    remedy: str


def diagnose(nodes: Sequence[NodeInfo], endpoints: Sequence[EndpointInfo]) -> list[Finding]:
    """Return all findings, problems first."""
    findings = [
        *same_names(nodes),
        *same_servers(endpoints),
        *mismatches(endpoints),
        *time_without_source(endpoints),
        *diagnose_names(endpoints),
    ]
    unique = list(dict.fromkeys(findings))
    return sorted(unique, key=lambda finding: finding.severity != "problem")


def same_names(nodes: Sequence[NodeInfo]) -> Iterator[Finding]:
    """Yield a finding for each name shared by several nodes."""
    for name, count in Counter(node.fully_qualified_name for node in nodes).items():
        if count > 1:
            yield Finding(
                "hint",
                name,
                f"{count} nodes share this name, so requests for its parameters reach all of them",
                f"give each its own name: --ros-args -r __node:={name.rpartition('/')[2]}_2",
            )


def same_servers(endpoints: Iterable[EndpointInfo]) -> Iterator[Finding]:
    """Yield a finding for each service and action with servers in several nodes."""
    servers: dict[str, dict[str, None]] = {}
    for endpoint in endpoints:
        if endpoint.kind is EndpointKind.SERVER:
            node = endpoint.node.fully_qualified_name
            servers.setdefault(endpoint.name, {})[node] = None
    for name, nodes in servers.items():
        action = name.removesuffix("/_action/send_goal")
        if len(nodes) > 1 and (action != name or not is_hidden(name)):
            yield Finding(
                "hint",
                f"{'service' if action == name else 'action'} {action}",
                f"it has {len(nodes)} servers, of {', '.join(nodes)}: each request goes to all of "
                "them, and the first response is taken",
                f"stop one of them, or rename it: --ros-args -r {action}:=…",
            )


# Pairs that should communicate


def subject_of(endpoint: EndpointInfo) -> str:
    """Return the topic or service of an endpoint, such as ``topic /chatter``."""
    return f"{'topic' if endpoint.kind in TOPIC_KINDS else 'service'} {endpoint.name}"


def described(endpoint: EndpointInfo) -> str:
    """Return a description of an endpoint, such as ``publisher of /talker``."""
    return f"{endpoint.kind.value} of {endpoint.node.fully_qualified_name}"


def mismatches(endpoints: Iterable[EndpointInfo]) -> Iterator[Finding]:
    """Yield findings for pairs of one name that do not communicate, or would not over DDS."""
    endpoints = list(endpoints)
    by_name: dict[tuple[EndpointKind, str], list[EndpointInfo]] = {}
    for endpoint in endpoints:
        by_name.setdefault((endpoint.kind, endpoint.name), []).append(endpoint)
    for offering in endpoints:
        if offering.kind in {EndpointKind.PUBLISHER, EndpointKind.SERVER}:
            for requesting in by_name.get((offering.kind.opposite, offering.name), ()):
                yield from mismatch(offering, requesting)


def mismatch(offering: EndpointInfo, requesting: EndpointInfo) -> Iterator[Finding]:
    """Yield the reasons why two endpoints with the same name do not communicate."""
    pair = f"{described(offering)} and {described(requesting)}"
    difference = offering.compare(requesting)
    if difference is None:
        return
    differing = {
        "type": (
            f"their types are {offering.type_name} and {requesting.type_name}",
            "use the same type on both sides, or different names",
        ),
        "distribution": (
            "one uses ROS 2 Humble, the other a newer distribution",
            "use the same distribution",
        ),
        "definition": (
            (
                f"their definitions of {offering.type_name} differ "
                f"({offering.type_hash}, {requesting.type_hash})"
            ),
            "use the same version of the interface package on both sides",
        ),
    }.get(difference.aspect)
    if differing is not None:
        text, remedy = differing
        yield Finding("problem", subject_of(offering), f"{pair} do not communicate: {text}", remedy)
        return
    if offering.needs_qos(requesting):
        yield Finding(
            "problem",
            subject_of(offering),
            f"{pair} do not communicate: QoS {difference.reason}",
            "request less, or offer more",
        )
    elif requesting.node.bridged:
        yield Finding(
            "hint",
            subject_of(offering),
            f"{pair} may not communicate through the bridge: QoS {difference.reason}",
            "publish with durability TRANSIENT_LOCAL",
        )
    else:
        yield Finding(
            "hint",
            subject_of(offering),
            f"{pair} communicate over rmw_zenoh, but would not over DDS: QoS {difference.reason}",
            "request less, or offer more",
        )


def time_without_source(endpoints: Iterable[EndpointInfo]) -> Iterator[Finding]:
    """Yield a finding if nodes use simulated time, but nobody publishes it.

    ROS nodes subscribe to it while their parameter `use_sim_time` is true.
    """
    of_clock = [endpoint for endpoint in endpoints if endpoint.name == CLOCK]
    nodes = sorted({end.node.fully_qualified_name for end in of_clock})
    if nodes and all(end.kind is EndpointKind.SUBSCRIPTION for end in of_clock):
        named = ", ".join(nodes[:NAMED]) + (
            f" and {len(nodes) - NAMED} more" if nodes[NAMED:] else ""
        )
        yield Finding(
            "problem",
            f"topic {CLOCK}",
            f"{named}: use_sim_time is true, but nobody publishes {CLOCK}: their clocks stand at "
            "0, and their timers wait",
            "start the simulator, or `aionode bag play --clock`; or `aionode param set "
            f"{nodes[0]} use_sim_time false`",
        )


# Endpoints without a counterpart


def diagnose_names(endpoints: Iterable[EndpointInfo]) -> Iterator[Finding]:
    """Yield a finding for each subscription and client without a counterpart of the same name."""
    known = [e for e in endpoints if e.name not in USED_BY_TOOLS and not is_hidden(e.name)]
    used = {(endpoint.kind, endpoint.name) for endpoint in known}
    for waiting in known:
        if waiting.kind not in {EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT}:
            continue
        if (waiting.kind.opposite, waiting.name) in used:
            continue
        candidates = [endpoint for endpoint in known if endpoint.kind is waiting.kind.opposite]
        near = nearest(waiting, candidates)
        if near is None:
            yield unmatched(waiting)
        else:
            yield misnamed(waiting, near)


def unmatched(waiting: EndpointInfo) -> Finding:
    """Return the finding for an endpoint that has no candidate for a counterpart."""
    return Finding(
        "hint",
        subject_of(waiting),
        f"the {described(waiting)} is waiting: there is no {waiting.kind.opposite.value}",
        "start the node that has one, or check other domains and machines",
    )


def misnamed(waiting: EndpointInfo, near: EndpointInfo) -> Finding:
    """Return the finding for an endpoint whose likely counterpart has a similar name."""
    text = f"the {described(waiting)} is waiting, but the {described(near)} uses {near.name}"
    if near.type_name != waiting.type_name:
        text += f" (with type {near.type_name}, not {waiting.type_name})"
    return Finding(
        "problem",
        subject_of(waiting),
        text,
        f"rename one of them: --ros-args -r {waiting.name}:={near.name}",
    )


def nearest(waiting: EndpointInfo, candidates: Sequence[EndpointInfo]) -> EndpointInfo | None:
    """Return the candidate that was probably meant: a similar name, preferably of the same type."""
    alike = [
        (
            candidate.type_name == waiting.type_name,
            likeness(waiting.name, candidate.name),
            candidate,
        )
        for candidate in candidates
    ]
    alike = [entry for entry in alike if entry[1] >= ALIKE]
    return max(alike, key=lambda entry: entry[:2])[2] if alike else None
