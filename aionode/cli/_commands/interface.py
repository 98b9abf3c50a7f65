"""``aionode interface``: its commands, arguments and options."""

from __future__ import annotations

import functools
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from aionode.cli._commands.completion import complete_interfaces
from aionode.cli._support.options import interfaces_option, json_option
from aionode.cli._support.output import Output
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.interface import KINDS, list_interfaces, package, packages, proto, show
from aionode.errors import CommandError, InterfaceNotFoundError

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.node import Node

__all__ = ["interface"]

# Commands


@click.group()
def interface() -> None:
    """Show message, service and action types."""


def kind_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options for kinds of types; its function gets the chosen kinds."""

    @click.option("-m", "--only-msgs", is_flag=True, help="Messages only.")
    @click.option("-s", "--only-srvs", is_flag=True, help="Services only.")
    @click.option("-a", "--only-actions", is_flag=True, help="Actions only.")
    @json_option
    @interfaces_option
    @functools.wraps(command)
    def with_kinds(
        json: bool, only_msgs: bool, only_srvs: bool, only_actions: bool, **options: Any
    ) -> Any:
        chosen = {"msg": only_msgs, "srv": only_srvs, "action": only_actions}
        kinds = tuple(kind for kind, wanted in chosen.items() if wanted) or tuple(KINDS)
        return command(output=Output(json=json), kinds=kinds, **options)

    return with_kinds


@interface.command("list")
@kind_options
def list_command(output: Output, kinds: tuple[str, ...]) -> None:
    """List all types."""
    list_interfaces(output=output, kinds=kinds)


@interface.command("package")
@click.argument("package_name", shell_complete=complete_interfaces())
@kind_options
def package_command(output: Output, kinds: tuple[str, ...], package_name: str) -> None:
    """List the types of one package."""
    package(package_name.rstrip("/"), output=output, kinds=kinds)


@interface.command("packages")
@kind_options
def packages_command(output: Output, kinds: tuple[str, ...]) -> None:
    """List the packages."""
    packages(output=output, kinds=kinds)


def with_class(type_name: str, print_class: Callable[[Any, Output], None], json: bool) -> None:
    """Call `print_class` with the class of a type; the nodes are asked for one not known here."""
    from aionode.interfaces import get_interface

    try:
        cls = get_interface(type_name)
    except InterfaceNotFoundError:

        async def ask(node: Node, output: Output) -> None:
            print_class(await node.find_type(type_name), output)

        run_verb(ask, json=json)
    else:
        print_class(cls, Output(json=json))


@interface.command("show")
@click.argument("type_name", metavar="TYPE", shell_complete=complete_interfaces())
@click.option("--all-comments", is_flag=True, help="Print the comments of nested types as well.")
@click.option("--no-comments", is_flag=True, help="Print no comments.")
@json_option
@interfaces_option
def show_command(type_name: str, all_comments: bool, no_comments: bool, json: bool) -> None:
    """Print the definition of a type; if TYPE is -, its name is read from standard input."""
    if type_name == "-":
        if sys.stdin.isatty():
            raise click.UsageError(
                "- reads the name of a type from a pipe, but standard input is a terminal."
            )
        type_name = sys.stdin.readline().strip()
        if not type_name:
            raise CommandError("The passed value is empty: no type name came from the pipe")
    comments: Literal["none", "all", "outer"] = "all" if all_comments else "outer"
    comments = "none" if no_comments else comments
    with_class(type_name, lambda cls, output: show(cls, output=output, comments=comments), json)


@interface.command("proto")
@click.argument("type_name", metavar="TYPE", shell_complete=complete_interfaces())
@click.option("--no-quotes", is_flag=True, help="Print no quotes around the values.")
@json_option
@interfaces_option
def proto_command(type_name: str, no_quotes: bool, json: bool) -> None:
    """Print the default values of a type in YAML."""
    with_class(type_name, lambda cls, output: proto(cls, output=output, quotes=not no_quotes), json)


@interface.command("generate")
@click.argument("path", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option(
    "-o",
    "--out-dir",
    required=True,
    type=click.Path(file_okay=False, path_type=Path),
    help="Output folder; created if needed.",
)
@json_option
def generate_command(path: Path, out_dir: Path, json: bool) -> None:
    """Generate Python modules, with types and docstrings, from a folder of definitions."""
    from aionode.idl import generate

    output = Output(json=json)
    for file in generate(path, out_dir):
        output.item(str(file), {"file": str(file)})
