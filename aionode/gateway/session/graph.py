"""The graph as seen by a client."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import msgspec

from aionode._process.concurrency import checkpoint
from aionode.errors import InterfaceNotFoundError, NodeNameNonExistentError
from aionode.graph import SERVICE_KINDS, TOPIC_KINDS, EndpointKind, Offered
from aionode.observe import Cause, Caused, Why, why

if TYPE_CHECKING:
    from aionode.gateway.session.rights import Rights
    from aionode.gateway.session.robot import Robot

__all__ = ["GraphView", "Kind", "NodeDetails"]

MAX_QUESTIONS: Final = 256
"""Number of graph queries that may wait, for each client."""

Kind: TypeAlias = Literal["topic", "service", "action"]
"""A kind of name."""


class NodeDetails(msgspec.Struct, frozen=True):
    """The endpoints of one node, each as names with their types.

    Attributes:
        name: Its full name.
        publishers: Topics that it publishes to.
        subscriptions: Topics that it subscribes to.
        services: Services that it offers.
        clients: Services that it calls.
        actions: Actions that it offers.
    """

    name: str
    publishers: dict[str, list[str]]
    subscriptions: dict[str, list[str]]
    services: dict[str, list[str]]
    clients: dict[str, list[str]]
    actions: dict[str, list[str]]


class GraphView:
    """The graph without the names that the policy hides from a client.

    Args:
        robot: The robot, which has the graph.
        rights: What the client may see.
    """

    def __init__(self, robot: Robot, rights: Rights) -> None:
        self._robot = robot
        self._rights = rights
        self._turn = asyncio.Lock()

    async def turn(self) -> None:
        """Wait for a loop iteration in which no other client of the gateway queries the graph.

        A query walks through the graph and blocks the loop meanwhile, so the queries of a burst run
        one by one, the clients taking turns, with callbacks of the robot between them.

        Raises:
            RefusedError: too many queries of the client are waiting.
        """
        with self._rights.one_more("ask", "the graph", "questions", (), MAX_QUESTIONS):
            async with self._turn, self._robot.turn:
                await checkpoint()

    def offered(self, *, user_only: bool = True) -> Offered:
        """Return what the client may see of `aionode.graph.Graph.offered`."""
        found = self._robot.node.graph.offered(user_only=user_only)
        named = (
            self._rights.visible(of.items(), hidden=True)
            for of in (found.topics, found.services, found.actions)
        )
        return Offered([node for node in found.nodes if self._rights.sees(node, [])], *named)

    def topics(self, *, hidden: bool = False) -> dict[str, list[str]]:
        """Return the topics that the client may see, with the names of their types."""
        return self._rights.visible(
            self._robot.node.graph.names_and_types(*TOPIC_KINDS), hidden=hidden
        )

    def services(self, *, hidden: bool = False) -> dict[str, list[str]]:
        """Return the services that the client may see, with the names of their types."""
        kind = EndpointKind.SERVER
        return self._rights.visible(self._robot.node.graph.names_and_types(kind), hidden=hidden)

    def actions(self) -> dict[str, list[str]]:
        """Return the actions that the client may see, with the names of their types."""
        return self._rights.visible(self._robot.node.get_action_names_and_types(), hidden=True)

    def nodes(self) -> list[str]:
        """Return the full names of the nodes that the client may see."""
        names = {node.fully_qualified_name for node in self._robot.node.graph.nodes()}
        return [name for name in sorted(names) if self._rights.sees(name, [])]

    def node_details(self, node: str) -> NodeDetails:
        """Return the endpoints of a node.

        Raises:
            NodeNameNonExistentError: there is no such node, or the client may not see it.
        """
        info = next(self._robot.node.graph.find_nodes(node), None)
        if info is None or not self._rights.sees(node, []):
            raise NodeNameNonExistentError(node)

        def of(kind: EndpointKind) -> dict[str, list[str]]:
            return self._rights.visible(
                self._robot.node.graph.names_and_types(kind, node=info), hidden=False
            )

        actions = self._robot.node.get_action_server_names_and_types_by_node(
            info.name, info.namespace
        )
        return NodeDetails(
            node,
            of(EndpointKind.PUBLISHER),
            of(EndpointKind.SUBSCRIPTION),
            of(EndpointKind.SERVER),
            of(EndpointKind.CLIENT),
            self._rights.visible(actions, hidden=True),
        )

    async def why(self, name: str) -> Why:
        """Return what led to the latest item of a name, without what the client may not see.

        Raises:
            RefusedError: too many queries of the client are waiting.
        """
        await self.turn()
        found = await why(self._robot.node, name)
        nodes = set(self.nodes())
        for those in (found.not_kept, found.silent, found.older, found.unreadable):
            seen = {
                each: [name for name in names if name in nodes] for each, names in those.items()
            }
            those.clear()
            those.update({each: names for each, names in seen.items() if names})
        found.sent = [self._seen(sent) for sent in found.sent]
        return found

    def _seen(self, sent: Caused) -> Caused:
        """Return something that was sent, without the names that the client may not see."""
        name = sent.name.partition("/_action/")[0]
        types = [
            endpoint.type_name
            for kind in EndpointKind
            for endpoint in self._robot.node.graph.endpoints(kind, name=sent.name)
        ]
        if sent.kind != "timer" and not self._rights.sees(name, types):
            return Caused(sent.kind, "", "", "", 0, sent.ago_ns, unknown="hidden")
        return msgspec.structs.replace(
            sent,
            node=sent.node if self._rights.sees(sent.node, []) else "",
            causes=tuple(self._seen_cause(cause) for cause in sent.causes),
        )

    def _seen_cause(self, cause: Cause) -> Cause:
        source = None if cause.source is None else self._seen(cause.source)
        if not self._rights.sees(cause.node, []):
            return msgspec.structs.replace(cause, node="", callback="", name="", source=source)
        return msgspec.structs.replace(cause, source=source)

    def users(self, kind: EndpointKind, name: str) -> list[str]:
        """Return the nodes that have an endpoint of a kind and full name, sorted."""
        endpoints = self._robot.node.graph.endpoints(kind, name=name)
        if not endpoints or not self._rights.sees(
            name, [endpoint.type_name for endpoint in endpoints]
        ):
            return []
        nodes = {endpoint.node.fully_qualified_name for endpoint in endpoints}
        return [node for node in sorted(nodes) if self._rights.sees(node, [])]

    def connections(self, kind: EndpointKind) -> dict[str, list[str]]:
        """Return the nodes that have endpoints of a kind, sorted, by the names of the endpoints."""
        graph = self._robot.node.graph
        nodes_of: dict[str, set[str]] = defaultdict(set)
        names, nodes = (
            self._rights.visible(graph.names_and_types(kind), hidden=False),
            set(self.nodes()),
        )
        for endpoint in graph.endpoints(kind):
            node = endpoint.node.fully_qualified_name
            if endpoint.name in names and node in nodes:
                nodes_of[endpoint.name].add(node)
        return {name: sorted(nodes_of[name]) for name in sorted(nodes_of)}

    # Types

    def type_of(self, name: str, kind: Kind) -> str:
        """Return the type of a full name in the graph.

        Raises:
            InterfaceNotFoundError: no node has it.
        """
        for type_name in self._types_of(name, kind):
            return type_name
        raise InterfaceNotFoundError(name, problem=f"no node has this {kind}; specify its type")

    def types_of(self, name: str, kind: Kind) -> list[str]:
        """Return the types of a full name; none if no node has it, or the client may not see it."""
        types = list(self._types_of(name, kind))
        return types if types and self._rights.sees(name, types) else []

    def sees(self, name: str, type_name: str) -> bool:
        """Return whether the client sees a name; without a type, its types in the graph count."""
        types = [type_name] if type_name else list(self._types_of(name, "topic"))
        return self._rights.sees(name, types)

    def _types_of(self, name: str, kind: Kind) -> dict[str, None]:
        place, suffix = name, ""
        if kind == "action":
            place, suffix = f"{name}/_action/feedback", "_FeedbackMessage"
        kinds = SERVICE_KINDS if kind == "service" else TOPIC_KINDS
        endpoints = self._robot.node.graph.endpoints(*kinds, name=place)
        return {endpoint.type_name.removesuffix(suffix): None for endpoint in endpoints}
