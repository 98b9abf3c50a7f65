"""``aionode node``: which nodes there are, and what they offer and use."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import click

from aionode.cli import lookup
from aionode.cli.completing import complete_names
from aionode.cli.options import json_option, ros2_options
from aionode.cli.session import run_verb
from aionode.graph import EndpointKind
from aionode.node_graph import actions_among

if TYPE_CHECKING:
    from aionode.cli.output import Output
    from aionode.graph import NodeInfo
    from aionode.node import Node

__all__ = ["info", "list_nodes", "node"]

Offer = dict[str, list[str]]


async def list_nodes(
    node: Node, *, output: Output, hidden: bool = False, count: bool = False
) -> None:
    """Print the full name of every node."""
    names = [info.fully_qualified_name for info in lookup.node_infos(node, hidden=hidden)]
    if count:
        output.item(str(len(names)), {"nodes": len(names)})
        return
    if len(set(names)) < len(names):
        output.warn(
            "WARNING: Be aware that there are nodes in the graph that share an exact name, which "
            "can have unintended side effects."
        )
    for name in names:
        output.item(name, {"name": name})


async def info(node: Node, node_name: str, *, output: Output, hidden: bool = False) -> None:
    """Print what a node publishes, subscribes to, serves and calls."""
    name = absolute(node_name)
    nodes = lookup.node_infos(node, hidden=True)
    times = Counter(one.fully_qualified_name for one in nodes)
    if not times[name]:
        raise lookup.unknown("Unable to find node", node_name, times, "node list")
    if times[name] > 1:
        output.warn(
            f'There are {times[name]} nodes in the graph with the exact name "{name}". '
            "You are seeing information about only one of them."
        )
    found = next(one for one in nodes if one.fully_qualified_name == name)
    offers = offers_of(node, found, hidden=hidden)
    if output.json:
        output.item("", {"name": name, **{key(title): of for title, of in offers.items()}})
        return
    output.text(name)
    for title, of in offers.items():
        output.text(f"  {title}:")
        lines = [f"    {used}: {', '.join(types)}" for used, types in of.items()]
        output.text("\n".join(lines))


def key(title: str) -> str:
    """Return the name of a heading in a record."""
    return title.lower().replace(" ", "_")


def offers_of(node: Node, found: NodeInfo, *, hidden: bool) -> dict[str, Offer]:
    """Return what a node offers and uses, under ros2's headings."""

    def offer(kind: EndpointKind) -> Offer:
        return lookup.names_and_types(node, kind, hidden=hidden, of=found)

    def actions(kind: EndpointKind) -> Offer:
        topics = lookup.names_and_types(node, kind, hidden=True, of=found)
        return dict(actions_among(list(topics.items())))

    return {
        "Subscribers": offer(EndpointKind.SUBSCRIPTION),
        "Publishers": offer(EndpointKind.PUBLISHER),
        "Service Servers": offer(EndpointKind.SERVER),
        "Service Clients": offer(EndpointKind.CLIENT),
        "Action Servers": actions(EndpointKind.PUBLISHER),
        "Action Clients": actions(EndpointKind.SUBSCRIPTION),
    }


def absolute(node_name: str) -> str:
    """Return the full name of a node; the leading slash may be left out."""
    return node_name if node_name.startswith("/") else f"/{node_name}"


@click.group()
def node() -> None:
    """List nodes, and what they offer and use."""


@node.command("list")
@click.option("-a", "--all", "hidden", is_flag=True, help="List hidden nodes as well.")
@click.option("-c", "--count-nodes", "count", is_flag=True, help="Print only how many there are.")
@json_option
@ros2_options
def list_command(json: bool, hidden: bool, count: bool) -> None:
    """List the nodes that can be reached."""
    run_verb(
        lambda node, output: list_nodes(node, hidden=hidden, count=count, output=output), json=json
    )


@node.command("info")
@click.argument("node_name", shell_complete=complete_names("node"))
@click.option("--include-hidden", "hidden", is_flag=True, help="Show hidden names as well.")
@json_option
@ros2_options
def info_command(node_name: str, json: bool, hidden: bool) -> None:
    """Print what a node publishes, subscribes to, serves and calls."""
    run_verb(lambda node, output: info(node, node_name, hidden=hidden, output=output), json=json)
