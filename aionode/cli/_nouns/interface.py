"""``aionode interface``: show message, service and action types."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from aionode.cli._support.command import VerbT, command
from aionode.cli._support.completion import complete_interfaces
from aionode.cli._support.options import interfaces_option, json_option
from aionode.cli._support.output import Output
from aionode.cli._support.session import run_verb
from aionode.errors import CommandError, InterfaceNotFoundError

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.node import Node

__all__ = ["interface_command", "list_interfaces", "package", "packages", "proto", "show"]

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}


@click.group("interface")
def interface_command() -> None:
    """Show message, service and action types."""


kind_options = (
    click.option("-m", "--only-msgs", "msg", is_flag=True, help="Messages only."),
    click.option("-s", "--only-srvs", "srv", is_flag=True, help="Services only."),
    click.option("-a", "--only-actions", "action", is_flag=True, help="Actions only."),
)


def prepare_kinds(options: dict[str, Any]) -> None:
    """Replace the options for kinds of types by ``kinds``, which defaults to all of them."""
    chosen = {kind: options.pop(kind) for kind in KINDS}
    options["kinds"] = tuple(kind for kind in KINDS if chosen[kind]) or tuple(KINDS)


def listing(name: str, *parameters: Callable[[Any], Any]) -> Callable[[VerbT], VerbT]:
    """Return the decorator for a verb that prints names of the kinds chosen by its options."""
    return command(
        interface_command,
        name,
        *parameters,
        *kind_options,
        node=False,
        interfaces=True,
        prepare=prepare_kinds,
    )


# Names


@listing("list")
def list_interfaces(*, output: Output, kinds: tuple[str, ...] = tuple(KINDS)) -> None:
    """List all types."""
    from aionode.interfaces import interface_names

    names = interface_names()
    for kind in kinds:
        output.text(f"{KINDS[kind]}:")
        for name in of_kinds(names, (kind,)):
            output.item(f"    {name}", {"name": name, "kind": kind})


@listing("package", click.argument("package_name", shell_complete=complete_interfaces()))
def package(package_name: str, *, output: Output, kinds: tuple[str, ...] = tuple(KINDS)) -> None:
    """List the types of one package.

    Raises:
        CommandError: there is no such package.
    """
    from aionode.interfaces import interface_names

    name = package_name.rstrip("/")  # shell completion adds a slash
    names = interface_names(name)
    if not names:
        from aionode.cli._support.lookup import unknown

        raise unknown("Unknown package", name, all_packages(), "interface packages")
    for type_name in of_kinds(names, kinds):
        output.item(type_name, {"name": type_name, "kind": type_name.split("/")[1]})


@listing("packages")
def packages(*, output: Output, kinds: tuple[str, ...] = tuple(KINDS)) -> None:
    """List the packages."""
    from aionode.interfaces import interface_names

    for name in all_packages():
        if of_kinds(interface_names(name), kinds):
            output.item(name, {"name": name})


def all_packages() -> list[str]:
    """Return the names of all packages."""
    from aionode.interfaces import known_packages

    return sorted(known_packages())


def of_kinds(names: tuple[str, ...], kinds: tuple[str, ...]) -> list[str]:
    """Filter the names of types by kind."""
    return [name for name in names if name.split("/")[1] in kinds]


# Definitions


def with_class(type_name: str, print_class: Callable[[Any, Output], None], json: bool) -> None:
    """Call `print_class` with the class of a type, asking the nodes if it is not known here."""
    from aionode.interfaces import get_interface

    try:
        cls = get_interface(type_name)
    except InterfaceNotFoundError:

        async def ask(node: Node, output: Output) -> None:
            print_class(await node.find_type(type_name), output)

        run_verb(ask, json=json)
    else:
        print_class(cls, Output(json=json))


def show(
    cls: Any,
    *,
    output: Output,
    comments: Literal["none", "outer", "all"] = "outer",
) -> None:
    """Print the definition of a type, with the definitions of nested types indented.

    Args:
        cls: The class of the type.
        output: Where to print.
        comments: Which comments to print: none, those of the type itself, or those of nested types
            as well. They come from the sourced ROS 2, or else from aionode.
    """
    from aionode.idl import definition_text

    if output.json:
        output.item("", {"name": cls.__ros_type__, "definition": definition_text(cls)})
    else:
        output.raw(definition_text(cls, nested=True, comments=comments))


@interface_command.command("show")
@click.argument("type_name", metavar="TYPE", shell_complete=complete_interfaces())
@click.option("--all-comments", is_flag=True, help="Print the comments of nested types as well.")
@click.option("--no-comments", is_flag=True, help="Print no comments.")
@json_option
@interfaces_option
def show_command(type_name: str, all_comments: bool, no_comments: bool, json: bool) -> None:
    """Print the definition of a type; if TYPE is -, read its name from standard input."""
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


def proto(cls: Any, *, output: Output, quotes: bool = True) -> None:
    """Print the default values of a type in YAML, as a template for ``pub`` and ``call``."""
    from aionode.message import ActionType, ServiceType, to_builtins, to_yaml

    part = cls.Goal if issubclass(cls, ActionType) else cls
    part = cls.Request if issubclass(cls, ServiceType) else part
    text = to_yaml(part())
    output.item(f'"{text}"' if quotes else text, to_builtins(part()))


@interface_command.command("proto")
@click.argument("type_name", metavar="TYPE", shell_complete=complete_interfaces())
@click.option("--no-quotes", is_flag=True, help="Print no quotes around the values.")
@json_option
@interfaces_option
def proto_command(type_name: str, no_quotes: bool, json: bool) -> None:
    """Print the default values of a type in YAML."""
    with_class(type_name, lambda cls, output: proto(cls, output=output, quotes=not no_quotes), json)


@command(
    interface_command,
    "generate",
    click.argument("path", type=click.Path(exists=True, file_okay=False, path_type=Path)),
    click.option(
        "-o",
        "--out-dir",
        required=True,
        type=click.Path(file_okay=False, path_type=Path),
        help="Output folder; created if needed.",
    ),
    node=False,
)
def generate(path: Path, out_dir: Path, *, output: Output) -> None:
    """Generate Python modules, with types and docstrings, from a folder of definitions."""
    from aionode.idl import generate as generate_modules

    for file in generate_modules(path, out_dir):
        output.item(str(file), {"file": str(file)})
