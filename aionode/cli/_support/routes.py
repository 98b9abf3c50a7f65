"""Which way each publisher reaches each subscription, as far as it can be told from outside.

A process knows it exactly: `publisher.stats.routes`. Others see who is linked, and who could be.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from aionode.cli._support.diagnosis import Finding
from aionode.graph import EndpointKind
from aionode.transport.base import LinkStatus
from aionode.transport.ipc import Advertisement, can_link

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["Pair", "link_findings", "pairs_of", "query_links"]

UNLINKED: Final = "they could be linked, and are not"
VERSIONS: Final = "their versions of the link differ"

HINTS: Final = {
    UNLINKED: (
        "could be linked, and are not: Zenoh carries everything between them",
        "look for a warning about the link in their logs; both need the same XDG_RUNTIME_DIR",
    ),
    VERSIONS: (
        "have different versions of the link: Zenoh carries everything between them",
        "run both with the same version of aionode",
    ),
}


class Pair(NamedTuple):
    """A publisher and a subscription that it reaches.

    Attributes:
        publisher: The publisher.
        subscription: The subscription.
        route: ``local``, ``link`` or ``zenoh``.
        reason: Why it is Zenoh, in a few words.
    """

    publisher: EndpointInfo
    subscription: EndpointInfo
    route: str
    reason: str = ""

    @property
    def nodes(self) -> tuple[str, str]:
        """The full names of both nodes."""
        return (
            self.publisher.node.fully_qualified_name,
            self.subscription.node.fully_qualified_name,
        )

    def text(self) -> str:
        """Return it in a line for people."""
        publisher, handler_for = self.nodes
        reason = f" ({self.reason})" if self.reason else ""
        return f"{publisher} -> {handler_for} on {self.publisher.name}: {self.route}{reason}"

    def record(self) -> dict[str, str]:
        """Return it for programs."""
        publisher, handler_for = self.nodes
        return {
            "publisher": publisher,
            "subscription": handler_for,
            "topic": self.publisher.name,
            "way": self.route,
            "reason": self.reason,
        }


async def query_links(node: Node) -> LinkStatus:
    """Return who is linked, and who could be."""
    asked = [await transport.link_status() for transport in node.context.transports]
    return LinkStatus(
        set().union(*(links.advertisements for links in asked)),
        set().union(*(links.pairs for links in asked)),
    )


def pairs_of(endpoints: Iterable[EndpointInfo], links: LinkStatus) -> list[Pair]:
    """Return each publisher with each subscription that it reaches, by topic."""
    endpoints = sorted(endpoints, key=lambda end: (end.name, end.node.fully_qualified_name))
    advertisements = {
        advertisement.participant: advertisement
        for text in links.advertisements
        if (advertisement := Advertisement.parse(text))
    }
    handlers: dict[str, list[EndpointInfo]] = {}
    for endpoint in endpoints:
        if endpoint.kind is EndpointKind.SUBSCRIPTION:
            handlers.setdefault(endpoint.name, []).append(endpoint)
    return [
        Pair(publisher, handler_for, *route(publisher, handler_for, links, advertisements))
        for publisher in endpoints
        if publisher.kind is EndpointKind.PUBLISHER
        for handler_for in handlers.get(publisher.name, ())
        if publisher.matches(handler_for)
    ]


def route(
    publisher: EndpointInfo,
    handler_for: EndpointInfo,
    links: LinkStatus,
    advertisements: Mapping[str, Advertisement],
) -> tuple[str, str]:
    """Return which way messages take, and why if there may be a better one."""
    if publisher.node.participant == handler_for.node.participant:
        return "local", ""
    if not can_link(publisher):
        return "zenoh", "it keeps messages for late subscriptions"
    if frozenset((publisher.node.participant, handler_for.node.participant)) in links.pairs:
        return "link", ""
    return "zenoh", why_unlinked(publisher, handler_for, advertisements)


def why_unlinked(
    publisher: EndpointInfo, handler_for: EndpointInfo, advertisements: Mapping[str, Advertisement]
) -> str:
    """Return why the processes of two endpoints are not linked, as far as they tell."""
    nodes = (publisher.node, handler_for.node)
    one, other = (advertisements.get(node.participant) for node in nodes)
    if one is None or other is None:
        silent = [n.fully_qualified_name for n in nodes if n.participant not in advertisements]
        return f"no link offered by {' and '.join(silent)}"
    if one.host != other.host:
        return "on two hosts"
    if one.uid != other.uid:
        return "of two users"
    return UNLINKED if one.version == other.version else VERSIONS


def link_findings(pairs: Iterable[Pair]) -> list[Finding]:
    """Return who could be linked and is not, once for each two processes."""
    found: dict[frozenset[str], Finding] = {}
    for pair in pairs:
        if pair.reason not in HINTS:
            continue
        text, remedy = HINTS[pair.reason]
        participants = {pair.publisher.node.participant, pair.subscription.node.participant}
        found.setdefault(
            frozenset(participants),
            Finding("hint", "link", f"the processes of {' and '.join(pair.nodes)} {text}", remedy),
        )
    return list(found.values())
