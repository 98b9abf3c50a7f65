"""The services of rosapi, which clients of rosbridge ask about the robot.

The gateway answers them itself: no node of this name has to run, and what the policy hides from a
client is not in its answers.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable, Iterable
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.errors import AionodeError, InterfaceNotFoundError, MessageError
from aionode.gateway._rosapi_types import full_text, type_definitions
from aionode.gateway._rosbridge_request import full_name
from aionode.gateway._rosbridge_values import stamp
from aionode.graph import EndpointKind
from aionode.interfaces import interface_names

if TYPE_CHECKING:
    from aionode.gateway._session import Session

__all__ = ["SERVICES", "answer"]

Args = dict[str, Any]
Answer = Callable[["Session", Args], Awaitable[dict[str, Any]]]

SERVICES: Final[dict[str, tuple[tuple[str, ...], Answer]]] = {}
"""The fields of the request, and the function that answers, for each service."""


def service(name: str, *request: str) -> Callable[[Answer], Answer]:
    """Have a function answer a service; `request` has the fields of its request in their order."""

    def add(answer: Answer) -> Answer:
        SERVICES[name] = (request, answer)
        return answer

    return add


async def answer(session: Session, name: str, args: dict[str, Any] | list[Any]) -> dict[str, Any]:
    """Return the response of a service of rosapi.

    Args:
        session: The session of the client.
        name: The service, without ``/rosapi/``.
        args: The values of the request, or a list of them by position.

    Raises:
        MessageError: there is no such service, or a value of the request is invalid.
        AionodeError: something that the service is about is not known.
    """
    if name not in SERVICES:
        raise MessageError(f"/rosapi/{name}", f"no such service; there are {', '.join(SERVICES)}")
    fields, make = SERVICES[name]
    values = dict(zip(fields, args, strict=False)) if isinstance(args, list) else args
    for field in fields:
        value = values.get(field, "")
        if not isinstance(value, str):
            raise MessageError(f"/rosapi/{name}.{field}", f"{value!r}, needs text")
    return await make(session, {field: values.get(field, "") for field in fields})


# Topics


def visible(names: Iterable[str]) -> list[str]:
    """Return the names that are not hidden: no part begins with an underscore."""
    return [name for name in names if "/_" not in name]


def short(type_name: str) -> str:
    """Return the name of a type without its kind, for comparisons."""
    parts = type_name.split("/")
    return f"{parts[0]}/{parts[-1]}"


@service("topics")
async def topics(session: Session, _: Args) -> dict[str, Any]:
    found = session.topics()
    names = visible(found)
    return {"topics": names, "types": [found[name][0] for name in names]}


@service("topics_and_raw_types")
async def topics_and_raw_types(session: Session, _: Args) -> dict[str, Any]:
    found = await topics(session, _)
    by_type = {name: await text_of(session, name) for name in dict.fromkeys(found["types"])}
    return {**found, "typedefs_full_text": [by_type[name] for name in found["types"]]}


async def text_of(session: Session, name: str) -> str:
    """Return the full definition of a type, or a comment that says why there is none."""
    try:
        return full_text(await session.message_class(name))
    except AionodeError as error:
        return f"# failed to get full definition text for {name}: {error}"


@service("topics_for_type", "type")
async def topics_for_type(session: Session, args: Args) -> dict[str, Any]:
    return {"topics": of_type(session.topics(), args["type"])}


def of_type(found: dict[str, list[str]], wanted: str) -> list[str]:
    """Return the names that have a type, given with or without its kind."""
    return [name for name, types in found.items() if short(wanted) in map(short, types)]


@service("topic_type", "topic")
async def topic_type(session: Session, args: Args) -> dict[str, Any]:
    return {"type": type_among(session.topics(), args["topic"])}


def type_among(found: dict[str, list[str]], name: str) -> str:
    """Return the type of a name, or an empty text if it is unknown."""
    return next(iter(found.get(full_name(name), ())), "")


@service("publishers", "topic")
async def publishers(session: Session, args: Args) -> dict[str, Any]:
    return {"publishers": nodes_with(session, "publishers", args["topic"])}


@service("subscribers", "topic")
async def subscribers(session: Session, args: Args) -> dict[str, Any]:
    return {"subscribers": nodes_with(session, "subscriptions", args["topic"])}


def nodes_with(session: Session, kind: str, name: str) -> list[str]:
    """Return the nodes that have an endpoint of a kind and a name."""
    return [
        node
        for node in session.nodes()
        if full_name(name) in getattr(session.node_details(node), kind)
    ]


# Services, actions, nodes


@service("services")
async def services(session: Session, _: Args) -> dict[str, Any]:
    return {"services": [*session.services(), *(f"/rosapi/{name}" for name in SERVICES)]}


@service("services_for_type", "type")
async def services_for_type(session: Session, args: Args) -> dict[str, Any]:
    return {"services": of_type(session.services(), args["type"])}


@service("service_type", "service")
async def service_type(session: Session, args: Args) -> dict[str, Any]:
    own = full_name(args["service"]).removeprefix("/rosapi/")
    if own in SERVICES:
        return {"type": f"rosapi_msgs/srv/{TYPE_NAMES.get(own, camel(own))}"}
    return {"type": type_among(session.services(), args["service"])}


TYPE_NAMES: Final = {
    "action_servers": "GetActionServers",
    "get_ros_version": "GetROSVersion",
}


def camel(name: str) -> str:
    """Return the name of the type of a service of rosapi."""
    return "".join(word.capitalize() for word in name.split("_"))


@service("service_node", "service")
async def service_node(session: Session, args: Args) -> dict[str, Any]:
    return {"node": next(iter(nodes_with(session, "services", args["service"])), "")}


@service("service_providers", "service")
async def service_providers(session: Session, args: Args) -> dict[str, Any]:
    # The field has the name of a service, and what clients send is a type; both are understood.
    names = {full_name(args["service"]), *of_type(session.services(), args["service"])}
    providers = [
        node for node in session.nodes() if names & set(session.node_details(node).services)
    ]
    return {"providers": providers}


@service("action_servers")
async def action_servers(session: Session, _: Args) -> dict[str, Any]:
    graph = session._robot.node.graph
    served = [
        name
        for name in session.actions()
        if graph.count(EndpointKind.SERVER, f"{name}/_action/send_goal")
    ]
    return {"action_servers": served}


@service("action_type", "action")
async def action_type(session: Session, args: Args) -> dict[str, Any]:
    return {"type": type_among(session.actions(), args["action"])}


@service("nodes")
async def nodes(session: Session, _: Args) -> dict[str, Any]:
    return {"nodes": session.nodes()}


@service("node_details", "node")
async def node_details(session: Session, args: Args) -> dict[str, Any]:
    name = full_name(args["node"])
    if name not in session.nodes():
        return {"subscribing": [], "publishing": [], "services": []}
    details = session.node_details(name)
    return {
        "subscribing": list(details.subscriptions),
        "publishing": list(details.publishers),
        "services": list(details.services),
    }


@service("interfaces")
async def interfaces(_session: Session, _: Args) -> dict[str, Any]:
    return {"interfaces": list(interface_names())}


# Types


def details_of(name: str, kind: str, part: str) -> None:
    """Add a service that describes a part of a service or action type; or a message type."""

    @service(name, "type")
    async def details(session: Session, args: Args) -> dict[str, Any]:
        find = {"msg": session.message_class, "srv": session.service_class}
        found = await find.get(kind, session.action_class)(args["type"])
        described: Any = getattr(found, part, None) if part else found
        if not hasattr(described, "__ros_fields__"):
            raise InterfaceNotFoundError(args["type"], problem=f"it is no type of kind {kind}")
        return {"typedefs": type_definitions(described)}


details_of("message_details", "msg", "")
details_of("service_request_details", "srv", "Request")
details_of("service_response_details", "srv", "Response")
details_of("action_goal_details", "action", "Goal")
details_of("action_result_details", "action", "Result")
details_of("action_feedback_details", "action", "Feedback")


# Parameters


def parameter_name(name: str) -> tuple[str, str]:
    """Return node and parameter of ``/node:parameter``.

    Raises:
        MessageError: the name has no colon.
    """
    node, colon, parameter = name.partition(":")
    if not (node and colon and parameter):
        raise MessageError("name", f"{name!r}, needs a node and a parameter, as /node:parameter")
    return full_name(node), parameter


def failed(error: Exception) -> dict[str, Any]:
    """Return the fields of an answer that say why a parameter was not read or set."""
    return {"successful": False, "reason": str(error) or "the node has not answered in time"}


@service("get_param", "name", "default_value")
async def get_param(session: Session, args: Args) -> dict[str, Any]:
    try:
        return {"value": await parameter_json(session, args["name"]), **DONE}
    except (AionodeError, TimeoutError) as error:
        return {"value": args["default_value"], **failed(error)}


DONE: Final = {"successful": True, "reason": ""}


async def parameter_json(session: Session, name: str) -> str:
    """Return the value of a parameter as JSON.

    Raises:
        MessageError: there is no such parameter.
    """
    value = await parameter_value(session, name)
    if value is None:
        raise MessageError(name, "not declared by its node, or not set")
    return msgspec.json.encode(plain(value)).decode()


async def parameter_value(session: Session, name: str) -> Any:
    """Return the value of a parameter; None if its node has none of this name."""
    node, parameter = parameter_name(name)
    return (await session.get_parameters(node, [parameter])).get(parameter)


def plain(value: Any) -> Any:
    """Return the value of a parameter as builtin types."""
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, bytes):
        return value[0]
    return value.tolist() if hasattr(value, "tolist") else value


@service("set_param", "name", "value")
async def set_param(session: Session, args: Args) -> dict[str, Any]:
    try:
        value = msgspec.json.decode(args["value"])
        node, parameter = parameter_name(args["name"])
        (result,) = await session.set_parameters(node, {parameter: value})
    except (AionodeError, TimeoutError, TypeError, msgspec.DecodeError) as error:
        return failed(error)
    return {"successful": result.successful, "reason": result.reason}


@service("has_param", "name")
async def has_param(session: Session, args: Args) -> dict[str, Any]:
    try:
        found = await parameter_value(session, args["name"])
    except (AionodeError, TimeoutError):
        return {"exists": False}
    return {"exists": found is not None}


@service("delete_param", "name")
async def delete_param(session: Session, args: Args) -> dict[str, Any]:
    try:
        node, parameter = parameter_name(args["name"])
        (result,) = await session.set_parameters(node, {parameter: None})
    except (AionodeError, TimeoutError) as error:
        return failed(error)
    return {"successful": result.successful, "reason": result.reason}


@service("get_param_names")
async def get_param_names(session: Session, _: Args) -> dict[str, Any]:
    async with asyncio.TaskGroup() as tasks:
        asked = [tasks.create_task(names_of(session, node)) for node in session.nodes()]
    return {"names": sorted({name for task in asked for name in task.result()})}


async def names_of(session: Session, node: str) -> list[str]:
    """Return the parameters of a node, none if it does not answer."""
    try:
        return [f"{node}:{name}" for name in await session.parameter_names(node)]
    except (AionodeError, TimeoutError):
        return []


# Time and version


@service("get_time")
async def get_time(session: Session, _: Args) -> dict[str, Any]:
    time = stamp(session.now_ns())
    # roslibpy reads the words of ROS 1.
    return {"time": {**time, "secs": time["sec"], "nsecs": time["nanosec"]}}


@service("get_ros_version")
async def get_ros_version(_session: Session, _: Args) -> dict[str, Any]:
    return {"version": 2, "distro": os.environ.get("ROS_DISTRO", "")}
