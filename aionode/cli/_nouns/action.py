"""``aionode action``: send goals; list and inspect actions."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._support import lookup
from aionode.cli._support.command import add_type_and_find, command
from aionode.cli._support.completion import name_argument, values_parameters
from aionode.cli._support.nouns import ACTION, with_types
from aionode.cli._support.options import count_option, positive, read_values, types_option
from aionode.cli._support.yaml_messages import message_from_yaml
from aionode.errors import CommandError, EntityDestroyedError, GoalRejectedError, escaped
from aionode.graph import EndpointKind
from aionode.message import to_builtins, to_yaml

if TYPE_CHECKING:
    from aionode.action import ActionClient, ActionResult, ClientGoalHandle
    from aionode.cli._support.output import Output
    from aionode.graph import NodeInfo
    from aionode.node import Node

__all__ = ["action_command", "info", "send_goal"]

CANCEL_S = 2.0
"""Timeout for the server's answer to a cancel request, in seconds."""

ENDED_S = 10.0
"""Timeout for the end of a goal that the server has agreed to cancel, in seconds."""

STOP_S = CANCEL_S + ENDED_S + 1.5
"""Timeout for the command to exit after Ctrl-C, in seconds; a second Ctrl-C exits at once."""

USERS = {"clients": EndpointKind.SUBSCRIPTION, "servers": EndpointKind.PUBLISHER}


@click.group("action")
def action_command() -> None:
    """Send goals; list and inspect actions."""


command(
    action_command,
    "list",
    types_option,
    count_option("actions"),
    help="List the actions that have a server or a client.",
)(ACTION.list_names)
add_type_and_find(action_command, ACTION)


@command(
    action_command,
    "info",
    name_argument("action"),
    types_option,
    click.option("-c", "--count", is_flag=True, help="Print only the count."),
)
async def info(
    node: Node, action_name: str, *, output: Output, types: bool = False, count: bool = False
) -> None:
    """Print the clients and servers of an action.

    Raises:
        CommandError: the action does not exist.
    """
    name, of = ACTION.name_and_types(node, action_name)
    users = {word: nodes_with(node, name, kind) for word, kind in USERS.items()}
    if output.json:
        output.item("", {"name": name, "types": of, **users})
        return
    output.text(f"Action: {name}")
    for word, nodes in users.items():
        output.text(f"Action {word}: {len(nodes)}")
        for user in () if count else nodes:
            name = user["node"]
            output.text(f"    {with_types(name, user['types']) if types else name}")


def nodes_with(node: Node, name: str, kind: EndpointKind) -> list[dict[str, Any]]:
    """Return the nodes with one side of an action: servers publish feedback, clients subscribe.

    A node with several clients is listed once, as in ros2.
    """
    types: dict[NodeInfo, set[str]] = {}
    for endpoint in lookup.endpoints(node, kind, name=f"{name}/_action/feedback"):
        of = endpoint.type_name.removesuffix("_FeedbackMessage")
        types.setdefault(endpoint.node, set()).add(of)
    return [
        {"node": info.fully_qualified_name, "types": sorted(of)}
        for info, of in sorted(types.items(), key=lambda item: item[0].fully_qualified_name)
    ]


@command(
    action_command,
    "send_goal",
    *values_parameters("action", "goal"),
    click.option("-f", "--feedback", is_flag=True, help="Print the feedback."),
    click.option(
        "--timeout", metavar="N", type=positive, help="Wait at most N seconds for a server."
    ),
    interfaces=True,
    prepare=read_values,
    stop_s=STOP_S,
)
async def send_goal(
    node: Node,
    action_name: str,
    action_type: str,
    *,
    output: Output,
    values: str = "{}",
    feedback: bool = False,
    timeout: float | None = None,
) -> int:
    """Send a goal in YAML, such as '{order: 10}', and print its result.

    Ctrl-C cancels the goal and prints its result. The exit status is 0 if the goal succeeded, or if
    Ctrl-C canceled it.

    Returns:
        The exit status: 0 if the goal succeeded, or if the command was interrupted and the server
        agreed to cancel the goal, as in ros2; otherwise 1.

    Raises:
        CommandError: the action has another type, the goal is invalid, no server appeared, or the
            server refused to cancel the goal.
        GoalLostError: the server went away.
    """
    from aionode.action import ActionClient

    name = ACTION.resolve(node, action_name)
    used = ACTION.types_by_name(node).get(name, [])
    users = lookup.action_endpoints(node, name) if action_type in used else []
    action_class = await lookup.class_of(node, "action", action_type, name, users, used)
    goal = message_from_yaml(action_class.Goal, values)
    client: ActionClient[Any, Any, Any] = ActionClient(node, action_class, name)
    output.progress("Waiting for an action server to become available...")
    if not client.server_is_ready():
        await ACTION.wait_for_server(node, name, client.wait_for_server, output, timeout)
    output.text(f"Sending goal:\n     {to_yaml(goal)}")
    try:
        handle = await client.send_goal(goal)
    except GoalRejectedError as error:
        why = f": {escaped(error.reason, one_line=True)}" if error.reason else "."
        output.item(f"Goal was rejected{why}", {"status": "REJECTED", "reason": error.reason})
        return 1
    output.text(f"Goal accepted with ID: {handle.text}\n")
    try:
        # Shielded: cancelling `watch` directly would cancel the goal before that is reported.
        outcome = await asyncio.shield(watch(handle, output, feedback=feedback))
    except asyncio.CancelledError:
        if handle.done or not await cancel(handle, output):
            raise
        await print_end(handle, output)
        return 0
    return print_outcome(handle, outcome, output)


async def print_end(handle: ClientGoalHandle[Any, Any], output: Output) -> None:
    """Wait for a goal that is being canceled to end, and print its outcome."""
    try:
        async with asyncio.timeout(ENDED_S):
            print_outcome(handle, await handle.result(), output)
    except TimeoutError:
        output.warn(f"The goal has not ended within {ENDED_S:g} s: it is still being canceled")


async def watch(
    handle: ClientGoalHandle[Any, Any], output: Output, *, feedback: bool
) -> ActionResult[Any]:
    """Wait for the outcome of a goal, printing its feedback if requested."""
    try:
        if feedback:
            async for part in handle:
                output.item(
                    f"Feedback:\n    {to_yaml(part)}",
                    {"goal_id": handle.text, "feedback": to_builtins(part)},
                )
        return await handle.result()
    except EntityDestroyedError:  # the node ends after Ctrl-C, and nothing awaits this any more
        raise asyncio.CancelledError from None


def print_outcome(
    handle: ClientGoalHandle[Any, Any], outcome: ActionResult[Any], output: Output
) -> int:
    """Print the outcome of a goal, and return the exit status."""
    status = outcome.status.name
    output.item(
        f"Result:\n    {to_yaml(outcome.result)}\nGoal finished with status: {status}",
        {"goal_id": handle.text, "status": status, "result": to_builtins(outcome.result)},
    )
    if outcome.error_text:
        output.warn(outcome.error_text)
    return 0 if status == "SUCCEEDED" else 1


async def cancel(handle: ClientGoalHandle[Any, Any], output: Output) -> bool:
    """Cancel a goal; return whether the server answered that it will end.

    Raises:
        CommandError: the server refused.
    """
    output.progress("Canceling goal...")
    try:
        async with asyncio.timeout(CANCEL_S):
            response = await handle.cancel()
    except TimeoutError:
        output.warn(
            f"The server did not answer within {CANCEL_S:g} s: the goal may still be running"
        )
        return False
    if response.return_code == response.ERROR_GOAL_TERMINATED:
        return True  # it has ended in the meantime
    # An rclpy server that refuses also answers with code 0, and an empty list.
    if len(response.goals_canceling) == 0:
        raise CommandError("Failed to cancel goal: the server refused, and it is still running")
    output.progress("Goal canceled.")
    return True
