"""Warns once if two endpoints with the same name cannot communicate, and says why."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.reports.peer_warnings import PeerWarnings
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.qos import incompatible_qos_text

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo, Graph, Mismatch

__all__ = ["MismatchReport"]


class MismatchReport:
    """Compares each endpoint that appears with its counterparts in this context.

    A pair within this context is reported when the second one appears, and so only once.
    """

    def __init__(self, graph: Graph, participant: str) -> None:
        self._graph = graph
        self._participant = participant
        self._warnings = PeerWarnings("endpoints that do not match")
        graph.on_endpoint(self.examine)

    def examine(self, new: EndpointInfo) -> None:
        """Log every mismatch between `new` and the endpoints with the same name."""
        graph = self._graph
        for opposite in graph.opposites(new) if self._is_own(new) else graph.own_opposites(new):
            own, other = (opposite, new) if self._is_own(opposite) else (new, opposite)
            mismatch = own.compare(other)
            if mismatch is not None and mismatch.aspect not in graph.unreported.get(own, ()):
                self._warnings.warn(own.node, own.name, mismatch_text(own, other, mismatch))

    def _is_own(self, endpoint: EndpointInfo) -> bool:
        return endpoint.node.participant == self._participant


def mismatch_text(own: EndpointInfo, other: EndpointInfo, mismatch: Mismatch) -> str:
    """Return why `own` and `other` cannot communicate, and what to change."""
    where = f"{'topic' if own.kind in TOPIC_KINDS else 'service'} '{own.name}'"
    peer = f"{other.kind.value} of node {other.node.fully_qualified_name}"
    if mismatch.aspect == "type":
        return (
            f"{where}: the {peer} has type {other.type_name}, this {own.kind.value} "
            f"{own.type_name}. They will not hear each other; use the same type, or another name"
        )
    if mismatch.aspect == "distribution":
        return (
            f"{where}: the {peer} uses another ROS 2 distribution, so they will not hear each "
            f"other; {mismatch.reason}"
        )
    if mismatch.aspect == "definition":
        return (
            f"{where}: the {peer} has another definition of {other.type_name} "
            f"({other.type_hash}, here {own.type_hash}). They will not hear each other; use the "
            "same version of the interface package on both sides"
        )
    if other.node.bridged:
        return (
            f"{where}: QoS of the {peer} is incompatible ({mismatch.reason}). A bridge that "
            "discovered this publisher first forwards nothing to it; publish with durability "
            "TRANSIENT_LOCAL"
        )
    if not own.needs_qos(other):
        return (
            f"{where}: QoS of the {peer} is incompatible ({mismatch.reason}). Messages are "
            "delivered over rmw_zenoh nevertheless, but would not be over DDS"
        )
    text = incompatible_qos_text(
        own.name, mismatch.policy, publisher=other.kind is EndpointKind.PUBLISHER
    )
    return f"{text} ({mismatch.reason})"
