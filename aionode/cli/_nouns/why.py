"""``aionode why``: what led to the latest message of a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
import msgspec

from aionode.cli._support.bags import open_bag
from aionode.cli._support.completion import complete_names
from aionode.cli._support.options import json_option, positive, ros2_options, seconds
from aionode.cli._support.output import Output
from aionode.cli._support.session import run_verb
from aionode.clock import Duration
from aionode.errors import CommandError, escaped
from aionode.observe import to_chains, why

if TYPE_CHECKING:
    from aionode.node import Node
    from aionode.observe import Why

__all__ = ["explain", "why_command"]


@click.command("why")
@click.argument("name", shell_complete=complete_names("topic"))
@click.option(
    "--timeout",
    type=positive,
    default=0.5,
    show_default=True,
    help="Maximum time to wait for an answer, in s.",
)
@click.option(
    "--from",
    "bag_path",
    metavar="BAG",
    help="Answer from a recording with causes: `aionode bag record --causes`.",
)
@click.option("--at", type=seconds, help="With --from: as of this time after its start, in s.")
@json_option
@ros2_options
def why_command(
    json: bool, name: str, bag_path: str | None, at: float | None, **options: Any
) -> None:
    """Show what led to the latest message of a topic, from callback to callback.

    NAME is a topic, a service, an action, a node, or the id of a goal. Processes keep causes if
    they are started with AIONODE_CAUSES=1; the others are named. A chain ends at nodes of
    ROS 2. The exit status is 1 if nothing is known of the name.
    """
    if bag_path is not None:
        raise click.exceptions.Exit(explain_recorded(bag_path, name, at, Output(json=json)))
    if at is not None:
        raise click.UsageError("--at needs a recording: --from BAG")
    run_verb(lambda node, output: explain(node, name, output=output, **options), json=json)


def explain_recorded(path: str, name: str, at_sec: float | None, output: Output) -> int:
    """Print what led to the latest item of a name in a bag; return the same as `explain`.

    Raises:
        CommandError: there is no such bag.
        BagError: the bag has no causes, or cannot be read.
    """
    from aionode import bag

    with open_bag(path) as recording:
        at = None if at_sec is None else Duration(seconds=at_sec)
        return tell(bag.why(recording, name, at), output)


async def explain(node: Node, name: str, *, output: Output, timeout: float = 0.5) -> int:
    """Print what led to the latest item of a name; return 1 if nothing is known of it, else 0.

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
    return tell(found, output)


def tell(found: Why, output: Output) -> int:
    """Print what led to something; return 1 if nothing is known of it, else 0."""
    told = to_chains(found)
    if not found.sent:
        name = escaped("/" + found.name.lstrip("/"), one_line=True)
        told = f"{name}: nothing is known to have been sent under this name" + (
            f"\n{told}" if told else ""
        )
    output.item(told, msgspec.to_builtins(found))
    return int(all(each.unknown for each in found.sent))
