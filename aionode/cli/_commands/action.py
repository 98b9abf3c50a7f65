"""``aionode action``: its commands, arguments and options."""

from __future__ import annotations

from typing import Any

import click

from aionode.cli._commands.completion import complete_names, complete_types_of, complete_values
from aionode.cli._commands.typed_names import add_type_and_find
from aionode.cli._support.nouns import ACTION
from aionode.cli._support.options import (
    interfaces_option,
    json_option,
    positive,
    ros2_options,
    stdin_text,
)
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.action import STOP_S, info, send_goal

__all__ = ["action"]


@click.group()
def action() -> None:
    """Send goals; list and inspect actions."""


action_argument = click.argument("action_name", shell_complete=complete_names("action"))


@action.command("list")
@click.option("-t", "--show-types", "types", is_flag=True, help="Print the types too.")
@click.option("-c", "--count-actions", "count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def list_command(json: bool, types: bool, count: bool) -> None:
    """List the actions that have a server or a client."""
    run_verb(
        lambda node, output: ACTION.list_names(node, types=types, count=count, output=output),
        json=json,
    )


@action.command("info")
@action_argument
@click.option("-t", "--show-types", "types", is_flag=True, help="Print the types too.")
@click.option("-c", "--count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def info_command(json: bool, **options: Any) -> None:
    """Print the clients and servers of an action."""
    run_verb(lambda node, output: info(node, output=output, **options), json=json)


add_type_and_find(action, ACTION, "action")


@action.command("send_goal")
@action_argument
@click.argument("action_type", shell_complete=complete_types_of("action", "action"))
@click.argument(
    "values", metavar="[GOAL]", required=False, shell_complete=complete_values("action")
)
@click.option("--stdin", is_flag=True, help="Read the goal from standard input.")
@click.option("-f", "--feedback", is_flag=True, help="Print the feedback.")
@click.option("--timeout", metavar="N", type=positive, help="Wait at most N seconds for a server.")
@json_option
@interfaces_option
@ros2_options
def send_goal_command(json: bool, values: str | None, stdin: bool, **options: Any) -> None:
    """Send a goal in YAML, such as '{order: 10}', and print its result.

    Ctrl-C cancels the goal and prints its result. The exit status is 0 if the goal succeeded, or
    was canceled so.
    """
    text = stdin_text(values, stdin)
    run_verb(
        lambda node, output: send_goal(node, values=text, output=output, **options),
        json=json,
        stop_s=STOP_S,
    )
