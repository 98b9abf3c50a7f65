"""The services of rosapi, by which rosbridge clients ask about the robot.

The gateway answers them itself: no rosapi node has to run, and answers leave out what the policy
hides from the client.
"""

from __future__ import annotations

import os
from collections.abc import Awaitable, Callable, Iterable
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._process.concurrency import checkpoint
from aionode.errors import AionodeError, InterfaceNotFoundError, MessageError
from aionode.gateway.rosbridge.request import full_name
from aionode.gateway.rosbridge.rosapi_types import full_text, type_definitions
from aionode.gateway.session.encoding.client_json import decoded, shown
from aionode.gateway.session.encoding.values import stamp
from aionode.graph import EndpointKind
from aionode.interfaces import interface_names
from aionode.parameter import Parameter

if TYPE_CHECKING:
    from aionode.gateway.session.graph import Kind
    from aionode.gateway.session.session import Session

__all__ = ["SERVICES", "answer"]

Args = dict[str, Any]
Answer = Callable[["Session", Args], Awaitable[dict[str, Any]]]

SERVICES: Final[dict[str, tuple[tuple[str, ...], Answer]]] = {}
"""The request fields and the answering function of each service."""


def service(name: str, *request: str) -> Callable[[Answer], Answer]:
    """Declare the function that answers a service, given the request's fields in order."""

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
        RefusedError: too many requests of the client are waiting.
        AionodeError: the subject of the request is unknown.
    """
    if name not in SERVICES:
        raise MessageError(f"/rosapi/{name}", f"no such service; use one of {', '.join(SERVICES)}")
    fields, make = SERVICES[name]
    values = dict(zip(fields, args, strict=False)) if isinstance(args, list) else args
    for field in fields:
        value = values.get(field, "")
        if not isinstance(value, str):
            raise MessageError(f"/rosapi/{name}.{field}", f"{shown(value)}; use text")
    await session.graph.turn()
    return await make(session, {field: values.get(field, "") for field in fields})


# Topics


def visible(names: Iterable[str]) -> list[str]:
    """Filter out hidden names, which have a part that starts with an underscore."""
    return [name for name in names if "/_" not in name]


def short(type_name: str) -> str:
    """Return a type name without its kind, for comparison."""
    parts = type_name.split("/")
    return f"{parts[0]}/{parts[-1]}"


@service("topics")
async def topics(session: Session, _: Args) -> dict[str, Any]:
    types = session.graph.topics()
    names = visible(types)
    return {"topics": names, "types": [types[name][0] for name in names]}


@service("topics_and_raw_types")
async def topics_and_raw_types(session: Session, _: Args) -> dict[str, Any]:
    listed = await topics(session, _)
    by_type = {}
    for name in dict.fromkeys(listed["types"]):
        by_type[name] = await text_of(session, name)
        await checkpoint()  # a text takes a while, and a robot has hundreds of types
    return {**listed, "typedefs_full_text": [by_type[name] for name in listed["types"]]}


async def text_of(session: Session, name: str) -> str:
    """Return the full definition of a type, or a comment with the reason why there is none."""
    try:
        return full_text(await session.message_class(name))
    except AionodeError as error:
        return f"# failed to get full definition text for {name}: {error}"


@service("topics_for_type", "type")
async def topics_for_type(session: Session, args: Args) -> dict[str, Any]:
    return {"topics": of_type(session.graph.topics(), args["type"])}


def of_type(names: dict[str, list[str]], wanted: str) -> list[str]:
    """Return the names that have a type, given with or without its kind."""
    return [name for name, types in names.items() if short(wanted) in map(short, types)]


@service("topic_type", "topic")
async def topic_type(session: Session, args: Args) -> dict[str, Any]:
    return {"type": type_of(session, args["topic"], "topic")}


def type_of(session: Session, name: str, kind: Kind) -> str:
    """Return the type of a name, or an empty text if it is unknown."""
    return next(iter(session.graph.types_of(full_name(name), kind)), "")


@service("publishers", "topic")
async def publishers(session: Session, args: Args) -> dict[str, Any]:
    return {"publishers": session.graph.users(EndpointKind.PUBLISHER, full_name(args["topic"]))}


@service("subscribers", "topic")
async def subscribers(session: Session, args: Args) -> dict[str, Any]:
    return {"subscribers": session.graph.users(EndpointKind.SUBSCRIPTION, full_name(args["topic"]))}


# Services, actions, nodes


@service("services")
async def services(session: Session, _: Args) -> dict[str, Any]:
    return {"services": [*session.graph.services(), *(f"/rosapi/{name}" for name in SERVICES)]}


@service("offered")
async def offered(session: Session, _: Args) -> dict[str, Any]:
    """Return everything except infrastructure, for pages; rosapi itself has no such service."""
    found = session.graph.offered()
    return {
        "nodes": found.nodes,
        "topics": list(found.topics),
        "types": [types[0] for types in found.topics.values()],
        "services": list(found.services),
        "actions": list(found.actions),
    }


@service("services_for_type", "type")
async def services_for_type(session: Session, args: Args) -> dict[str, Any]:
    return {"services": of_type(session.graph.services(), args["type"])}


@service("service_type", "service")
async def service_type(session: Session, args: Args) -> dict[str, Any]:
    own = full_name(args["service"]).removeprefix("/rosapi/")
    if own in SERVICES:
        return {"type": f"rosapi_msgs/srv/{TYPE_NAMES.get(own, camel(own))}"}
    return {"type": type_of(session, args["service"], "service")}


TYPE_NAMES: Final = {
    "action_servers": "GetActionServers",
    "get_ros_version": "GetROSVersion",
}


def camel(name: str) -> str:
    """Return the type name of a rosapi service."""
    return "".join(word.capitalize() for word in name.split("_"))


@service("service_node", "service")
async def service_node(session: Session, args: Args) -> dict[str, Any]:
    return {
        "node": next(iter(session.graph.users(EndpointKind.SERVER, full_name(args["service"]))), "")
    }


@service("service_providers", "service")
async def service_providers(session: Session, args: Args) -> dict[str, Any]:
    # The field has the name of a service, but clients send a type; both are understood.
    names = {full_name(args["service"]), *of_type(session.graph.services(), args["service"])}
    providers = {node for name in names for node in session.graph.users(EndpointKind.SERVER, name)}
    return {"providers": sorted(providers)}


@service("action_servers")
async def action_servers(session: Session, _: Args) -> dict[str, Any]:
    graph = session.robot.node.graph
    served = [
        name
        for name in session.graph.actions()
        if graph.count(EndpointKind.SERVER, f"{name}/_action/send_goal")
    ]
    return {"action_servers": served}


@service("action_type", "action")
async def action_type(session: Session, args: Args) -> dict[str, Any]:
    return {"type": type_of(session, args["action"], "action")}


@service("nodes")
async def nodes(session: Session, _: Args) -> dict[str, Any]:
    return {"nodes": session.graph.nodes()}


@service("node_details", "node")
async def node_details(session: Session, args: Args) -> dict[str, Any]:
    name = full_name(args["node"])
    if name not in session.graph.nodes():
        return {"subscribing": [], "publishing": [], "services": []}
    details = session.graph.node_details(name)
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
    """Add a service that describes a part of a service or action type, or a message type."""

    @service(name, "type")
    async def details(session: Session, args: Args) -> dict[str, Any]:
        find = {"msg": session.message_class, "srv": session.service_class}
        found_class = await find.get(kind, session.action_class)(args["type"])
        described: Any = getattr(found_class, part, None) if part else found_class
        if not hasattr(described, "__ros_fields__"):
            raise InterfaceNotFoundError(args["type"], problem=f"it is not a type of kind {kind}")
        return {"typedefs": type_definitions(described)}


details_of("message_details", "msg", "")
details_of("service_request_details", "srv", "Request")
details_of("service_response_details", "srv", "Response")
details_of("action_goal_details", "action", "Goal")
details_of("action_result_details", "action", "Result")
details_of("action_feedback_details", "action", "Feedback")


# Parameters


def parameter_name(name: str) -> tuple[str, str]:
    """Split ``/node:parameter`` into node and parameter.

    Raises:
        MessageError: the name has no colon.
    """
    node, colon, parameter = name.partition(":")
    if not (node and colon and parameter):
        problem = f"{shown(name)}; use a node and a parameter, as /node:parameter"
        raise MessageError("name", problem)
    return full_name(node), parameter


def failed(session: Session, error: Exception) -> dict[str, Any]:
    """Return the fields of an answer that give the reason why a parameter was not read or set."""
    session.rights.note_failure(error, "rosapi")
    return {"successful": False, "reason": str(error) or "the node did not answer in time"}


@service("get_param", "name", "default_value")
async def get_param(session: Session, args: Args) -> dict[str, Any]:
    try:
        return {"value": await parameter_json(session, args["name"]), **DONE}
    except (AionodeError, TimeoutError) as error:
        return {"value": args["default_value"], **failed(session, error)}


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
    """Return the value of a parameter; None if its node does not have it."""
    node, parameter = parameter_name(name)
    found = (await session.parameters.get(node, [parameter])).get(parameter)
    return None if found is None else found.value


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
        value = decoded(args["value"], session.rights.limits.frame_parts, "value")
        node, parameter = parameter_name(args["name"])
        result = await session.parameters.set_json(node, parameter, value)
    except (AionodeError, TimeoutError) as error:
        return failed(session, error)
    return {"successful": result.successful, "reason": result.reason}


@service("has_param", "name")
async def has_param(session: Session, args: Args) -> dict[str, Any]:
    try:
        value = await parameter_value(session, args["name"])
    except (AionodeError, TimeoutError) as error:
        session.rights.note_failure(error, "rosapi")
        return {"exists": False}
    return {"exists": value is not None}


@service("delete_param", "name")
async def delete_param(session: Session, args: Args) -> dict[str, Any]:
    try:
        node, parameter = parameter_name(args["name"])
        result = await session.parameters.set(node, Parameter(parameter))
    except (AionodeError, TimeoutError) as error:
        return failed(session, error)
    return {"successful": result.successful, "reason": result.reason}


@service("get_param_names")
async def get_param_names(session: Session, _: Args) -> dict[str, Any]:
    names_of = await session.parameters.all_names()
    return {"names": sorted(f"{node}:{name}" for node, names in names_of.items() for name in names)}


# Time and version


@service("get_time")
async def get_time(session: Session, _: Args) -> dict[str, Any]:
    time = stamp(session.now_ns())
    # roslibpy reads the field names of ROS 1.
    return {"time": {**time, "secs": time["sec"], "nsecs": time["nanosec"]}}


@service("get_ros_version")
async def get_ros_version(_session: Session, _: Args) -> dict[str, Any]:
    return {"version": 2, "distro": os.environ.get("ROS_DISTRO", "")}
