"""Nodes, endpoints and types on the network, excluding those of the command itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode.errors import CommandError, InterfaceNotFoundError
from aionode.graph import TOPIC_KINDS
from aionode.names import is_hidden

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
    from aionode.message import Message
    from aionode.node import Node

__all__ = [
    "ALIKE",
    "absolute",
    "action_endpoints",
    "actions_and_types",
    "class_of",
    "close_to",
    "endpoints",
    "is_own",
    "likeness",
    "names_and_types",
    "node_infos",
    "only_type",
    "topic_type",
    "unknown",
]

ALIKE: Final = 0.75
"""Minimum similarity at which a name is suggested as the correct spelling of another."""


def is_own(node: Node, info: NodeInfo) -> bool:
    """Return whether `info` describes the command's own node."""
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
        kinds: Publishers to find servers, which publish feedback; subscriptions to find clients.
        of: Only the actions of this node.
    """
    from aionode.engine.graph_queries import actions_among

    topics = names_and_types(node, *kinds, hidden=True, of=of)
    return dict(actions_among(list(topics.items())))


# Errors with hints


def likeness(name: str, other: str) -> float:
    """Return the similarity of two names, from 0 to 1: that of their least similar parts.

    Case is ignored, and so is a namespace that only one of them has. Comparing part by part keeps a
    long namespace, or a last part shared by many names such as ``get_parameters``, from making
    different names similar.
    """
    import difflib  # only for an error text

    pairs = zip(parts(name), parts(other), strict=False)
    return min(difflib.SequenceMatcher(None, *pair).ratio() for pair in pairs)


def parts(name: str) -> list[str]:
    """Return the parts of a name in lower case, last one first, each with its slash."""
    return [f"/{part}" for part in reversed(name.lower().strip("/").split("/"))]


def close_to(name: str, names: Iterable[str]) -> str:
    """Return a hint at the name that was probably meant, or an empty string."""
    shortest_first = sorted(names, key=lambda known: (len(known), known))
    close = max(shortest_first, key=lambda known: likeness(name, known), default="")
    return f". Did you mean '{close}'?" if close and likeness(name, close) >= ALIKE else ""


def unknown(text: str, name: str, names: Iterable[str], shows: str) -> CommandError:
    """Return the error for an unknown name; it suggests a similar one, or how to list them."""
    hint = close_to(name, names) or f". `aionode {shows}` lists those available"
    return CommandError(f"{text} '{name}'{hint}")


# Types


async def class_of(
    node: Node,
    kind: str,
    type_name: str,
    name: str,
    users: Sequence[EndpointInfo] = (),
    used: Collection[str] = (),
) -> Any:
    """Return the class of a type, as described by the nodes that use it, or as known here.

    Args:
        node: The command's node.
        kind: ``message``, ``service`` or ``action``.
        type_name: The type.
        name: Full name of the topic, service or action.
        users: Its endpoints of that type.
        used: All types that the name has on the network, if `type_name` must be one of them.

    Raises:
        CommandError: there is no such type, no node describes it, or the name has another type.
    """
    from aionode import interfaces

    known = {
        "message": interfaces.get_message,
        "service": interfaces.get_service,
        "action": interfaces.get_action,
    }
    try:
        if users:
            return await node.find_type(type_name, endpoints=users)
        interface: Any = known[kind](type_name)
    except InterfaceNotFoundError as error:
        if users:
            raise CommandError(
                f"Type of '{name}': {error.problem}; give a folder with its definition: "
                "--interfaces PATH"
            ) from error
        raise CommandError(f"The passed {kind} type is invalid: {error}") from error
    if used and interface.__ros_type__ not in used:
        raise CommandError(
            f"The passed {kind} type is invalid: '{name}' has type {', '.join(sorted(used))}, not "
            f"{type_name}"
        )
    return interface


async def topic_type(node: Node, topic: str, given: str | None = None) -> type[Message] | None:
    """Return the class of a topic's messages; None if no type is given and it has no endpoints.

    Args:
        node: The command's node.
        topic: Full name of the topic.
        given: The type given by the user; only endpoints of that type are considered.

    Raises:
        CommandError: the endpoints have several types, or the type cannot be determined.
    """
    users = endpoints(node, *TOPIC_KINDS, name=topic)
    type_name = given or only_type("topic", topic, users)
    if type_name is None:
        return None
    users = [user for user in users if user.type_name == type_name]
    msg_type: type[Message] = await class_of(node, "message", type_name, topic, users)
    return msg_type


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


def action_endpoints(node: Node, name: str) -> list[EndpointInfo]:
    """Return the endpoints of the hidden topics and services of an action."""
    hidden = f"{name}/_action/"
    return [endpoint for endpoint in endpoints(node) if endpoint.name.startswith(hidden)]


def absolute(node_name: str) -> str:
    """Return the full name of a node; the leading slash may be omitted."""
    return node_name if node_name.startswith("/") else f"/{node_name}"
