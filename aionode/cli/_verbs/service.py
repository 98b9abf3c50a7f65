"""The verbs of ``aionode service``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.formatting import names_text
from aionode.cli._support.yaml_messages import message_from_yaml
from aionode.errors import CommandError
from aionode.graph import EndpointKind
from aionode.message import to_builtins

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.endpoints.client import Client
    from aionode.node import Node

__all__ = ["call", "find", "info", "list_services", "type_of_service"]

# Verbs


async def list_services(
    node: Node, *, output: Output, types: bool = False, count: bool = False, hidden: bool = False
) -> None:
    """Print every service that somebody serves."""
    found = lookup.names_and_types(node, EndpointKind.SERVER, hidden=hidden)
    if count:
        output.item(str(len(found)), {"services": len(found)})
        return
    for name, of in found.items():
        output.item(f"{name} [{', '.join(of)}]" if types else name, {"name": name, "types": of})


def found_types(node: Node, service_name: str) -> tuple[str, list[str]]:
    """Return full name and types of a service.

    Raises:
        CommandError: nobody serves it.
    """
    name = node.resolve_service_name(service_name)
    served = lookup.names_and_types(node, EndpointKind.SERVER, hidden=True)
    if name not in served:
        raise lookup.unknown("Unknown service", service_name, served, "service list")
    return name, served[name]


async def info(node: Node, service_name: str, *, output: Output) -> None:
    """Print the type of a service, and how many serve and call it."""
    name, types = found_types(node, service_name)
    clients = len(lookup.endpoints(node, EndpointKind.CLIENT, name=name))
    servers = len(lookup.endpoints(node, EndpointKind.SERVER, name=name))
    output.item(
        f"Type: {names_text(types)}\nClients count: {clients}\nServices count: {servers}",
        {"name": name, "types": types, "clients": clients, "servers": servers},
    )


async def type_of_service(node: Node, service_name: str, *, output: Output) -> None:
    """Print the type of a service."""
    name, types = found_types(node, service_name)
    for one in types:
        output.item(one, {"name": name, "type": one})


async def find(
    node: Node, service_type: str, *, output: Output, count: bool = False, hidden: bool = False
) -> None:
    """Print the services of one type."""
    served = lookup.names_and_types(node, EndpointKind.SERVER, hidden=hidden)
    names = [name for name, types in served.items() if service_type in types]
    if count:
        output.item(str(len(names)), {"services": len(names)})
        return
    for name in names:
        output.item(name, {"name": name, "types": served[name]})


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
    """Call a service with a request in YAML, once or `rate` times a second, and print the answer.

    Without a server it waits for one. With `timeout` that, and each call, takes no longer.

    Raises:
        CommandError: the service has another type, the request does not fit, or time is up.
        ServiceError: the server could not answer.
        RequestTimeoutError: it did not answer in time.
    """
    name = node.resolve_service_name(service_name)
    srv_type = await service_class(node, name, service_type)
    request = message_from_yaml(srv_type.Request, values)
    client: Client[Any, Any] = node.create_client(srv_type, name)
    if not client.service_is_ready():
        await wait_for_server(node, client, output, timeout)
    ticks = None if rate is None else node.create_rate(rate)
    while True:
        output.text(f"requester: making request: {request!r}\n")
        response = await client.call(request, timeout_sec=timeout)
        output.item(f"response:\n{response!r}\n", to_builtins(response))
        if ticks is None:
            return
        await ticks.sleep()


async def service_class(node: Node, name: str, service_type: str) -> Any:
    """Return the class of a service of the type that the user says.

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


async def wait_for_server(
    node: Node, client: Client[Any, Any], output: Output, timeout_s: float | None
) -> None:
    """Wait until somebody serves, and say what might be meant instead."""
    name = client.srv_name
    served = lookup.names_and_types(node, EndpointKind.SERVER)
    output.progress("waiting for service to become available...")
    if hint := lookup.close_to(name, served):
        output.warn(f"Nobody serves '{name}'{hint}")
    with output.waiting(f"waiting for somebody to serve {name}"):
        ready = await client.wait_for_service(timeout_s)
    if not ready:
        raise CommandError(
            f"Nobody served '{name}' in {timeout_s:g} s. `aionode service list` shows the "
            "services there are"
        )
