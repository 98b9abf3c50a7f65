"""The graph as a client sees it, and the parameters of nodes."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.errors import AionodeError, NodeNameNonExistentError, ServiceError
from aionode.gateway.session.base import SessionBase
from aionode.gateway.session.encoding.client_json import check_items
from aionode.gateway.session.encoding.parameters import depends_on_type, parameter_of
from aionode.graph import TOPIC_KINDS, EndpointKind, Offered
from aionode.parameter import Parameter, ParameterType
from aionode.parameter_client import AsyncParameterClient

if TYPE_CHECKING:
    from aionode.interfaces.rcl_interfaces.msg import SetParametersResult

__all__ = ["NodeDetails", "SessionGraph"]

SERVER_SEC: Final = 1.0
"""Time for which a question waits for the parameter services of a node, in seconds."""

ANSWER_SEC: Final = 5.0
"""Time for which questions about parameters wait for an answer, in seconds."""

MOST_ASKED: Final = 8
"""Nodes that are asked for their parameters at a time."""


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


class SessionGraph(SessionBase):
    """The part of `Session` that shows the graph, and reads and sets parameters."""

    # The graph, without names that the policy hides

    def offered(self, *, user_only: bool = True) -> Offered:
        """Return what there is that the client may see, as `aionode.graph.Graph.offered` does."""
        found = self._robot.node.graph.offered(user_only=user_only)
        named = (
            self._visible(of.items(), hidden=True)
            for of in (found.topics, found.services, found.actions)
        )
        return Offered([node for node in found.nodes if self._sees(node, [])], *named)

    def topics(self, *, hidden: bool = False) -> dict[str, list[str]]:
        """Return the topics that the client may see, with the names of their types."""
        return self._visible(self._robot.node.graph.names_and_types(*TOPIC_KINDS), hidden=hidden)

    def services(self, *, hidden: bool = False) -> dict[str, list[str]]:
        """Return the services that the client may see, with the names of their types."""
        kind = EndpointKind.SERVER
        return self._visible(self._robot.node.graph.names_and_types(kind), hidden=hidden)

    def actions(self) -> dict[str, list[str]]:
        """Return the actions that the client may see, with the names of their types."""
        return self._visible(self._robot.node.get_action_names_and_types(), hidden=True)

    def nodes(self) -> list[str]:
        """Return the full names of the nodes that the client may see."""
        names = {node.fully_qualified_name for node in self._robot.node.graph.nodes()}
        return [name for name in sorted(names) if self._sees(name, [])]

    def node_details(self, node: str) -> NodeDetails:
        """Return the endpoints of a node.

        Raises:
            NodeNameNonExistentError: there is no such node, or the client may not see it.
        """
        info = next(self._robot.node.graph.find_nodes(node), None)
        if info is None or not self._sees(node, []):
            raise NodeNameNonExistentError(node)

        def of(kind: EndpointKind) -> dict[str, list[str]]:
            return self._visible(
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
            self._visible(actions, hidden=True),
        )

    def users(self, kind: EndpointKind, name: str) -> list[str]:
        """Return the nodes that have an endpoint of a kind and a full name, sorted."""
        endpoints = self._robot.node.graph.endpoints(kind, name=name)
        if not endpoints or not self._sees(name, [endpoint.type_name for endpoint in endpoints]):
            return []
        nodes = {endpoint.node.fully_qualified_name for endpoint in endpoints}
        return [node for node in sorted(nodes) if self._sees(node, [])]

    def connections(self, kind: EndpointKind) -> dict[str, list[str]]:
        """Return the nodes that have endpoints of a kind, sorted, by the names of those."""
        graph = self._robot.node.graph
        nodes_of: dict[str, set[str]] = defaultdict(set)
        names, nodes = self._visible(graph.names_and_types(kind), hidden=False), set(self.nodes())
        for endpoint in graph.endpoints(kind):
            node = endpoint.node.fully_qualified_name
            if endpoint.name in names and node in nodes:
                nodes_of[endpoint.name].add(node)
        return {name: sorted(nodes_of[name]) for name in sorted(nodes_of)}

    # Parameters

    @asynccontextmanager
    async def _parameters(self, node: str) -> AsyncIterator[AsyncParameterClient]:
        """Yield a client for the parameters of a node.

        Raises:
            RefusedError: the client may not see the node.
            ServiceError: the node offers no parameters.
        """
        node = self.node_name(node)
        if not self._sees(node, []):
            raise self._refused("see", node, "the policy does not show it", "not_allowed")
        client = AsyncParameterClient(self._robot.node, node)
        try:
            with self._one_call("see", node):
                async with asyncio.timeout(ANSWER_SEC):
                    if not await client.wait_for_services(SERVER_SEC):
                        raise ServiceError(node, "it offers no parameters")
                    yield client
        finally:
            client.destroy()

    async def parameter_names(self, node: str) -> list[str]:
        """Return the names of the parameters of a node that the client may see.

        Raises:
            RefusedError: it may not see the node.
            ServiceError: the node offers no parameters.
            TimeoutError: the node has not answered within 5 s.
        """
        async with self._parameters(node) as client:
            listed = await client.list_parameters()
        return [name for name in listed.names if self._sees(f"{node}:{name}", [])]

    async def all_parameter_names(self) -> dict[str, list[str]]:
        """Return the names of the parameters that the client may see, by the nodes that answer."""
        names_of: dict[str, list[str]] = {}
        room = asyncio.Semaphore(MOST_ASKED)

        async def ask(node: str) -> None:
            with suppress(AionodeError, TimeoutError):  # a node without parameters, or that ends
                async with room:
                    names_of[node] = await self.parameter_names(node)

        async with asyncio.TaskGroup() as tasks:
            for node in self.nodes():
                tasks.create_task(ask(node))
        return dict(sorted(names_of.items()))

    async def get_parameters(self, node: str, names: list[str]) -> dict[str, Parameter]:
        """Return parameters by name; those that are not declared are left out.

        Raises:
            RefusedError: the client may not see one of them.
            ServiceError: the node offers no parameters.
            TimeoutError: the node has not answered within 5 s.
        """
        node = self.node_name(node)
        self._check_seen(node, names)
        async with self._parameters(node) as client:
            parameters = await client.get_parameters(names)
            if len(parameters) != len(names):  # one of them is not declared: then there are none
                declared = set((await client.list_parameters()).names)
                names = [name for name in names if name in declared]
                parameters = await client.get_parameters(names)
        return {parameter.name: parameter for parameter in parameters}

    async def set_json_parameter(self, node: str, name: str, value: Any) -> SetParametersResult:
        """Set a parameter to a value in JSON, where a double may be written as 2.

        Args:
            node: The full name of the node.
            name: The name of the parameter.
            value: The value; None undeclares the parameter.

        Raises:
            RefusedError: the policy does not allow it.
            ServiceError: the node offers no parameters.
            TimeoutError: the node has not answered within 5 s.
            MessageError: the value is none that parameters have (a ValueError).
        """
        arrived_ns = self.arrival_ns()
        check_items(value, name)
        self.decide("parameter", f"{node}:{name}", "")  # before anything is read
        now: Parameter | None = None
        if depends_on_type(value):
            now = (await self.get_parameters(node, [name])).get(name)
        parameter = parameter_of(name, value, now.type_ if now else ParameterType.NOT_SET)
        return await self.set_parameter(node, parameter, arrived_ns=arrived_ns)

    async def set_parameter(
        self, node: str, given: Parameter, *, arrived_ns: int | None = None
    ) -> SetParametersResult:
        """Set a parameter.

        Args:
            node: The full name of the node.
            given: The parameter; one that is not set is undeclared.
            arrived_ns: As for `publish`.

        Raises:
            RefusedError: the policy does not allow it, or it may have waited while the gateway
                stood still.
            ServiceError: the node offers no parameters.
            TimeoutError: the node has not answered within 5 s.
        """
        arrived_ns = self.arrival_ns() if arrived_ns is None else arrived_ns
        node, began_ns = self.node_name(node), self.steady_ns()
        parameter = self._decide_parameter(node, given)
        await self._allow("parameter", f"{node}:{given.name}", "", {"value": parameter.value})
        async with self._parameters(node) as client:
            self._check_waited("parameter", node, arrived_ns)
            (result,) = await client.set_parameters([parameter])
        self._robot.audit.note(
            self.identity, "parameter", node,
            arguments={parameter.name: parameter.value},
            result="ok" if result.successful else f"failed: {result.reason}",
            duration_ns=self.steady_ns() - began_ns, way=self.kind,
        )  # fmt: skip
        return result
