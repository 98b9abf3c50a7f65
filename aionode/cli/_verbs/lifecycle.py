"""The verbs of ``aionode lifecycle``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from aionode.cli._support import lookup
from aionode.errors import CommandError
from aionode.graph import EndpointKind
from aionode.interfaces.lifecycle_msgs.msg import Transition
from aionode.interfaces.lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from aionode.message import Message

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.interfaces.lifecycle_msgs.msg import TransitionDescription
    from aionode.message import ServiceClass
    from aionode.node import Node

__all__ = [
    "get_state",
    "list_nodes",
    "list_transitions",
    "managed_nodes",
    "set_state",
    "transitions",
]

RequestT = TypeVar("RequestT", bound=Message)

ResponseT = TypeVar("ResponseT", bound=Message)

ANSWER_S = 10.0
"""Timeout for answers that need no work of the node, in seconds."""

# Verbs


def managed_nodes(node: Node, *, hidden: bool = False) -> list[str]:
    """Return the full names of the managed nodes: those with a `get_state` service."""
    names = {
        server.node.fully_qualified_name
        for server in lookup.endpoints(node, EndpointKind.SERVER)
        if server.type_name == GetState.__ros_type__
        and server.name == f"{server.node.fully_qualified_name}/get_state"
        and (hidden or not server.node.name.startswith("_"))
    }
    return sorted(names)


async def list_nodes(
    node: Node, *, output: Output, hidden: bool = False, count: bool = False
) -> None:
    """Print the full name of every managed node."""
    names = managed_nodes(node, hidden=hidden)
    if count:
        output.item(str(len(names)), {"nodes": len(names)})
        return
    for name in names:
        output.item(name, {"name": name})


async def get_state(
    node: Node, node_name: str | None, *, output: Output, hidden: bool = False
) -> None:
    """Print the state of one managed node, or of all.

    Raises:
        CommandError: there is no such node.
        RequestTimeoutError: a node does not answer.
    """
    names = [known(node, node_name)] if node_name else managed_nodes(node, hidden=hidden)
    for name in names:
        response = await ask(node, name, "get_state", GetState, GetState.Request())
        state = response.current_state
        text = f"{state.label} [{state.id}]"
        output.item(
            text if node_name else f"{name}: {text}",
            {"name": name, "state": state.label, "id": state.id},
        )


async def list_transitions(
    node: Node, node_name: str, *, output: Output, every: bool = False
) -> None:
    """Print the transitions that are available to a managed node now, or all that exist.

    Raises:
        CommandError: there is no such node.
        RequestTimeoutError: the node does not answer.
    """
    name = known(node, node_name)
    for one in await transitions(node, name, every=every):
        output.item(
            f"- {one.transition.label} [{one.transition.id}]\n"
            f"\tStart: {one.start_state.label}\n\tGoal: {one.goal_state.label}",
            {
                "label": one.transition.label,
                "id": one.transition.id,
                "start": one.start_state.label,
                "goal": one.goal_state.label,
            },
        )


async def set_state(node: Node, node_name: str, transition: str, *, output: Output) -> None:
    """Trigger a transition of a managed node, given by its label or id, and wait for its end.

    Raises:
        CommandError: there is no such node or transition, or the transition failed.
    """
    name = known(node, node_name)
    available = await transitions(node, name)
    chosen = next(
        (
            one.transition
            for one in available
            if transition in {one.transition.label, str(one.transition.id)}
        ),
        None,
    )
    if chosen is None and transition == "shutdown":
        chosen = Transition(label=transition)  # available in every state, but not listed
    if chosen is None:
        fits = ", ".join(f"{one.transition.label} [{one.transition.id}]" for one in available)
        raise CommandError(f"Unknown transition requested, available ones are: {fits}")
    client = node.create_client(ChangeState, f"{name}/change_state")
    response = await client.call(ChangeState.Request(transition=chosen))
    if not response.success:
        raise CommandError("Transitioning failed")
    output.item("Transitioning successful", {"name": name, "transition": chosen.label})


def known(node: Node, node_name: str) -> str:
    """Return the full name of a managed node; the leading slash may be left out.

    Raises:
        CommandError: there is no such node.
    """
    name = lookup.absolute(node_name)
    names = managed_nodes(node, hidden=True)
    if name not in names:
        raise CommandError(f"Node not found{lookup.close_to(name, names)}")
    return name


async def transitions(node: Node, name: str, *, every: bool = False) -> list[TransitionDescription]:
    """Return the transitions of a managed node."""
    service = "get_transition_graph" if every else "get_available_transitions"
    request = GetAvailableTransitions.Request()
    response = await ask(node, name, service, GetAvailableTransitions, request)
    return list(response.available_transitions)


async def ask(
    node: Node,
    name: str,
    service: str,
    srv_type: ServiceClass[RequestT, ResponseT],
    request: RequestT,
) -> ResponseT:
    """Call a service of a managed node that answers at once."""
    client = node.create_client(srv_type, f"{name}/{service}")
    return await client.call(request, timeout_sec=ANSWER_S)
