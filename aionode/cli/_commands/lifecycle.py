"""``aionode lifecycle``: its commands, arguments and options."""

from __future__ import annotations

from typing import Any

import click

from aionode.cli._commands.completion import complete_names, complete_transitions
from aionode.cli._support.options import json_option, ros2_options
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.lifecycle import (
    get_state,
    list_nodes,
    list_transitions,
    set_state,
)

__all__ = ["lifecycle"]

# Commands


@click.group()
def lifecycle() -> None:
    """Show and change the states of managed nodes."""


node_argument = click.argument("node_name", shell_complete=complete_names("node"))


@lifecycle.command("nodes")
@click.option("-a", "--all", "hidden", is_flag=True, help="List hidden nodes as well.")
@click.option("-c", "--count-nodes", "count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def nodes_command(json: bool, **options: Any) -> None:
    """List the managed nodes."""
    run_verb(lambda node, output: list_nodes(node, output=output, **options), json=json)


@lifecycle.command("get")
@click.argument("node_name", required=False, shell_complete=complete_names("node"))
@click.option("--include-hidden-nodes", "hidden", is_flag=True, help="Show hidden nodes as well.")
@json_option
@ros2_options
def get_command(json: bool, node_name: str | None, hidden: bool) -> None:
    """Print the state of one managed node, or of all."""
    run_verb(
        lambda node, output: get_state(node, node_name, output=output, hidden=hidden), json=json
    )


@lifecycle.command("list")
@node_argument
@click.option(
    "-a", "--all", "every", is_flag=True, help="List all transitions, not only the available ones."
)
@json_option
@ros2_options
def list_command(json: bool, node_name: str, every: bool) -> None:
    """List the transitions that are available to a managed node now."""
    run_verb(
        lambda node, output: list_transitions(node, node_name, output=output, every=every),
        json=json,
    )


@lifecycle.command("set")
@node_argument
@click.argument("transition", shell_complete=complete_transitions)
@json_option
@ros2_options
def set_command(json: bool, node_name: str, transition: str) -> None:
    """Trigger a transition of a managed node, by its label or id."""
    run_verb(lambda node, output: set_state(node, node_name, transition, output=output), json=json)
