"""Why endpoints do not talk: what can be said by looking at the graph alone."""

from __future__ import annotations

import difflib
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from aionode.graph import EndpointKind
from aionode.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from aionode.graph import EndpointInfo, NodeInfo

__all__ = ["Finding", "diagnose", "diagnose_names"]

ALIKE = 0.8
"""How like two names have to be to be taken for the same one misspelled, from 0 to 1."""

USED_BY_TOOLS = {"/rosout", "/parameter_events", "/clock"}
"""Topics that are normally published without anybody listening, or the reverse."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that keeps endpoints from talking, or may.

    Attributes:
        severity: ``problem`` for what does not work, ``hint`` for what may not be meant so.
        subject: The topic, service, node or setting that it is about.
        text: What was found.
        remedy: What would help.
    """

    severity: Literal["problem", "hint"]
    subject: str
    text: str
    remedy: str


def diagnose(nodes: Sequence[NodeInfo], endpoints: Sequence[EndpointInfo]) -> list[Finding]:
    """Return everything that looks wrong, problems first."""
    found = [*same_names(nodes), *mismatches(endpoints), *diagnose_names(endpoints)]
    unique = list(dict.fromkeys(found))
    return sorted(unique, key=lambda finding: finding.severity != "problem")


def same_names(nodes: Sequence[NodeInfo]) -> Iterator[Finding]:
    """Yield node names that several nodes have."""
    for name, count in Counter(node.fully_qualified_name for node in nodes).items():
        if count > 1:
            yield Finding(
                "hint",
                name,
                f"{count} nodes have this name, and requests for its parameters reach all of them",
                f"give each its own: --ros-args -r __node:={name.rpartition('/')[2]}_2",
            )


# Pairs that should talk


def subject_of(endpoint: EndpointInfo) -> str:
    """Return what an endpoint belongs to, such as ``topic /chatter``."""
    is_topic = endpoint.kind in {EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION}
    return f"{'topic' if is_topic else 'service'} {endpoint.name}"


def who(endpoint: EndpointInfo) -> str:
    """Return an endpoint in words, such as ``publisher of /talker``."""
    return f"{endpoint.kind.value} of {endpoint.node.fully_qualified_name}"


def mismatches(endpoints: Iterable[EndpointInfo]) -> Iterator[Finding]:
    """Yield the pairs of one name that do not talk, or would not over DDS."""
    endpoints = list(endpoints)
    by_name: dict[tuple[EndpointKind, str], list[EndpointInfo]] = {}
    for endpoint in endpoints:
        by_name.setdefault((endpoint.kind, endpoint.name), []).append(endpoint)
    for publisher in endpoints:
        if publisher.kind in {EndpointKind.PUBLISHER, EndpointKind.SERVER}:
            for handler_for in by_name.get((publisher.kind.opposite, publisher.name), ()):
                yield from mismatch(publisher, handler_for)


def mismatch(publisher: EndpointInfo, handler_for: EndpointInfo) -> Iterator[Finding]:
    """Yield why two endpoints of one name do not talk."""
    pair = f"{who(publisher)} and {who(handler_for)}"
    found = publisher.compare(handler_for)
    if found is None:
        return
    if found.aspect == "type":
        yield Finding(
            "problem",
            subject_of(publisher),
            f"{pair} do not talk: type {publisher.type_name} there, {handler_for.type_name} here",
            "use one type on both sides, or another name",
        )
        return
    if found.aspect == "definition":
        yield Finding(
            "problem",
            subject_of(publisher),
            f"{pair} do not talk: their definitions of {publisher.type_name} differ "
            f"({publisher.type_hash}, {handler_for.type_hash})",
            "use the same version of the interface package on both sides",
        )
        return
    if publisher.node.participant == handler_for.node.participant:
        yield Finding(
            "problem",
            subject_of(publisher),
            f"{pair} do not talk: QoS {found.reason}",
            "ask for no more than is offered, or offer more",
        )
    else:
        yield Finding(
            "hint",
            subject_of(publisher),
            f"{pair} talk over rmw_zenoh, but would not over DDS: QoS {found.reason}",
            "ask for no more than is offered, or offer more",
        )


# Endpoints without a partner


def diagnose_names(endpoints: Iterable[EndpointInfo]) -> Iterator[Finding]:
    """Yield who waits for somebody that is there under a name that is nearly the same."""
    known = [e for e in endpoints if e.name not in USED_BY_TOOLS and not is_hidden(e.name)]
    used = {(endpoint.kind, endpoint.name) for endpoint in known}
    for waiting in known:
        if waiting.kind not in {EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT}:
            continue
        if (waiting.kind.opposite, waiting.name) in used:
            continue
        givers = [publisher for publisher in known if publisher.kind is waiting.kind.opposite]
        near = nearest(waiting, givers)
        if near is None:
            yield nobody(waiting)
        else:
            yield misnamed(waiting, near)


def nobody(waiting: EndpointInfo) -> Finding:
    """Return the finding for somebody who waits for nobody known."""
    verb = "publishes" if waiting.kind is EndpointKind.SUBSCRIPTION else "serves"
    return Finding(
        "hint",
        subject_of(waiting),
        f"the {who(waiting)} waits: nobody {verb} it",
        "start the node that does, or look for it in another domain or on another machine",
    )


def misnamed(waiting: EndpointInfo, near: EndpointInfo) -> Finding:
    """Return the finding for somebody who waits for what has nearly the same name."""
    text = f"the {who(waiting)} waits, while the {who(near)} uses {near.name}"
    if near.type_name != waiting.type_name:
        text += f" (with type {near.type_name}, not {waiting.type_name})"
    return Finding(
        "problem",
        subject_of(waiting),
        text,
        f"rename one: --ros-args -r {waiting.name}:={near.name}",
    )


def nearest(waiting: EndpointInfo, givers: Sequence[EndpointInfo]) -> EndpointInfo | None:
    """Return who was probably meant: of a name like it, preferably of the same type."""
    alike = [
        (
            publisher.type_name == waiting.type_name,
            likeness(waiting.name, publisher.name),
            publisher,
        )
        for publisher in givers
    ]
    alike = [entry for entry in alike if entry[1] >= ALIKE]
    return max(alike, key=lambda entry: entry[:2])[2] if alike else None


def likeness(one: str, other: str) -> float:
    """Return how like two names are, from 0 to 1; 1 if only case or namespace differ."""
    if one.lower() == other.lower():
        return 1.0
    last, other_last = one.rpartition("/")[2], other.rpartition("/")[2]
    if last == other_last:
        return 0.95
    return difflib.SequenceMatcher(None, one.lower(), other.lower()).ratio()
