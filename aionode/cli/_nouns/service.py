"""``aionode service``: list, inspect, call and watch services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from aionode.cli._support import lookup
from aionode.cli._support.command import add_type_and_find, command
from aionode.cli._support.completion import name_argument, type_argument, values_parameters
from aionode.cli._support.follow import Follower
from aionode.cli._support.formatting import (
    Printer,
    endpoint_record,
    endpoint_text,
    names_text,
)
from aionode.cli._support.nouns import SERVICE
from aionode.cli._support.options import (
    clear_full_length,
    count_option,
    csv_option,
    hertz,
    hidden_option,
    positive,
    print_options,
    read_values,
    types_option,
    verbose_option,
)
from aionode.cli._support.yaml_messages import message_from_yaml
from aionode.graph import SERVICE_KINDS, EndpointKind
from aionode.message import to_builtins

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.endpoints.client import Client
    from aionode.endpoints.subscription import MessageInfo
    from aionode.node import Node

__all__ = ["call", "echo", "info", "service_command"]


@click.group("service")
def service_command() -> None:
    """List, find, call and watch services."""


command(
    service_command,
    "list",
    types_option,
    count_option("services"),
    hidden_option("--include-hidden-services", what="services"),
    help="List the services that have a server.",
)(SERVICE.list_names)
add_type_and_find(service_command, SERVICE)


@command(
    service_command,
    "info",
    name_argument("service"),
    verbose_option,
)
async def info(node: Node, service_name: str, *, output: Output, verbose: bool = False) -> None:
    """Print the type of a service, and its clients and servers.

    Raises:
        CommandError: the service does not exist.
    """
    name, types = SERVICE.name_and_types(node, service_name)
    clients = lookup.endpoints(node, EndpointKind.CLIENT, name=name)
    servers = lookup.endpoints(node, EndpointKind.SERVER, name=name)
    if output.json:
        record: dict[str, Any] = {"name": name, "types": types}
        for word, users in (("clients", clients), ("servers", servers)):
            record[word] = list(map(endpoint_record, users)) if verbose else len(users)
        output.item("", record)
        return
    output.text(f"Type: {names_text(types)}")
    for word, users in (("Clients", clients), ("Services", servers)):
        output.text(f"{word} count: {len(users)}")
        for user in users if verbose else ():
            output.text(f"{endpoint_text(user)}\n")


@command(
    service_command,
    "call",
    *values_parameters("service"),
    click.option("-r", "--rate", metavar="N", type=hertz, help="Repeat the call at N Hz."),
    click.option("--timeout", metavar="N", type=positive, help="Wait at most N seconds."),
    interfaces=True,
    prepare=read_values,
    endless=lambda options: options["rate"] is not None,
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
    """Call a service with a request in YAML, such as '{a: 1, b: 2}'.

    Raises:
        CommandError: the service has another type, the request is invalid, or no server appeared.
        ServiceError: the server failed.
        RequestTimeoutError: the server did not answer within `timeout`.
    """
    name = SERVICE.resolve(node, service_name)
    servers = lookup.endpoints(node, EndpointKind.SERVER, name=name)
    used = {server.type_name for server in servers}
    servers = [server for server in servers if server.type_name == service_type]
    srv_type = await lookup.class_of(node, "service", service_type, name, servers, used)
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


# Events

DEPTH = 1000
"""Maximum number of events waiting to be printed."""

ACTION_SERVICES = {"SendGoal": "SendGoalService", "GetResult": "GetResultService"}


@command(
    service_command,
    "echo",
    name_argument("service"),
    type_argument("service", required=False),
    csv_option,
    *print_options,
    click.option("--once", is_flag=True, help="Print one event and exit."),
    click.option("--timeout", metavar="N", type=positive, help="Exit after N seconds."),
    interfaces=True,
    prepare=clear_full_length,
    endless=lambda options: not options["once"],
    busy=True,
)
async def echo(
    node: Node,
    service_name: str,
    service_type: str | None = None,
    *,
    output: Output,
    once: bool = False,
    timeout: float | None = None,
    **printing: Any,
) -> int:
    """Print each request and response of a service that has introspection enabled.

    Returns:
        The exit status.

    Raises:
        CommandError: the type cannot be determined.
    """
    # Imported when it runs; the other service commands do not need it.
    from aionode.engine.rules.service_events import TOPIC_SUFFIX
    from aionode.qos import qos_profile_services_default

    name = SERVICE.resolve(node, service_name)
    srv_type = await class_watched(node, name, service_type)
    topic = name + TOPIC_SUFFIX
    printer = Printer(output, **printing)
    follower = Follower(node)
    names = event_names()

    def on_event(event: Any, _: MessageInfo) -> None:
        plain = printer.plain(event)
        number = plain["info"]["event_type"]
        plain["info"]["event_type"] = names.get(number, number)
        printer.show_plain(plain)
        if once:
            follower.finish()

    profile = qos_profile_services_default.replace(depth=DEPTH)
    subscription = follower.follow(srv_type.Event, topic, on_event, profile)
    if not lookup.endpoints(node, EndpointKind.PUBLISHER, name=topic):
        output.warn(
            f"WARNING: {name} has no introspection yet: none of its servers and clients has "
            "called configure_introspection"
        )
    if not await follower.finished(timeout) and not subscription.stats.received:
        output.warn(f"No service event of '{name}' within {timeout:g} s")
        return 1
    return 0


def event_names() -> dict[int, str]:
    """Return the names of event types, as ros2 prints them."""
    from aionode.interfaces.service_msgs.msg import ServiceEventInfo

    return {
        value: name
        for name, value in vars(ServiceEventInfo).items()
        if name.startswith(("REQUEST_", "RESPONSE_"))
    }


async def class_watched(node: Node, name: str, given: str | None) -> Any:
    """Return the class of a service, given by the user or learned from its servers and clients.

    Raises:
        CommandError: the service is unknown, or has several types.
    """
    users = lookup.endpoints(node, *SERVICE_KINDS, name=name)
    service_type = given or lookup.only_type("service", name, users)
    if service_type is None:
        raise SERVICE.unknown(node, name)
    action, _, part = service_type.rpartition("_")
    if "/action/" in service_type and part in ACTION_SERVICES:
        of = name.rpartition("/_action/")[0]
        users = lookup.action_endpoints(node, of)
        action_type = await lookup.class_of(node, "action", action, of, users)
        return getattr(action_type.Impl, ACTION_SERVICES[part])
    users = [user for user in users if user.type_name == service_type]
    return await lookup.class_of(node, "service", service_type, name, users)
