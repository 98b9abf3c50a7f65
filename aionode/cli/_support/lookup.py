"""Nodes, endpoints and types on the network, without those of the command itself."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import CommandError, InterfaceNotFoundError
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from aionode.graph import EndpointInfo, NodeInfo
    from aionode.message import Message
    from aionode.node import Node

__all__ = [
    "ALIKE",
    "absolute",
    "actions_and_types",
    "class_given",
    "close_to",
    "endpoints",
    "interface_class",
    "is_own",
    "likeness",
    "names_and_types",
    "node_infos",
    "only_type",
    "topic_type",
    "type_of",
    "type_of_action",
    "unknown",
]

ALIKE: Final = 0.75
"""How alike two names are at least if one of them is taken for the other, misspelled."""


def is_own(node: Node, info: NodeInfo) -> bool:
    """Return whether `info` is the node of the command itself."""
    return (
        info.participant == node.context.participant
        and info.fully_qualified_name == node.get_fully_qualified_name()
    )


def node_infos(node: Node, *, hidden: bool = False) -> list[NodeInfo]:
    """Return the other nodes, sorted by name."""
    others = [
        info
        for info in node.graph.nodes()
        if not is_own(node, info) and (hidden or not info.name.startswith("_"))
    ]
    return sorted(others, key=lambda info: info.fully_qualified_name)


def endpoints(
    node: Node, *kinds: EndpointKind, name: str | None = None, of: NodeInfo | None = None
) -> list[EndpointInfo]:
    """Return the endpoints of other nodes."""
    return [
        endpoint
        for endpoint in node.graph.endpoints(*kinds, name=name, node=of)
        if not is_own(node, endpoint.node)
    ]


def names_and_types(
    node: Node, *kinds: EndpointKind, hidden: bool = False, of: NodeInfo | None = None
) -> dict[str, list[str]]:
    """Return the names of other nodes' endpoints, sorted, each with its types."""
    types: dict[str, set[str]] = {}
    for endpoint in endpoints(node, *kinds, of=of):
        if hidden or not is_hidden(endpoint.name):
            types.setdefault(endpoint.name, set()).add(endpoint.type_name)
    return {name: sorted(types[name]) for name in sorted(types)}


def actions_and_types(
    node: Node, *kinds: EndpointKind, of: NodeInfo | None = None
) -> dict[str, list[str]]:
    """Return the actions of other nodes, sorted, each with its types.

    Args:
        node: The command's node.
        kinds: Publishers for the servers, which publish feedback; subscriptions for the clients.
        of: Only the actions of this node.
    """
    from aionode._node.graph import actions_among

    topics = names_and_types(node, *kinds, hidden=True, of=of)
    return dict(actions_among(list(topics.items())))


# Errors with help


def likeness(name: str, other: str) -> float:
    """Return how alike two names are, from 0 to 1: as much as the parts that differ most.

    Case is no difference, nor is a namespace that only one of them has. The parts are compared one
    by one, so that a long namespace, or a last part such as ``get_parameters``, which many names
    share, does not make different words alike.
    """
    pairs = zip(parts(name), parts(other), strict=False)
    return min(difflib.SequenceMatcher(None, *pair).ratio() for pair in pairs)


def parts(name: str) -> list[str]:
    """Return the parts of a name in lower case, the last one first, each with its slash."""
    return [f"/{part}" for part in reversed(name.lower().strip("/").split("/"))]


def close_to(name: str, names: Iterable[str]) -> str:
    """Return a hint at the name that was probably meant, or an empty string."""
    shortest_first = sorted(names, key=lambda known: (len(known), known))
    close = max(shortest_first, key=lambda known: likeness(name, known), default="")
    return f". Did you mean '{close}'?" if close and likeness(name, close) >= ALIKE else ""


def unknown(text: str, name: str, names: Iterable[str], shows: str) -> CommandError:
    """Return the error for an unknown name, with a similar one or the command that lists them."""
    hint = close_to(name, names) or f". `aionode {shows}` lists those available"
    return CommandError(f"{text} '{name}'{hint}")


# Types


def interface_class(kind: str, name: str) -> Any:
    """Return the class for the type name that the user gave.

    Args:
        kind: ``message``, ``service`` or ``action``.
        name: Its ROS name.

    Raises:
        CommandError: there is no such type.
    """
    from aionode import interfaces

    get = {
        "message": interfaces.get_message,
        "service": interfaces.get_service,
        "action": interfaces.get_action,
    }[kind]
    try:
        return get(name)
    except InterfaceNotFoundError as error:
        hint = "" if error.suggestions else "; `--interfaces PATH` loads definitions of your own"
        raise CommandError(f"The passed {kind} type is invalid: {error}{hint}") from error


def class_given(kind: str, given: str, name: str, used: Collection[str]) -> Any:
    """Return the class for the type that the user gave for a name on the network.

    Args:
        kind: ``service`` or ``action``.
        given: The type that the user gave.
        name: Full name of the service or action.
        used: The types that the name has on the network; empty if it is not there.

    Raises:
        CommandError: there is no such type, or the name has another one.
    """
    interface = interface_class(kind, given)
    if used and interface.__ros_type__ not in used:
        raise CommandError(
            f"The passed {kind} type is invalid: '{name}' has type {', '.join(used)}, not {given}"
        )
    return interface


async def topic_type(node: Node, topic: str, given: str | None = None) -> type[Message] | None:
    """Return the class of a topic's messages according to its endpoints; None if it has none.

    Args:
        node: The command's node.
        topic: Full name of the topic.
        given: The type that the user gave; only endpoints of that type are considered.

    Raises:
        CommandError: the endpoints have several types, or the type cannot be determined.
    """
    users = endpoints(node, *TOPIC_KINDS, name=topic)
    if given is not None:
        users = [user for user in users if user.type_name == given]
        if not users:
            given_type: type[Message] = interface_class("message", given)
            return given_type
    if only_type("topic", topic, users) is None:
        return None
    learned: type[Message] = await type_of(node, users)
    return learned


def only_type(word: str, name: str, users: Iterable[EndpointInfo]) -> str | None:
    """Return the type of the endpoints of a name; None if there are none.

    Args:
        word: ``topic`` or ``service``.
        name: Full name of the topic or service.
        users: Its endpoints.

    Raises:
        CommandError: the endpoints have several types.
    """
    types = sorted({user.type_name for user in users})
    if len(types) > 1:
        raise CommandError(
            f"{word.capitalize()} '{name}' has more than one type: {', '.join(types)}; give one of "
            f"them after the {word} name"
        )
    return types[0] if types else None


async def type_of(node: Node, users: list[EndpointInfo]) -> Any:
    """Return the class for endpoints that all have the same type.

    Raises:
        CommandError: the type is not known here, and no node describes it.
    """
    return await described(node, users[0].type_name, users[0].name, users)


async def type_of_action(node: Node, name: str, type_name: str) -> Any:
    """Return the class of the type of an action.

    Raises:
        CommandError: the type is not known here, and no node describes it.
    """
    hidden = f"{name}/_action/"
    users = [
        endpoint for endpoint in endpoints(node, *EndpointKind) if endpoint.name.startswith(hidden)
    ]
    return await described(node, type_name, name, users)


async def described(node: Node, type_name: str, name: str, users: list[EndpointInfo]) -> Any:
    """Return the class of a type that some endpoints use, if need be as their nodes describe it."""
    try:
        return await node.find_type(type_name, endpoints=users)
    except InterfaceNotFoundError as error:
        raise CommandError(
            f"Type of '{name}': {error.problem}; give a folder with its definition: "
            "--interfaces PATH (in Python: aionode.idl.load_interfaces)"
        ) from error


def absolute(node_name: str) -> str:
    """Return the full name of a node; the leading slash may be left out."""
    return node_name if node_name.startswith("/") else f"/{node_name}"
