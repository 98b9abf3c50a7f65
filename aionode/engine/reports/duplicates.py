"""Warns once about node names and servers that should be unique, and says why."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.reports.peer_warnings import PeerWarnings
from aionode.graph import EndpointKind
from aionode.names import is_hidden

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["DuplicateReport"]

SEND_GOAL = "/_action/send_goal"


class DuplicateReport:
    """Compares each node and server that appears with others of the same name.

    ROS 2 silently accepts duplicates: a request to a node's services then reaches both nodes, and a
    call that two servers answer returns whichever response arrives first.
    """

    def __init__(self, graph: Graph, participant: str) -> None:
        self._graph = graph
        self._participant = participant
        self._warnings = PeerWarnings("names that are not unique")
        graph.on_node(self.examine_node)
        graph.on_endpoint(self.examine)

    def examine_node(self, new: NodeInfo) -> None:
        """Warn if two nodes have the same name, and one of them belongs to this context."""
        name = new.fully_qualified_name
        own = new
        others = [info for info in self._graph.nodes_named(name) if info != new]
        if new.participant != self._participant:
            owns = [info for info in others if info.participant == self._participant]
            if not owns:
                return
            own, others = owns[0], [new]
        for other in others:
            place = (
                "this program"
                if other.participant == self._participant
                else f"another process (Zenoh id {other.participant})"
            )
            self._warnings.warn(
                own,
                name,
                f"there are two nodes named {name}: this one, and one in {place}. Requests for "
                "parameters reach both, and tools cannot tell them apart; rename one of them: "
                f"--ros-args -r __node:={own.name}_2",
            )

    def examine(self, new: EndpointInfo) -> None:
        """Warn if a service has two servers, and this context has one of them or a client."""
        if new.kind is EndpointKind.SERVER:
            self._examine_server(new)
        elif new.kind is EndpointKind.CLIENT and new.node.participant == self._participant:
            servers = self._servers(new.name)
            if len(servers) > 1:
                self._report(servers[0], servers[1], new.node)

    def _examine_server(self, new: EndpointInfo) -> None:
        for known in self._servers(new.name):
            if known == new or are_twins(new, known):
                continue
            if self._is_own(new):
                self._report(new, known, new.node)
            elif self._is_own(known):
                self._report(known, new, known.node)
            else:
                for client in self._graph.own_opposites(new)[:1]:
                    self._report(known, new, client.node)

    def _report(self, server: EndpointInfo, other: EndpointInfo, reader: NodeInfo) -> None:
        """Log with the node `reader` that there are two servers of one name."""
        name, kind = server.name, "service"
        if name.endswith(SEND_GOAL):  # one of an action's three services is enough
            name, kind = name.removesuffix(SEND_GOAL), "action"
        elif is_hidden(name):
            return
        if are_twins(server, other):
            return
        self._warnings.warn(
            reader,
            name,
            f"{kind} {name} has two servers, in {server.node.fully_qualified_name} and "
            f"{other.node.fully_qualified_name}: each request goes to both, and the first response "
            f"is taken. Stop one of them, or rename it: --ros-args -r {name}:=…",
        )

    def _servers(self, name: str) -> list[EndpointInfo]:
        return self._graph.endpoints(EndpointKind.SERVER, name=name)

    def _is_own(self, endpoint: EndpointInfo) -> bool:
        return endpoint.node.participant == self._participant


def are_twins(server: EndpointInfo, other: EndpointInfo) -> bool:
    """Return whether the nodes of two servers share a name, for which there is another warning."""
    return (
        server.node != other.node
        and server.node.fully_qualified_name == other.node.fully_qualified_name
    )
