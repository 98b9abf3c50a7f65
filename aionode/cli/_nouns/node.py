"""``aionode node``: list and inspect nodes."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import click

from aionode.cli._support import lookup
from aionode.cli._support.command import command
from aionode.cli._support.completion import name_argument
from aionode.cli._support.options import count_option, hidden_nodes_option
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.graph import NodeInfo
    from aionode.node import Node

__all__ = ["info", "list_nodes", "node_command"]

Offer = dict[str, list[str]]


@click.group("node")
def node_command() -> None:
    """List and inspect nodes."""


@command(node_command, "list", hidden_nodes_option, count_option("nodes"))
async def list_nodes(
    node: Node, *, output: Output, hidden: bool = False, count: bool = False
) -> None:
    """List the nodes on the network."""
    names = [info.fully_qualified_name for info in lookup.node_infos(node, hidden=hidden)]
    if len(set(names)) < len(names) and not count:
        output.warn(
            "WARNING: Be aware that there are nodes in the graph that share an exact name, which "
            "can have unintended side effects."
        )
    output.items([(name, {"name": name}) for name in names], count="nodes" * count)


@command(
    node_command,
    "info",
    name_argument("node"),
    click.option("--include-hidden", "hidden", is_flag=True, help="Show hidden names as well."),
)
async def info(node: Node, node_name: str, *, output: Output, hidden: bool = False) -> None:
    """Print the topics, services and actions of a node.

    Raises:
        CommandError: there is no such node.
    """
    name = lookup.absolute(node_name)
    nodes = lookup.node_infos(node, hidden=True)
    times = Counter(info.fully_qualified_name for info in nodes)
    if not times[name]:
        raise lookup.unknown("Unable to find node", node_name, times, "node list")
    if times[name] > 1:
        output.warn(
            f'There are {times[name]} nodes in the graph with the exact name "{name}". '
            "You are seeing information about only one of them."
        )
    shown = next(info for info in nodes if info.fully_qualified_name == name)
    offers = offers_of(node, shown, hidden=hidden)
    if output.json:
        output.item("", {"name": name, **{key(title): of for title, of in offers.items()}})
        return
    output.text(name)
    for title, of in offers.items():
        output.text(f"  {title}:")
        lines = [f"    {used}: {', '.join(types)}" for used, types in of.items()]
        output.text("\n".join(lines))


def key(title: str) -> str:
    """Return the record key for a heading."""
    return title.lower().replace(" ", "_")


def offers_of(node: Node, info: NodeInfo, *, hidden: bool) -> dict[str, Offer]:
    """Return the topics, services and actions of a node, under ros2's headings."""

    def offer(kind: EndpointKind) -> Offer:
        return lookup.names_and_types(node, kind, hidden=hidden, of=info)

    def actions(kind: EndpointKind) -> Offer:
        return lookup.actions_and_types(node, kind, of=info)

    return {
        "Subscribers": offer(EndpointKind.SUBSCRIPTION),
        "Publishers": offer(EndpointKind.PUBLISHER),
        "Service Servers": offer(EndpointKind.SERVER),
        "Service Clients": offer(EndpointKind.CLIENT),
        "Action Servers": actions(EndpointKind.PUBLISHER),
        "Action Clients": actions(EndpointKind.SUBSCRIPTION),
    }
