"""``aionode param``: read and set the parameters of nodes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._commands.completion import complete_names, complete_parameters
from aionode.cli._support.options import json_option, ros2_options, timeout_option
from aionode.cli._support.session import run_verb
from aionode.cli._verbs import param as param_verbs

if TYPE_CHECKING:
    from collections.abc import Awaitable

__all__ = ["param"]


@click.group()
def param() -> None:
    """Read and set the parameters of nodes."""


def node_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that all verbs of ``param`` have."""
    hidden = click.option(
        "--include-hidden-nodes", "hidden", is_flag=True, help="Consider hidden nodes as well."
    )
    return hidden(timeout_option(json_option(ros2_options(command))))


def run(verb: Callable[..., Awaitable[int | None]], json: bool, **options: Any) -> None:
    """Run a verb with a node."""
    run_verb(lambda node, output: verb(node, output=output, **options), json=json)


node_argument = click.argument("node_name", shell_complete=complete_names("node"))
name_argument = click.argument("parameter_name", shell_complete=complete_parameters)


@param.command("list")
@click.argument("node_name", required=False, shell_complete=complete_names("node"))
@click.option("--filter", "pattern", metavar="REGEX", help="Only names that match.")
@click.option(
    "--param-prefixes",
    "prefixes",
    metavar="PREFIX",
    multiple=True,
    help="Only names with this prefix.",
)
@click.option("--param-type", "types", is_flag=True, help="Print the types too.")
@node_options
def list_command(json: bool, **options: Any) -> None:
    """List the parameters of one node, or of all."""
    run(param_verbs.list_parameters, json, **options)


@param.command("get")
@node_argument
@name_argument
@click.option("--hide-type", is_flag=True, help="Print the value only.")
@node_options
def get_command(json: bool, **options: Any) -> None:
    """Print the value of a parameter."""
    run(param_verbs.get, json, **options)


@param.command("set", context_settings={"ignore_unknown_options": True})
@node_argument
@name_argument
@click.argument("value")
@node_options
def set_command(json: bool, **options: Any) -> None:
    """Set a parameter to a value in YAML."""
    run(param_verbs.set_parameter, json, **options)


@param.command("delete")
@node_argument
@name_argument
@node_options
def delete_command(json: bool, **options: Any) -> None:
    """Undeclare a parameter."""
    run(param_verbs.delete, json, **options)


@param.command("describe")
@node_argument
@click.argument("parameter_names", nargs=-1, required=True, shell_complete=complete_parameters)
@node_options
def describe_command(json: bool, **options: Any) -> None:
    """Print the type, description and constraints of parameters."""
    run(param_verbs.describe, json, **options)


@param.command("dump")
@node_argument
@node_options
def dump_command(json: bool, **options: Any) -> None:
    """Print all parameters of a node as a parameter file."""
    run(param_verbs.dump, json, **options)


@param.command("load")
@node_argument
@click.argument("parameter_file", type=click.Path(path_type=Path))
@click.option(
    "--no-use-wildcard", is_flag=True, help="Ignore the file's values for wildcard nodes."
)
@node_options
def load_command(json: bool, no_use_wildcard: bool, **options: Any) -> None:
    """Set the parameters of a node from a file."""
    run(param_verbs.load, json, wildcards=not no_use_wildcard, **options)
