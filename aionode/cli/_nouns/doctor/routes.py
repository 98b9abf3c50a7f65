"""The route by which each publisher reaches each subscription, as seen by another process.

Only the publishing process knows exactly: `publisher.stats.routes`. Others see which processes are
linked and which could be.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from aionode.cli._nouns.doctor.diagnosis import Finding
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from aionode.engine.transport.base import LinkStatus
    from aionode.engine.transport.link import Advertisement
    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["Pair", "link_findings", "pairs_of", "query_links"]

UNLINKED: Final = "they could be linked, but are not"
VERSIONS: Final = "they use different versions of the link protocol"

HINTS: Final = {
    UNLINKED: (
        "could be linked, but are not: everything between them goes over Zenoh",
        "look for a warning about the link in their logs; both need the same XDG_RUNTIME_DIR",
    ),
    VERSIONS: (
        "use different versions of the link protocol: everything between them goes over Zenoh",
        "use the same version of aionode for both",
    ),
}


class Pair(NamedTuple):
    """A publisher and a subscription that it reaches.

    Attributes:
        publisher: The publisher.
        subscription: The subscription.
        route: ``local``, ``link`` or ``zenoh``.
        reason: Why the route is ``zenoh``; empty otherwise.
    """

    publisher: EndpointInfo
    subscription: EndpointInfo
    route: str
    reason: str = ""

    @property
    def nodes(self) -> tuple[str, str]:
        """Full names of both nodes."""
        return (
            self.publisher.node.fully_qualified_name,
            self.subscription.node.fully_qualified_name,
        )

    def text(self) -> str:
        """Return the pair as a line of text."""
        publisher, subscription = self.nodes
        reason = f" ({self.reason})" if self.reason else ""
        return f"{publisher} -> {subscription} on {self.publisher.name}: {self.route}{reason}"

    def record(self) -> dict[str, str]:
        """Return the pair as a record for ``--json``."""
        publisher, subscription = self.nodes
        return {
            "publisher": publisher,
            "subscription": subscription,
            "topic": self.publisher.name,
            "route": self.route,
            "reason": self.reason,
        }


async def query_links(node: Node) -> LinkStatus:
    """Return which processes are linked, and which could be."""
    from aionode.engine.transport.base import LinkStatus

    asked = [await transport.link_status() for transport in node.context.transports]
    return LinkStatus(
        set().union(*(links.advertisements for links in asked)),
        set().union(*(links.pairs for links in asked)),
    )


def pairs_of(endpoints: Iterable[EndpointInfo], links: LinkStatus) -> list[Pair]:
    """Return each publisher with each subscription that it reaches, sorted by topic."""
    from aionode.engine.transport.link import Advertisement

    endpoints = sorted(endpoints, key=lambda end: (end.name, end.node.fully_qualified_name))
    advertisements = {
        advertisement.participant: advertisement
        for text in links.advertisements
        if (advertisement := Advertisement.parse(text))
    }
    subscriptions: dict[str, list[EndpointInfo]] = {}
    for endpoint in endpoints:
        if endpoint.kind is EndpointKind.SUBSCRIPTION:
            subscriptions.setdefault(endpoint.name, []).append(endpoint)
    return [
        Pair(publisher, subscription, *route(publisher, subscription, links, advertisements))
        for publisher in endpoints
        if publisher.kind is EndpointKind.PUBLISHER
        for subscription in subscriptions.get(publisher.name, ())
        if publisher.matches(subscription)
        and not (publisher.node.bridged and subscription.node.bridged)  # between them, DDS decides
    ]


def route(
    publisher: EndpointInfo,
    subscription: EndpointInfo,
    links: LinkStatus,
    advertisements: Mapping[str, Advertisement],
) -> tuple[str, str]:
    """Return the route of messages, and the reason if it is Zenoh."""
    from aionode.engine.transport.link import can_link

    if publisher.node.bridged or subscription.node.bridged:
        return "bridge", ""
    if publisher.node.participant == subscription.node.participant:
        return "local", ""
    if not can_link(publisher):
        return "zenoh", "it keeps messages for late subscriptions"
    if frozenset((publisher.node.participant, subscription.node.participant)) in links.pairs:
        return "link", ""
    return "zenoh", why_unlinked(publisher, subscription, advertisements)


def why_unlinked(
    publisher: EndpointInfo, subscription: EndpointInfo, advertisements: Mapping[str, Advertisement]
) -> str:
    """Return why two processes are not linked, judging by their advertisements."""
    nodes = (publisher.node, subscription.node)
    mine, theirs = (advertisements.get(node.participant) for node in nodes)
    if mine is None or theirs is None:
        silent = [n.fully_qualified_name for n in nodes if n.participant not in advertisements]
        return f"no link is offered by {' and '.join(silent)}"
    if mine.host != theirs.host:
        return "they are on different hosts"
    if mine.uid != theirs.uid:
        return "they belong to different users"
    return UNLINKED if mine.version == theirs.version else VERSIONS


def link_findings(pairs: Iterable[Pair]) -> list[Finding]:
    """Return a finding for each pair of processes that could be linked but is not."""
    findings: dict[frozenset[str], Finding] = {}
    for pair in pairs:
        if pair.reason not in HINTS:
            continue
        text, remedy = HINTS[pair.reason]
        participants = {pair.publisher.node.participant, pair.subscription.node.participant}
        findings.setdefault(
            frozenset(participants),
            Finding("hint", "link", f"the processes of {' and '.join(pair.nodes)} {text}", remedy),
        )
    return list(findings.values())
