"""``aionode service echo``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.follow import Follower
from aionode.cli._support.formatting import PrintOptions, byte_form, csv_line, yaml_text
from aionode.cli._support.nouns import SERVICE
from aionode.endpoints.service_introspection import TOPIC_SUFFIX
from aionode.errors import CommandError
from aionode.graph import SERVICE_KINDS, EndpointKind
from aionode.interfaces.service_msgs.msg import ServiceEventInfo
from aionode.qos import qos_profile_services_default

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.endpoints.subscription import MessageInfo
    from aionode.node import Node

__all__ = ["echo"]

DEPTH = 1000
"""How many events may wait to be printed."""

EVENTS = {
    value: name
    for name, value in vars(ServiceEventInfo).items()
    if name.startswith(("REQUEST_", "RESPONSE_"))
}
"""The names of event types, as ros2 prints them."""

ACTION_SERVICES = {"SendGoal": "SendGoalService", "GetResult": "GetResultService"}


async def echo(
    node: Node,
    service_name: str,
    service_type: str | None = None,
    *,
    output: Output,
    csv: bool = False,
    truncate_length: int | None = 128,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
    once: bool = False,
    timeout: float | None = None,
) -> int:
    """Print each service event of a service; return the exit status.

    There are events only where a client or server publishes them, see `configure_introspection`.

    Raises:
        CommandError: the type cannot be determined.
    """
    name = SERVICE.resolve(node, service_name)
    srv_type = await service_class(node, name, service_type)
    topic = name + TOPIC_SUFFIX
    options = PrintOptions(
        None if output.json else truncate_length,
        no_arr=no_arr,
        no_str=no_str,
        as_byte=byte_form(output, csv=csv),
    )
    follower = Follower(node)

    def on_event(event: Any, _: MessageInfo) -> None:
        plain = options.message(event)
        number = plain["info"]["event_type"]
        plain["info"]["event_type"] = EVENTS.get(number, number)
        if output.json:
            output.item("", plain)
        elif csv:
            output.text(csv_line(plain))
        else:
            output.text(f"{yaml_text(plain, flow_style=flow_style)}---")
        if once:
            follower.finish()

    profile = qos_profile_services_default.replace(depth=DEPTH)
    subscription = follower.follow(srv_type.Event, topic, on_event, profile)
    if not lookup.endpoints(node, EndpointKind.PUBLISHER, name=topic):
        output.warn(
            f"WARNING: {name} is not introspected so far: none of its servers and clients has "
            "called configure_introspection"
        )
    if not await follower.finished(timeout) and not subscription.stats.received:
        output.warn(f"No service event of '{name}' within {timeout:g} s")
        return 1
    return 0


async def service_class(node: Node, name: str, given: str | None) -> Any:
    """Return the class of a service, given by the user or learned from its servers and clients.

    Raises:
        CommandError: the service is unknown, or has several types.
    """
    users = lookup.endpoints(node, *SERVICE_KINDS, name=name)
    types = sorted({user.type_name for user in users})
    if given is not None:
        types = [given]
        users = [user for user in users if user.type_name == given]
    if not types:
        raise SERVICE.unknown(node, name)
    if len(types) > 1:
        raise CommandError(
            f"Service '{name}' has more than one type: {', '.join(types)}; give one of them after "
            "the service name"
        )
    action, _, part = types[0].rpartition("_")
    if "/action/" in types[0] and part in ACTION_SERVICES:
        found = await lookup.type_of_action(node, name.rpartition("/_action/")[0], action)
        return getattr(found.Impl, ACTION_SERVICES[part])
    if users:
        return await lookup.type_of(node, users)
    return lookup.interface_class("service", types[0])
