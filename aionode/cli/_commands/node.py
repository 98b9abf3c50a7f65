"""``aionode node``: its commands, arguments and options."""

from __future__ import annotations

import click

from aionode.cli._commands.completion import complete_names
from aionode.cli._support.options import json_option, ros2_options
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.node import info, list_nodes

__all__ = ["node"]


@click.group()
def node() -> None:
    """List and inspect nodes."""


@node.command("list")
@click.option("-a", "--all", "hidden", is_flag=True, help="List hidden nodes as well.")
@click.option("-c", "--count-nodes", "count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def list_command(json: bool, hidden: bool, count: bool) -> None:
    """List the nodes on the network."""
    run_verb(
        lambda node, output: list_nodes(node, hidden=hidden, count=count, output=output), json=json
    )


@node.command("info")
@click.argument("node_name", shell_complete=complete_names("node"))
@click.option("--include-hidden", "hidden", is_flag=True, help="Show hidden names as well.")
@json_option
@ros2_options
def info_command(node_name: str, json: bool, hidden: bool) -> None:
    """Print the topics, services and actions of a node."""
    run_verb(lambda node, output: info(node, node_name, hidden=hidden, output=output), json=json)
