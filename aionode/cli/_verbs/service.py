"""The verbs info and call of ``aionode service``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.formatting import names_text
from aionode.cli._support.nouns import SERVICE
from aionode.cli._support.yaml_messages import message_from_yaml
from aionode.errors import CommandError
from aionode.graph import EndpointKind
from aionode.message import to_builtins

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.endpoints.client import Client
    from aionode.node import Node

__all__ = ["call", "info"]


async def info(node: Node, service_name: str, *, output: Output) -> None:
    """Print the type of a service, and the number of its clients and servers.

    Raises:
        CommandError: the service does not exist.
    """
    name, types = SERVICE.name_and_types(node, service_name)
    clients = len(lookup.endpoints(node, EndpointKind.CLIENT, name=name))
    servers = len(lookup.endpoints(node, EndpointKind.SERVER, name=name))
    output.item(
        f"Type: {names_text(types)}\nClients count: {clients}\nServices count: {servers}",
        {"name": name, "types": types, "clients": clients, "servers": servers},
    )


async def call(
    node: Node,
    service_name: str,
    service_type: str,
    *,
    output: Output,
    values: str = "{}",
    rate: float | None = None,
    timeout: float | None = None,
) -> None:
    """Call a service with a request in YAML, once or `rate` times a second; print each response.

    It waits for a server. `timeout` limits that wait, and each call, in seconds.

    Raises:
        CommandError: the service has another type, the request is invalid, or no server appeared.
        ServiceError: the server failed.
        RequestTimeoutError: the server did not answer within `timeout`.
    """
    name = SERVICE.resolve(node, service_name)
    srv_type = await service_class(node, name, service_type)
    request = message_from_yaml(srv_type.Request, values)
    client: Client[Any, Any] = node.create_client(srv_type, name)
    if not client.service_is_ready():
        output.progress("waiting for service to become available...")
        await SERVICE.wait_for_server(node, name, client.wait_for_service, output, timeout)
    ticks = None if rate is None else node.create_rate(rate)
    while True:
        output.text(f"requester: making request: {request!r}\n")
        response = await client.call(request, timeout_sec=timeout)
        output.item(f"response:\n{response!r}\n", to_builtins(response))
        if ticks is None:
            return
        await ticks.sleep()


async def service_class(node: Node, name: str, service_type: str) -> Any:
    """Return the class for the service type that the user gave.

    Raises:
        CommandError: there is no such type, or the service has another one.
    """
    servers = lookup.endpoints(node, EndpointKind.SERVER, name=name)
    fitting = [server for server in servers if server.type_name == service_type]
    if fitting:
        return await lookup.type_of(node, fitting)
    srv_type = lookup.interface_class("service", service_type)
    others = sorted({server.type_name for server in servers} - {srv_type.__ros_type__})
    if others:
        raise CommandError(
            f"The passed service type is invalid: '{name}' has type {', '.join(others)}, "
            f"not {service_type}"
        )
    return srv_type
