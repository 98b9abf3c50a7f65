"""Which way each publisher reaches each subscription, as far as it can be told from outside.

A process knows it exactly: `publisher.stats.ways`. Others see who is linked, and who could be.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from aionode.cli.diagnosis import Finding
from aionode.graph import EndpointKind
from aionode.transport.base import Linkage
from aionode.transport.link.meeting import Beacon
from aionode.transport.link.publishers import can_link

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["Pair", "ask_for_links", "link_findings", "pairs_of"]

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
        way: ``local``, ``link`` or ``zenoh``.
        reason: Why it is Zenoh, in a few words.
    """

    publisher: EndpointInfo
    subscription: EndpointInfo
    way: str
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
        giver, taker = self.nodes
        reason = f" ({self.reason})" if self.reason else ""
        return f"{giver} -> {taker} on {self.publisher.name}: {self.way}{reason}"

    def record(self) -> dict[str, str]:
        """Return it for programs."""
        giver, taker = self.nodes
        return {
            "publisher": giver,
            "subscription": taker,
            "topic": self.publisher.name,
            "way": self.way,
            "reason": self.reason,
        }


async def ask_for_links(node: Node) -> Linkage:
    """Return who is linked, and who could be."""
    asked = [await transport.links() for transport in node.context.transports]
    return Linkage(
        set().union(*(links.beacons for links in asked)),
        set().union(*(links.pairs for links in asked)),
    )


def pairs_of(endpoints: Iterable[EndpointInfo], links: Linkage) -> list[Pair]:
    """Return each publisher with each subscription that it reaches, by topic."""
    endpoints = sorted(endpoints, key=lambda end: (end.name, end.node.fully_qualified_name))
    beacons = {
        beacon.participant: beacon for text in links.beacons if (beacon := Beacon.parse(text))
    }
    takers: dict[str, list[EndpointInfo]] = {}
    for endpoint in endpoints:
        if endpoint.kind is EndpointKind.SUBSCRIPTION:
            takers.setdefault(endpoint.name, []).append(endpoint)
    return [
        Pair(giver, taker, *way(giver, taker, links, beacons))
        for giver in endpoints
        if giver.kind is EndpointKind.PUBLISHER
        for taker in takers.get(giver.name, ())
        if giver.matches(taker)
    ]


def way(
    giver: EndpointInfo, taker: EndpointInfo, links: Linkage, beacons: Mapping[str, Beacon]
) -> tuple[str, str]:
    """Return which way messages take, and why if there may be a better one."""
    if giver.node.participant == taker.node.participant:
        return "local", ""
    if not can_link(giver):
        return "zenoh", "it keeps messages for late subscriptions"
    if frozenset((giver.node.participant, taker.node.participant)) in links.pairs:
        return "link", ""
    return "zenoh", why_unlinked(giver, taker, beacons)


def why_unlinked(giver: EndpointInfo, taker: EndpointInfo, beacons: Mapping[str, Beacon]) -> str:
    """Return why the processes of two endpoints are not linked, as far as they tell."""
    nodes = (giver.node, taker.node)
    one, other = (beacons.get(node.participant) for node in nodes)
    if one is None or other is None:
        silent = [n.fully_qualified_name for n in nodes if n.participant not in beacons]
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
