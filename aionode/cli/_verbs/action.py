"""The verbs of ``aionode action``."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from aionode._node.graph import actions_among
from aionode.cli._support import lookup
from aionode.cli._support.yaml_messages import message_from_yaml
from aionode.errors import CommandError, GoalRejectedError
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.message import to_builtins, to_yaml

if TYPE_CHECKING:
    from aionode.action import ActionClient, ActionResult, ClientGoalHandle
    from aionode.cli._support.output import Output
    from aionode.node import Node

__all__ = ["find", "info", "list_actions", "send_goal", "type_of_action"]

CANCEL_S = 2.0
"""How long the server may take to answer when the goal is to be cancelled."""

USERS = {"clients": EndpointKind.SUBSCRIPTION, "servers": EndpointKind.PUBLISHER}

# Verbs


def actions_of(node: Node) -> dict[str, list[str]]:
    """Return every action that somebody serves or uses, with its types."""
    topics = lookup.names_and_types(node, *TOPIC_KINDS, hidden=True)
    return dict(actions_among(list(topics.items())))


def found_types(node: Node, action_name: str) -> tuple[str, list[str]]:
    """Return full name and types of an action.

    Raises:
        CommandError: nobody serves or uses it.
    """
    name = node.resolve_topic_name(action_name)
    known = actions_of(node)
    if name not in known:
        raise lookup.unknown("Unknown action", action_name, known, "action list")
    return name, known[name]


async def list_actions(
    node: Node, *, output: Output, types: bool = False, count: bool = False
) -> None:
    """Print every action that somebody serves or uses."""
    known = actions_of(node)
    if count:
        output.item(str(len(known)), {"actions": len(known)})
        return
    for name, of in known.items():
        output.item(f"{name} [{', '.join(of)}]" if types else name, {"name": name, "types": of})


async def info(
    node: Node, action_name: str, *, output: Output, types: bool = False, count: bool = False
) -> None:
    """Print the nodes that use and serve an action."""
    name, of = found_types(node, action_name)
    users = {word: nodes_with(node, name, kind) for word, kind in USERS.items()}
    if output.json:
        output.item("", {"name": name, "types": of, **users})
        return
    output.text(f"Action: {name}")
    for word, nodes in users.items():
        output.text(f"Action {word}: {len(nodes)}")
        for each in () if count else nodes:
            shown = f" [{', '.join(each['types'])}]" if types else ""
            output.text(f"    {each['node']}{shown}")


def nodes_with(node: Node, name: str, kind: EndpointKind) -> list[dict[str, Any]]:
    """Return the nodes that have one end of an action."""
    found = lookup.endpoints(node, kind, name=f"{name}/_action/feedback")
    return [
        {
            "node": endpoint.node.fully_qualified_name,
            "types": [endpoint.type_name.removesuffix("_FeedbackMessage")],
        }
        for endpoint in found
    ]


async def type_of_action(node: Node, action_name: str, *, output: Output) -> None:
    """Print the type of an action."""
    name, types = found_types(node, action_name)
    for one in types:
        output.item(one, {"name": name, "type": one})


async def find(node: Node, action_type: str, *, output: Output, count: bool = False) -> None:
    """Print the actions of one type."""
    known = actions_of(node)
    names = [name for name, types in known.items() if action_type in types]
    if count:
        output.item(str(len(names)), {"actions": len(names)})
        return
    for name in names:
        output.item(name, {"name": name, "types": known[name]})


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
    """Send a goal in YAML, and print how it ends; return 0 if it succeeded, else 1.

    Without a server it waits for one, for `timeout` seconds at most. When cancelled, it cancels the
    goal first.

    Raises:
        CommandError: the action has another type, the goal does not fit, or no server came.
        GoalLostError: the server went away.
    """
    from aionode.action import ActionClient

    name = node.resolve_topic_name(action_name)
    action_class = class_of(node, name, action_type)
    goal = message_from_yaml(action_class.Goal, values)
    client: ActionClient[Any, Any, Any] = ActionClient(node, action_class, name)
    await wait_for_server(node, client, output, timeout)
    output.text(f"Sending goal:\n     {to_yaml(goal)}")
    try:
        handle = await client.send_goal(goal)
    except GoalRejectedError:
        output.item("Goal was rejected.", {"status": "REJECTED"})
        return 1
    output.text(f"Goal accepted with ID: {handle.text}\n")
    try:
        # Shielded, as cancelling the wait would cancel the goal before anything is said of it.
        outcome = await asyncio.shield(watch(handle, output, feedback=feedback))
    except asyncio.CancelledError:
        if not handle.done:
            await cancel(handle, output)
        raise
    return print_outcome(handle, outcome, output)


def class_of(node: Node, name: str, action_type: str) -> Any:
    """Return the class of an action of the type that the user says.

    Raises:
        CommandError: there is no such type, or the action has another one.
    """
    found = lookup.interface_class("action", action_type)
    types = actions_of(node).get(name, [])
    if types and action_type not in types and found.__ros_type__ not in types:
        raise CommandError(
            f"The passed action type is invalid: '{name}' has type {', '.join(types)}, "
            f"not {action_type}"
        )
    return found


async def wait_for_server(
    node: Node, client: ActionClient[Any, Any, Any], output: Output, timeout_s: float | None
) -> None:
    """Wait until somebody serves the action, and say what might be meant instead.

    Raises:
        CommandError: nobody did in `timeout_s`.
    """
    name = client.action_name
    output.progress("Waiting for an action server to become available...")
    if client.server_is_ready():
        return
    if hint := lookup.close_to(name, actions_of(node)):
        output.warn(f"Nobody serves '{name}'{hint}")
    with output.waiting(f"waiting for somebody to serve {name}"):
        ready = await client.wait_for_server(timeout_s)
    if not ready:
        raise CommandError(
            f"Nobody served '{name}' in {timeout_s:g} s. `aionode action list` shows the actions "
            "there are"
        )


async def watch(
    handle: ClientGoalHandle[Any, Any], output: Output, *, feedback: bool
) -> ActionResult[Any]:
    """Print the feedback of a goal if asked to, and return how it ends."""
    if feedback:
        async for part in handle:
            output.item(
                f"Feedback:\n    {to_yaml(part)}",
                {"goal_id": handle.text, "feedback": to_builtins(part)},
            )
    return await handle.result()


def print_outcome(
    handle: ClientGoalHandle[Any, Any], outcome: ActionResult[Any], output: Output
) -> int:
    """Print how a goal ended, and return the exit status."""
    status = outcome.status.name
    output.item(
        f"Result:\n    {to_yaml(outcome.result)}\nGoal finished with status: {status}",
        {"goal_id": handle.text, "status": status, "result": to_builtins(outcome.result)},
    )
    if outcome.error_text:
        output.warn(outcome.error_text)
    return 0 if status == "SUCCEEDED" else 1


async def cancel(handle: ClientGoalHandle[Any, Any], output: Output) -> None:
    """Cancel a goal, and say so."""
    output.progress("Canceling goal...")
    try:
        async with asyncio.timeout(CANCEL_S):
            response = await handle.cancel()
    except TimeoutError:
        output.warn(f"The server did not answer in {CANCEL_S:g} s: the goal may go on")
        return
    if response.return_code == 0:
        output.progress("Goal canceled.")
    else:
        output.warn("The server refused to cancel the goal: it goes on")
