"""``aionode lifecycle``: show and change the states of managed nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import click

from aionode.cli._support import lookup
from aionode.cli._support.command import command
from aionode.cli._support.completion import complete_of_node, name_argument
from aionode.cli._support.options import count_option, hidden_nodes_option, positive
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
    "lifecycle_command",
    "list_nodes",
    "list_transitions",
    "set_state",
]

RequestT = TypeVar("RequestT", bound=Message)

ResponseT = TypeVar("ResponseT", bound=Message)

ANSWER_S = 10.0
"""Timeout for answers that require no work by the node, in seconds."""

node_argument = name_argument("node")

timeout_option = click.option(
    "--timeout",
    metavar="N",
    type=positive,
    default=ANSWER_S,
    show_default=True,
    help="Wait at most N seconds for an answer.",
)


@click.group("lifecycle")
def lifecycle_command() -> None:
    """Show and change the states of managed nodes."""


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


@command(lifecycle_command, "nodes", hidden_nodes_option, count_option("nodes"))
async def list_nodes(
    node: Node, *, output: Output, hidden: bool = False, count: bool = False
) -> None:
    """List the managed nodes."""
    names = managed_nodes(node, hidden=hidden)
    output.items([(name, {"name": name}) for name in names], count="nodes" * count)


@command(
    lifecycle_command,
    "get",
    name_argument("node", required=False),
    click.option(
        "--include-hidden-nodes", "hidden", is_flag=True, help="Show hidden nodes as well."
    ),
    timeout_option,
)
async def get_state(
    node: Node,
    node_name: str | None,
    *,
    output: Output,
    hidden: bool = False,
    timeout: float = ANSWER_S,
) -> None:
    """Print the state of one managed node, or of all.

    Raises:
        CommandError: there is no such node.
        RequestTimeoutError: a node does not answer.
    """
    names = [known(node, node_name)] if node_name else managed_nodes(node, hidden=hidden)
    for name in names:
        response = await ask(node, name, "get_state", GetState, GetState.Request(), timeout)
        state = response.current_state
        text = f"{state.label} [{state.id}]"
        output.item(
            text if node_name else f"{name}: {text}",
            {"name": name, "state": state.label, "id": state.id},
        )


@command(
    lifecycle_command,
    "list",
    node_argument,
    click.option(
        "-a", "--all", "every", is_flag=True,
        help="List all transitions, not only the available ones.",
    ),
    timeout_option,
)  # fmt: skip
async def list_transitions(
    node: Node,
    node_name: str,
    *,
    output: Output,
    every: bool = False,
    timeout: float = ANSWER_S,
) -> None:
    """List the transitions that are available to a managed node now.

    Raises:
        CommandError: there is no such node.
        RequestTimeoutError: the node does not answer.
    """
    name = known(node, node_name)
    for available in await transitions(node, name, every=every, timeout=timeout):
        output.item(
            f"- {available.transition.label} [{available.transition.id}]\n"
            f"\tStart: {available.start_state.label}\n\tGoal: {available.goal_state.label}",
            {
                "label": available.transition.label,
                "id": available.transition.id,
                "start": available.start_state.label,
                "goal": available.goal_state.label,
            },
        )


async def labels(node: Node, name: str) -> list[str]:
    """Return the labels of the transitions available to a node; none if it is not managed."""
    if name not in managed_nodes(node, hidden=True):
        return []
    return [available.transition.label for available in await transitions(node, name)]


@command(
    lifecycle_command,
    "set",
    node_argument,
    click.argument("transition", shell_complete=complete_of_node(labels)),
    click.option(
        "--timeout", metavar="N", type=positive, help="Wait at most N seconds for the transition."
    ),
)
async def set_state(
    node: Node,
    node_name: str,
    transition: str,
    *,
    output: Output,
    timeout: float | None = None,
) -> None:
    """Trigger a transition of a managed node, by its label or id.

    Raises:
        CommandError: there is no such node or transition, or the transition failed.
        RequestTimeoutError: the node does not answer.
    """
    name = known(node, node_name)
    listed = await transitions(node, name, timeout=timeout or ANSWER_S)
    available = [description.transition for description in listed]
    fitting = [choice for choice in available if transition in {choice.label, str(choice.id)}]
    if not fitting and transition == "shutdown":
        fitting = [Transition(label=transition)]  # available in every state, but not listed
    if not fitting:
        fits = ", ".join(f"{choice.label} [{choice.id}]" for choice in available)
        raise CommandError(f"Unknown transition requested, available ones are: {fits}")
    chosen = fitting[0]
    client = node.create_client(ChangeState, f"{name}/change_state")
    response = await client.call(ChangeState.Request(transition=chosen), timeout_sec=timeout)
    if not response.success:
        raise CommandError("Transitioning failed")
    output.item("Transitioning successful", {"name": name, "transition": chosen.label})


def known(node: Node, node_name: str) -> str:
    """Return the full name of a managed node; the leading slash may be omitted.

    Raises:
        CommandError: there is no such node.
    """
    name = lookup.absolute(node_name)
    names = managed_nodes(node, hidden=True)
    if name not in names:
        raise CommandError(f"Node not found{lookup.close_to(name, names)}")
    return name


async def transitions(
    node: Node, name: str, *, every: bool = False, timeout: float = ANSWER_S
) -> list[TransitionDescription]:
    """Return the transitions of a managed node."""
    service = "get_transition_graph" if every else "get_available_transitions"
    request = GetAvailableTransitions.Request()
    response = await ask(node, name, service, GetAvailableTransitions, request, timeout)
    return list(response.available_transitions)


async def ask(
    node: Node,
    name: str,
    service: str,
    srv_type: ServiceClass[RequestT, ResponseT],
    request: RequestT,
    timeout: float,
) -> ResponseT:
    """Call a service that a managed node answers immediately."""
    client = node.create_client(srv_type, f"{name}/{service}")
    return await client.call(request, timeout_sec=timeout)
