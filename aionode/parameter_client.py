"""Read and set the parameters of another node."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from aionode.endpoints.core.future import asks
from aionode.interfaces.rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from aionode.parameter import (
    Parameter,
    ParameterType,
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)
from aionode.qos import qos_profile_parameters

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from aionode.endpoints.client import Client
    from aionode.interfaces.rcl_interfaces.msg import (
        ListParametersResult,
        ParameterDescriptor,
        SetParametersResult,
    )
    from aionode.node import Node

__all__ = ["AsyncParameterClient"]


class AsyncParameterClient:
    """The parameters of another node, through its parameter services.

    Each method awaits one call and raises what `Client.call` raises; limit it with
    `asyncio.timeout`::

        client = AsyncParameterClient(node, "/camera")
        await client.wait_for_services()
        await client.set_parameters([Parameter("exposure", value=0.1)])

    Args:
        node: The node that makes the calls.
        remote_node_name: Name of the other node; relative names are prefixed with the namespace of
            `node`.
    """

    def __init__(self, node: Node, remote_node_name: str) -> None:
        remote_node_name = node.resolve_service_name(remote_node_name, only_expand=True)
        self.remote_node_name = remote_node_name

        def client(srv_type: Any, name: str) -> Client[Any, Any]:
            return node.create_client(
                srv_type, f"{remote_node_name}/{name}", qos_profile=qos_profile_parameters
            )

        self._describe = client(DescribeParameters, "describe_parameters")
        self._get = client(GetParameters, "get_parameters")
        self._types = client(GetParameterTypes, "get_parameter_types")
        self._list = client(ListParameters, "list_parameters")
        self._set = client(SetParameters, "set_parameters")
        self._set_atomically = client(SetParametersAtomically, "set_parameters_atomically")
        self._clients = (
            self._describe,
            self._get,
            self._types,
            self._list,
            self._set,
            self._set_atomically,
        )

    def services_are_ready(self) -> bool:
        """Whether the node offers all six services now."""
        return all(client.service_is_ready() for client in self._clients)

    @asks
    async def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Wait until the node offers all six services; False when `timeout_sec` has passed."""
        try:
            async with asyncio.timeout(timeout_sec):
                for client in self._clients:
                    await client.wait_for_service()
        except TimeoutError:
            return self.services_are_ready()
        return True

    async def list_parameters(
        self, prefixes: Sequence[str] = (), depth: int = 0
    ) -> ListParametersResult:
        """Return the names below `prefixes`, at most `depth` dots deep; 0 means any depth."""
        response = await self._list.call(
            ListParameters.Request(prefixes=list(prefixes), depth=depth)
        )
        result: ListParametersResult = response.result
        return result

    async def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Return parameters, in the order of `names`.

        The list is empty if any of them is undeclared, which is all that the service says.
        """
        response = await self._get.call(GetParameters.Request(names=list(names)))
        return [
            Parameter(name, ParameterType(value.type), parameter_value_to_python(value))
            for name, value in zip(names, response.values, strict=False)
        ]

    async def get_parameter_types(self, names: Sequence[str]) -> list[ParameterType]:
        """Return types, in the order of `names`; an empty list if any of them is undeclared."""
        response = await self._types.call(GetParameterTypes.Request(names=list(names)))
        return [ParameterType(kind) for kind in bytes(response.types)]

    async def describe_parameters(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return descriptors, in the order of `names`; an empty list if any is undeclared."""
        response = await self._describe.call(DescribeParameters.Request(names=list(names)))
        descriptors: list[ParameterDescriptor] = response.descriptors
        return descriptors

    async def set_parameters(self, parameters: Iterable[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one, and return a result for each."""
        messages = [parameter.to_parameter_msg() for parameter in parameters]
        response = await self._set.call(SetParameters.Request(parameters=messages))
        results: list[SetParametersResult] = response.results
        return results

    async def set_parameters_atomically(
        self, parameters: Iterable[Parameter]
    ) -> SetParametersResult:
        """Set all parameters, or none if one is rejected."""
        messages = [parameter.to_parameter_msg() for parameter in parameters]
        response = await self._set_atomically.call(
            SetParametersAtomically.Request(parameters=messages)
        )
        result: SetParametersResult = response.result
        return result

    async def delete_parameters(self, names: Iterable[str]) -> list[SetParametersResult]:
        """Undeclare parameters of dynamic type one by one, and return a result for each."""
        return await self.set_parameters(Parameter(name) for name in names)

    async def load_parameter_file(
        self, path: str | Path, *, use_wildcard: bool = False
    ) -> list[SetParametersResult]:
        """Set, one by one, the parameters that a file contains for the node.

        Args:
            path: A YAML file with ``ros__parameters``.
            use_wildcard: Whether to include its section ``/**``, which applies to all nodes.

        Raises:
            ParameterFileError: the file cannot be read, or has no parameters for the node.
        """
        parameters = parameter_dict_from_yaml_file(path, use_wildcard, [self.remote_node_name])
        response = await self._set.call(SetParameters.Request(parameters=list(parameters.values())))
        results: list[SetParametersResult] = response.results
        return results

    def destroy(self) -> None:
        """Destroy the six clients; pending calls fail as described for `Client.call`."""
        for client in self._clients:
            client.destroy()
