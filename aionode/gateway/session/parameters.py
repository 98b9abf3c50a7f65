"""The parameters of nodes, as a client reads and sets them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import AionodeError, RefusedError, ServiceError
from aionode.gateway.session.encoding.client_json import check_items
from aionode.gateway.session.encoding.parameters import depends_on_type, parameter_of
from aionode.names import validate_full_topic_name
from aionode.parameter import Parameter, ParameterType
from aionode.parameter_client import AsyncParameterClient

if TYPE_CHECKING:
    from aionode.gateway.session.arrivals import Arrivals
    from aionode.gateway.session.graph import GraphView
    from aionode.gateway.session.rights import Rights
    from aionode.gateway.session.robot import Robot
    from aionode.interfaces.rcl_interfaces.msg import SetParametersResult

__all__ = ["NodeParameters"]

SERVER_SEC: Final = 1.0
"""How long a request waits for the parameter services of a node, in seconds."""

ANSWER_SEC: Final = 5.0
"""How long requests about parameters wait for an answer, in seconds."""

MAX_ASKED: Final = 8
"""Number of nodes that are asked for their parameters at the same time."""


class NodeParameters:
    """Reads and sets parameters of nodes, as far as the policy permits.

    Args:
        robot: The robot, whose node asks.
        rights: What the client may do.
        arrivals: The arrival times of frames.
        graph: The nodes that the client may see.
    """

    def __init__(self, robot: Robot, rights: Rights, arrivals: Arrivals, graph: GraphView) -> None:
        self._robot = robot
        self._rights = rights
        self._arrivals = arrivals
        self._graph = graph

    def node_name(self, node: str) -> str:
        """Return the full name of a node, by which the policy knows it.

        Raises:
            InvalidTopicNameException: it is not a full name (a ValueError).
            RefusedError: a remap rule makes the gateway's node ask another node instead.
        """
        service = f"{node}/set_parameters"
        validate_full_topic_name(service)
        if self._robot.node.resolve_service_name(service) != service:
            raise RefusedError(node, "the gateway's node remaps its services")
        return node

    @asynccontextmanager
    async def _client(self, node: str) -> AsyncIterator[AsyncParameterClient]:
        """Yield a client for the parameters of a node.

        Raises:
            RefusedError: the client may not see the node.
            ServiceError: the node has no parameter services.
        """
        node = self.node_name(node)
        if not self._rights.sees(node, []):
            raise self._rights.refusal("see", node, "the policy does not show it", "not_allowed")
        client = AsyncParameterClient(self._robot.node, node)
        try:
            with self._rights.one_call("see", node):
                async with asyncio.timeout(ANSWER_SEC):
                    if not await client.wait_for_services(SERVER_SEC):
                        raise ServiceError(node, "it has no parameter services")
                    yield client
        finally:
            client.destroy()

    async def names(self, node: str) -> list[str]:
        """Return the names of the parameters of a node that the client may see.

        Raises:
            RefusedError: it may not see the node.
            ServiceError: the node has no parameter services.
            TimeoutError: the node did not answer within 5 s.
        """
        async with self._client(node) as client:
            listed = await client.list_parameters()
        return [name for name in listed.names if self._rights.sees(f"{node}:{name}", [])]

    async def all_names(self) -> dict[str, list[str]]:
        """Return the names of the parameters that the client may see, by the nodes that answer."""
        names_of: dict[str, list[str]] = {}
        room = asyncio.Semaphore(MAX_ASKED)

        async def ask(node: str) -> None:
            # a node without parameter services, or one that is ending
            with suppress(AionodeError, TimeoutError):
                async with room:
                    names_of[node] = await self.names(node)

        async with asyncio.TaskGroup() as tasks:
            for node in self._graph.nodes():
                tasks.create_task(ask(node))
        return dict(sorted(names_of.items()))

    async def get(self, node: str, names: list[str]) -> dict[str, Parameter]:
        """Return parameters by name, omitting those that are not declared.

        Raises:
            RefusedError: the client may not see one of them.
            ServiceError: the node has no parameter services.
            TimeoutError: the node did not answer within 5 s.
        """
        node = self.node_name(node)
        self._rights.check_seen(node, names)
        async with self._client(node) as client:
            parameters = await client.get_parameters(names)
            # one of them is not declared: then the node returns none
            if len(parameters) != len(names):
                declared = set((await client.list_parameters()).names)
                names = [name for name in names if name in declared]
                parameters = await client.get_parameters(names)
        return {parameter.name: parameter for parameter in parameters}

    async def set_json(self, node: str, name: str, value: Any) -> SetParametersResult:
        """Set a parameter to a value in JSON, where a double may be written as 2.

        Args:
            node: The full name of the node.
            name: The name of the parameter.
            value: The value; None undeclares the parameter.

        Raises:
            RefusedError: the policy does not allow it.
            ServiceError: the node has no parameter services.
            TimeoutError: the node did not answer within 5 s.
            MessageError: parameters cannot have such a value (a ValueError).
        """
        arrived_ns = self._arrivals.arrival_ns()
        check_items(value, name)
        self._rights.decide("parameter", f"{node}:{name}", "")  # before anything is read
        now: Parameter | None = None
        if depends_on_type(value):
            now = (await self.get(node, [name])).get(name)
        parameter = parameter_of(name, value, now.type_ if now else ParameterType.NOT_SET)
        return await self.set(node, parameter, arrived_ns=arrived_ns)

    async def set(
        self, node: str, given: Parameter, *, arrived_ns: int | None = None
    ) -> SetParametersResult:
        """Set a parameter.

        Args:
            node: The full name of the node.
            given: The parameter; one without a value is undeclared.
            arrived_ns: As for `publish`.

        Raises:
            RefusedError: the policy does not allow it, or it may have waited while the gateway was
                stalled.
            ServiceError: the node has no parameter services.
            TimeoutError: the node did not answer within 5 s.
        """
        arrived_ns = self._arrivals.arrival_ns() if arrived_ns is None else arrived_ns
        node, began_ns = self.node_name(node), self._robot.time_base.steady_ns()
        parameter = self._rights.decide_parameter(node, given)
        await self._rights.allow(
            "parameter", f"{node}:{given.name}", "", {"value": parameter.value}
        )
        async with self._client(node) as client:
            self._arrivals.check_waited("parameter", node, arrived_ns)
            (result,) = await client.set_parameters([parameter])
        self._robot.audit.note(
            self._rights.identity, "parameter", node,
            arguments={parameter.name: parameter.value},
            result="ok" if result.successful else f"failed: {result.reason}",
            duration_ns=self._robot.time_base.steady_ns() - began_ns, way=self._rights.kind,
        )  # fmt: skip
        return result
