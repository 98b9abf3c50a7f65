"""``aionode why``: what led to the latest message of a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
import msgspec

from aionode.cli._support.completion import complete_names
from aionode.cli._support.options import json_option, positive, ros2_options
from aionode.cli._support.session import run_verb
from aionode.errors import CommandError
from aionode.observe import to_chains, why

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.node import Node

__all__ = ["explain", "why_command"]


@click.command("why")
@click.argument("name", shell_complete=complete_names("topic"))
@click.option(
    "--timeout", type=positive, default=0.5, show_default=True, help="Time for an answer, in s."
)
@json_option
@ros2_options
def why_command(json: bool, **options: Any) -> None:
    """Show what led to the latest message of a topic, from callback to callback.

    NAME is a topic, a service, an action, a node, or the id of a goal. Processes keep causes if
    they are started with AIONODE_CAUSES=1; the others are named. Nodes of ROS 2 are where a chain
    ends. The exit status is 1 if nothing is known of the name.
    """
    run_verb(lambda node, output: explain(node, output=output, **options), json=json)


async def explain(node: Node, name: str, *, output: Output, timeout: float = 0.5) -> int:
    """Print what led to the latest thing of a name; return 1 if nothing is known of it, else 0.

    Args:
        node: The command's node.
        name: A topic, service, action, node or goal.
        output: Where to print.
        timeout: How long a process has to answer, in seconds.

    Raises:
        CommandError: nothing has this name.
    """
    found = await why(node, name, timeout_sec=timeout)
    if not found.sent:
        full = "/" + name.lstrip("/")
        names = {each.name for each in node.graph.endpoints()}
        names |= {each.fully_qualified_name for each in node.graph.nodes()}
        names |= {each.partition("/_action/")[0] for each in names}
        if full not in names:
            raise CommandError(
                f"{name}: no topic, service, action, node or goal has this name; "
                "`aionode graph` shows what there is"
            )
        told = to_chains(found)
        told = f"{full}: nothing is known to have been sent under this name" + (
            f"\n{told}" if told else ""
        )
        output.item(told, msgspec.to_builtins(found))
        return 1
    output.item(to_chains(found), msgspec.to_builtins(found))
    return int(all(each.unknown for each in found.sent))
