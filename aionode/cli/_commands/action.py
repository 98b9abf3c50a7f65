"""``aionode action``: its commands, arguments and options."""

from __future__ import annotations

from typing import Any

import click

from aionode.cli._commands.completion import complete_interfaces, complete_names, complete_types_of
from aionode.cli._support.options import (
    interfaces_option,
    json_option,
    positive,
    ros2_options,
    stdin_text,
)
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.action import find, info, list_actions, send_goal, type_of_action

__all__ = ["action"]

# Commands


@click.group()
def action() -> None:
    """Send goals, and see who serves which action."""


action_argument = click.argument("action_name", shell_complete=complete_names("action"))

type_argument = click.argument("action_type", shell_complete=complete_interfaces("action"))


@action.command("list")
@click.option("-t", "--show-types", "types", is_flag=True, help="Print the types too.")
@click.option("-c", "--count-actions", "count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def list_command(json: bool, types: bool, count: bool) -> None:
    """List the actions that somebody serves or uses."""
    run_verb(
        lambda node, output: list_actions(node, types=types, count=count, output=output), json=json
    )


@action.command("info")
@action_argument
@click.option("-t", "--show-types", "types", is_flag=True, help="Print the types too.")
@click.option("-c", "--count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def info_command(json: bool, **options: Any) -> None:
    """Print the nodes that use and serve an action."""
    run_verb(lambda node, output: info(node, output=output, **options), json=json)


@action.command("type")
@action_argument
@json_option
@ros2_options
def type_command(action_name: str, json: bool) -> None:
    """Print the type of an action."""
    run_verb(lambda node, output: type_of_action(node, action_name, output=output), json=json)


@action.command("find")
@type_argument
@click.option("-c", "--count-actions", "count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def find_command(action_type: str, json: bool, count: bool) -> None:
    """List the actions of one type."""
    run_verb(lambda node, output: find(node, action_type, count=count, output=output), json=json)


@action.command("send_goal")
@action_argument
@click.argument("action_type", shell_complete=complete_types_of("action", "action"))
@click.argument("values", metavar="[GOAL]", required=False)
@click.option("--stdin", is_flag=True, help="Read the goal from standard input.")
@click.option("-f", "--feedback", is_flag=True, help="Print the feedback.")
@click.option("--timeout", metavar="N", type=positive, help="Wait for a server for N seconds.")
@json_option
@interfaces_option
@ros2_options
def send_goal_command(json: bool, values: str | None, stdin: bool, **options: Any) -> None:
    """Send a goal in YAML, such as '{order: 10}', and print how it ends.

    Ctrl-C cancels the goal. The exit status is 0 if it succeeded.
    """
    text = stdin_text(values, stdin)
    run_verb(lambda node, output: send_goal(node, values=text, output=output, **options), json=json)
