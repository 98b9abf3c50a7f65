"""Shell completion with names and types from the network."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from aionode.cli._support.lookup import absolute, node_infos
from aionode.errors import AionodeError

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = [
    "TYPES",
    "beginning",
    "class_named",
    "complete_interfaces",
    "complete_names",
    "complete_of_node",
    "name_argument",
    "type_argument",
    "types_now",
    "values_parameters",
]

TYPES: Final = {
    "topic": ("message", "msg"),
    "service": ("service", "srv"),
    "action": ("action", "action"),
}
"""The word for the types of each noun, and the part of type names that identifies them."""

AnswerT = TypeVar("AnswerT")

CommandT = TypeVar("CommandT", bound=Callable[..., Any])

Completer = Callable[[click.Context, click.Parameter, str], list[str]]

QUIET_S = 0.3
"""How long discovery must be quiet before names are offered, in seconds: a person is waiting."""

ANSWER_S = 1.0
"""Timeout for the answer of a node, such as its parameters, in seconds; normally milliseconds."""


def complete_names(what: str) -> Completer:
    """Return the completer for names of a ``node``, ``topic``, ``service`` or ``action``."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        async def names(node: Node) -> list[str]:
            return names_of(node, what)

        return beginning(incomplete, ask_now(names, []))

    return complete


def name_argument(what: str, *, required: bool = True) -> Callable[[CommandT], CommandT]:
    """Return the argument for the name of a ``node``, ``topic``, ``service`` or ``action``."""
    return click.argument(f"{what}_name", required=required, shell_complete=complete_names(what))


def type_argument(what: str, *, required: bool = True) -> Callable[[CommandT], CommandT]:
    """Return the argument for the type after the name of a ``topic``, ``service`` or ``action``."""
    name = f"{TYPES[what][0]}_type"
    return click.argument(name, required=required, shell_complete=complete_types_of(what))


def values_parameters(
    what: str, word: str = "values"
) -> tuple[Callable[[CommandT], CommandT], ...]:
    """Return the parameters for a name, its type and values for it in YAML, e.g. of a ``topic``.

    They also suit ``service`` and ``action``. `read_values` reads the values.
    """
    completer = complete_values(TYPES[what][0])
    return (
        name_argument(what),
        type_argument(what),
        click.argument(
            "values", metavar=f"[{word.upper()}]", required=False, shell_complete=completer
        ),
        click.option("--stdin", is_flag=True, help=f"Read the {word} from standard input."),
    )


def complete_types_of(what: str) -> Completer:
    """Return the completer for the type after the name of a ``topic``, ``service`` or ``action``.

    It offers the types that the name has on the network; if none of them matches, all types that
    such a name can have.
    """
    any_type = complete_interfaces(TYPES[what][1])

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        name = ctx.params.get(f"{what}_name")
        known = types_now(what, name) if name else []
        return beginning(incomplete, known) or any_type(ctx, param, incomplete)

    return complete


def types_now(what: str, name: str) -> list[str]:
    """Return the types that a name has on the network."""

    async def types(node: Node) -> list[str]:
        return types_of(node, what, name)

    return ask_now(types, [])


def complete_of_node(question: Callable[[Node, str], Awaitable[Iterable[str]]]) -> Completer:
    """Return the completer for names obtained from the node earlier on the command line.

    Args:
        question: Called with the command's node and the full name of that node.
    """

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        node_name = ctx.params.get("node_name")
        if not node_name:
            return []

        async def names(node: Node) -> list[str]:
            async with asyncio.timeout(ANSWER_S):
                return list(await question(node, absolute(node_name)))

        return beginning(incomplete, ask_now(names, []))

    return complete


def complete_values(kind: str) -> Completer:
    """Return the completer for YAML values of the type before them, with their defaults.

    Args:
        kind: ``message``, ``service`` or ``action``.
    """

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        cls = class_named(ctx.params.get(f"{kind}_type"))
        if cls is None or incomplete:
            return []  # do not replace what has been edited
        part = {"message": "", "service": "Request", "action": "Goal"}[kind]
        msg_type = getattr(cls, part, None) if part else cls
        return [] if msg_type is None else [prototype(msg_type)]

    return complete


def prototype(cls: Any) -> str:
    """Return the defaults of a message as YAML on one line, without single quotes."""
    from aionode.message import to_yaml

    return to_yaml(cls(), flow_style=True).strip().replace("''", '""')


def class_named(type_name: str | None) -> Any:
    """Return the class of a type, asking nodes if necessary; None if there is none."""
    from aionode.errors import InterfaceNotFoundError
    from aionode.interfaces import get_interface

    if not type_name:
        return None
    try:
        return get_interface(type_name)
    except InterfaceNotFoundError:
        return ask_now(lambda node: node.find_type(type_name), None)


def beginning(incomplete: str, names: list[str]) -> list[str]:
    """Return the names that start with `incomplete`."""
    return [name for name in names if name.startswith(incomplete)]


def ask_now(question: Callable[[Node], Awaitable[AnswerT]], nothing: AnswerT) -> AnswerT:
    """Ask the network a question; return `nothing` after an error.

    An error cannot be shown in the middle of a command line.
    """

    async def ask() -> AnswerT:
        from aionode.cli._support.session import make_node

        async with make_node() as node:
            for transport in node.context.transports:
                await transport.all_known(QUIET_S)
            return await question(node)

    try:
        return asyncio.run(ask())
    except (AionodeError, ExceptionGroup, TimeoutError):
        return nothing


def names_of(node: Node, what: str) -> list[str]:
    """Return the names of one kind that are not hidden."""
    from aionode.cli._support.nouns import NOUNS

    if what == "node":
        return [info.fully_qualified_name for info in node_infos(node)]
    return list(NOUNS[what].types_by_name(node))


def types_of(node: Node, what: str, name: str) -> list[str]:
    """Return the types of a name on the network."""
    from aionode.cli._support.nouns import NOUNS

    known = NOUNS[what].types_by_name(node, hidden=True)
    return known.get(absolute(name), [])


def complete_interfaces(kind: str = "") -> Completer:
    """Return the completer for type names of a `kind`: ``msg``, ``srv``, ``action``, "" for all."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        from aionode.interfaces import interface_names, known_packages

        package, slash, _ = incomplete.partition("/")
        if not slash:
            return [f"{name}/" for name in sorted(known_packages()) if name.startswith(package)]
        types: Any = interface_names(package)
        return [name for name in types if name.startswith(incomplete) and f"/{kind}" in name]

    return complete
