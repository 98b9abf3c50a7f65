"""Completion: the script of a shell, and the names that it completes."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from aionode.errors import AionodeError

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = ["complete_interfaces", "complete_names", "completion"]

Completer = Callable[[click.Context, click.Parameter, str], list[str]]

QUIET_S = 0.3
"""How long nothing has to come before what is known is offered: somebody waits at a prompt."""

SETUP = """\
# Put the following into {file}:
#   {line}
"""
SHELLS = {
    "bash": ("~/.bashrc", 'eval "$(aionode completion bash)"'),
    "zsh": ("~/.zshrc", 'eval "$(aionode completion zsh)"'),
    "fish": ("~/.config/fish/completions/aionode.fish", "aionode completion fish | source"),
}


@click.command()
@click.argument("shell", type=click.Choice(list(SHELLS)))
def completion(shell: str) -> None:
    """Print what makes SHELL complete commands, options, types and names on the network."""
    from click.shell_completion import get_completion_class

    from aionode.cli.command import root

    made = get_completion_class(shell)
    assert made is not None  # noqa: S101  # click knows all of SHELLS
    file, line = SHELLS[shell]
    click.echo(SETUP.format(file=file, line=line), nl=False)
    click.echo(made(root, {}, "aionode", "_AIONODE_COMPLETE").source())


def complete_names(what: str) -> Completer:
    """Return what completes names on the network: ``node``, ``topic``, ``service``, ``action``."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        try:
            names = asyncio.run(names_now(what))
        except (AionodeError, ExceptionGroup):
            return []  # there is no place for an error in the middle of a command line
        return [name for name in names if name.startswith(incomplete)]

    return complete


async def names_now(what: str) -> list[str]:
    """Return the names of this moment."""
    from aionode.cli.session import make_node

    async with make_node() as node:
        for transport in node.context.transports:
            await transport.all_known(QUIET_S)
        return names_of(node, what)


def names_of(node: Node, what: str) -> list[str]:
    """Return the names of one kind that are not hidden."""
    from aionode.cli import lookup
    from aionode.graph import EndpointKind

    if what == "node":
        return [info.fully_qualified_name for info in lookup.node_infos(node)]
    if what == "service":
        return list(lookup.names_and_types(node, EndpointKind.SERVER))
    if what == "action":
        return [name for name, _ in node.get_action_names_and_types()]
    return list(lookup.names_and_types(node, *lookup.TOPIC_KINDS))


def complete_interfaces(kind: str = "") -> Completer:
    """Return what completes type names; `kind` is ``msg``, ``srv``, ``action`` or any."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        from aionode.interfaces import interface_names, shipped_packages

        package, slash, _ = incomplete.partition("/")
        if not slash:
            return [f"{name}/" for name in sorted(shipped_packages()) if name.startswith(package)]
        found: Any = interface_names(package)
        return [name for name in found if name.startswith(incomplete) and f"/{kind}" in name]

    return complete
