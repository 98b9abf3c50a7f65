"""Find the class of a type by its name: the program's own, or one described by other nodes.

A node with ``~/get_type_description`` describes its types. A class made from a description is
accepted only if its type hash is the one in the graph, which may have none for endpoints behind a
bridge.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode._distribution import NO_TYPE_HASH
from aionode.engine.causes import CAUSES
from aionode.engine.wire.described_type import action_from_descriptions, type_from_description
from aionode.engine.wire.typehash import type_hash
from aionode.errors import AionodeError, InterfaceNotFoundError, TypeDescriptionError
from aionode.graph import EndpointKind
from aionode.interfaces import get_interface, part_of, whole_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from aionode.endpoints.core.node_methods import NodeMethods
    from aionode.graph import EndpointInfo, Graph

__all__ = ["find_type"]

ANSWER_S: Final = 2.0
"""Timeout for one description, in seconds of real time; a node answers within milliseconds."""

MAX_ASKED: Final = 5
"""How many nodes are asked about one type at most, as waits for silent ones add up."""

ACTION_PARTS: Final = ("SendGoal", "GetResult", "FeedbackMessage")
"""The types that an action has in the graph, as suffixes of its name."""


async def find_type(node: NodeMethods, name: str, endpoints: Sequence[EndpointInfo] | None) -> Any:
    """Return the class of a type; see `Node.find_type`."""
    users = users_of(node.graph, name) if endpoints is None else list(endpoints)
    try:
        known = get_interface(name)
    except InterfaceNotFoundError:
        whole = whole_of(name)
        if not users and whole is not None:
            return part_of(name, await find_type(node, whole, endpoints))
        if not users:
            raise
        known = None
    hashes = {user.type_hash for user in users if user.type_name == name}
    if known is not None and (not hashes or hashes & {type_hash(known), NO_TYPE_HASH, ""}):
        return known
    problems: list[str] = []
    interface = await described(node, name, users, problems)
    if interface is None:
        raise InterfaceNotFoundError(name, problem=problem_of(known, users, hashes, problems))
    return interface


def users_of(graph: Graph, name: str) -> list[EndpointInfo]:
    """Return the endpoints that use a type, or the parts of an action, of this name."""
    names = {name, *(f"{name}_{part}" for part in ACTION_PARTS)}
    return [endpoint for endpoint in graph.endpoints() if endpoint.type_name in names]


def problem_of(
    known: Any, users: Iterable[EndpointInfo], hashes: set[str], problems: list[str]
) -> str:
    """Return the reason why no class was found."""
    what = "it is not known here"
    if known is not None:
        what = (
            f"its definition here ({type_hash(known)}) is not that of the nodes that use it "
            f"({', '.join(sorted(hashes))})"
        )
    where = sorted({user.node.fully_qualified_name for user in users})
    more = f" and {len(where) - MAX_ASKED} more" if len(where) > MAX_ASKED else ""
    missing = f"{', '.join(where[:MAX_ASKED])}{more} does not describe it"
    return f"{what}, and {'; '.join(problems) or missing}"


async def described(
    node: NodeMethods, name: str, users: list[EndpointInfo], problems: list[str]
) -> Any | None:
    """Return the class described by one of the nodes; None if none describes it.

    Args:
        node: The node that asks.
        name: The type.
        users: Endpoints of that type, or of the parts of that action.
        problems: The reasons why descriptions were not accepted are appended here.
    """
    by_node: dict[str, dict[str, EndpointInfo]] = {}
    for user in users:
        by_node.setdefault(user.node.fully_qualified_name, {})[user.type_name] = user
    for endpoints in list(by_node.values())[:MAX_ASKED]:
        try:
            interface = await described_by(node, name, endpoints)
        except TypeDescriptionError as error:
            problems.append(str(error))
        else:
            if interface is not None:
                return interface
    return None


async def described_by(node: NodeMethods, name: str, users: dict[str, EndpointInfo]) -> Any | None:
    """Return the class described by one node that has endpoints of these types.

    Raises:
        TypeDescriptionError: the description is invalid, or does not match the graph.
    """
    if name in users:
        description = await description_of(node, users[name])
        if description is None:
            return None
        return with_hash(type_from_description(description), users[name])
    parts = [users.get(f"{name}_{part}") for part in ACTION_PARTS]
    descriptions = [None if part is None else await description_of(node, part) for part in parts]
    if None in descriptions:
        return None  # a client's node may describe fewer parts than the server's
    action_type = action_from_descriptions(name, *descriptions)  # type: ignore[arg-type]  # three, none of them None
    impl = action_type.Impl
    kinds = (impl.SendGoalService, impl.GetResultService, impl.FeedbackMessage)
    for kind, part in zip(kinds, parts, strict=True):
        with_hash(kind, part)  # type: ignore[arg-type]  # it has a description
    return action_type


def with_hash(message_type: Any, user: EndpointInfo) -> Any:
    """Return a class after checking that it has the type hash of an endpoint.

    Raises:
        TypeDescriptionError: it has a different one.
    """
    if user.type_hash not in {"", NO_TYPE_HASH, type_hash(message_type)}:
        raise TypeDescriptionError(
            user.type_name,
            f"{user.node.fully_qualified_name} describes a type with the hash "
            f"{type_hash(message_type)}, but uses one with {user.type_hash}",
        )
    return message_type


async def description_of(node: NodeMethods, user: EndpointInfo) -> Any | None:
    """Return the description of an endpoint's type; None if its node does not describe it."""
    # Imported on demand, as most programs know their types.
    from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription

    service = f"{user.node.fully_qualified_name}/get_type_description"
    if not node.graph.count(EndpointKind.SERVER, service):
        return None
    client = node.create_client(GetTypeDescription, service)
    request = GetTypeDescription.Request(type_name=user.type_name, type_hash=user.type_hash)
    acting_for = CAUSES.set(())  # not a cause of what the caller sends
    try:
        response: Any = await client.call(request, timeout_sec=ANSWER_S)
    except AionodeError:
        return None  # the caller says that no node describes the type
    finally:
        CAUSES.reset(acting_for)
        client.destroy()
    return response.type_description if response.successful else None
