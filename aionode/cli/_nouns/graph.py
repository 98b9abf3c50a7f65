"""``aionode graph``: nodes and their connections, as text and as pictures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click
import msgspec

from aionode.cli._support.completion import complete_names
from aionode.cli._support.options import json_option, positive, ros2_options
from aionode.cli._support.session import run_verb
from aionode.errors import CommandError, brief
from aionode.observe import (
    Picture,
    difference,
    observe,
    picture_of,
    rates,
    to_dot,
    to_mermaid,
    to_svg,
    to_text,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.cli._support.output import Output
    from aionode.node import Node

__all__ = ["draw", "graph_command"]

FORMS: Final = {"text": to_text, "dot": to_dot, "mermaid": to_mermaid, "svg": to_svg}

LARGEST: Final = 64 * 2**20
"""Maximum size of a saved picture, in bytes."""


@click.command("graph")
@click.argument("names", nargs=-1, shell_complete=complete_names("topic"))
@click.option("--dot", "form", flag_value="dot", help="Print in Graphviz's language.")
@click.option("--mermaid", "form", flag_value="mermaid", help="Print in Mermaid's language.")
@click.option("--svg", "form", flag_value="svg", help="Print a picture as SVG.")
@click.option("--all", "everything", is_flag=True, help="Include infrastructure and hidden nodes.")
@click.option("--measure", is_flag=True, help="Show rates, as counted by the nodes.")
@click.option(
    "--duration", type=positive, default=1.0, show_default=True, help="Time to measure, in s."
)
@click.option("--save", type=click.Path(path_type=Path), help="Save the current graph.")
@click.option(
    "--since", type=click.Path(path_type=Path), help="Mark what is new since a saved graph."
)
@json_option
@ros2_options
def graph_command(json: bool, **options: Any) -> None:
    """Draw nodes and the topics, services and actions that they share.

    NAMES restrict it to those nodes, topics, services and actions, and to whatever these connect
    to; a name that ends in a slash stands for everything below it. Mismatches are red, with their
    reasons. The exit status is 1 if something does not match.
    """
    run_verb(lambda node, output: draw(node, output=output, **options), json=json)


async def draw(
    node: Node,
    names: Sequence[str] = (),
    *,
    output: Output,
    form: str | None = None,
    everything: bool = False,
    measure: bool = False,
    duration: float = 1.0,
    save: Path | None = None,
    since: Path | None = None,
) -> int:
    """Print a picture of the graph; return 1 if something does not match, else 0.

    Args:
        node: The command's node.
        names: Only these nodes, topics, services and actions, and their neighbours.
        output: Where to print.
        form: ``text``, ``dot``, ``mermaid`` or ``svg``; by default text.
        everything: Whether infrastructure and hidden nodes are drawn.
        measure: Whether to ask the nodes for rates.
        duration: How long to measure, in seconds.
        save: The file to which the graph is saved.
        since: A file with an earlier graph, for comparison.

    Raises:
        CommandError: a file cannot be read or written, or nothing has one of the names.
    """
    hz = await measured(node, duration, output) if measure else None
    picture = picture_of(node.graph, names=names, everything=everything, hz=hz)
    if names and not picture.vertices:
        known = ", ".join(each.name for each in picture_of(node.graph).vertices[:10])
        raise CommandError(
            f"nothing is named {' or '.join(names)}; "
            + (f"there are {known}" if known else "no other process has a node")
        )
    if save is not None:
        save_picture(save, picture)
    if since is not None:
        picture = difference(saved_picture(since), picture)
    output.item(FORMS[form or "text"](picture), msgspec.to_builtins(picture))
    return int(any(edge.mismatch for edge in picture.edges))


async def measured(
    node: Node, duration: float, output: Output
) -> dict[tuple[str, str, str], float]:
    """Return the rate at which each endpoint sends or receives, as counted by the processes."""
    before = await observe(node)
    with output.waiting("Measuring"):
        await node.get_clock().sleep(duration)
    found: dict[tuple[str, str, str], float] = {}
    for entity in rates(before, await observe(node)).entities():
        kind = {"service": "server", "action server": "server"}.get(
            entity.report.kind, entity.report.kind
        )
        key = (entity.node, kind, entity.report.name)
        found[key] = found.get(key, 0.0) + entity.hz
    return found


def save_picture(path: Path, picture: Picture) -> None:
    """Write a picture to a file."""
    try:
        path.write_bytes(msgspec.json.format(msgspec.json.encode(picture)) + b"\n")
    except OSError as error:
        raise CommandError(f"{path}: cannot be written: {error.strerror}") from error


def saved_picture(path: Path) -> Picture:
    """Return the picture in a file that `save_picture` wrote."""
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST)
        return msgspec.json.decode(data, type=Picture)
    except OSError as error:
        raise CommandError(f"{path}: cannot be read: {error.strerror}") from error
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        problem = f"it is not a graph written by --save ({brief(str(error))})"
        raise CommandError(f"{path}: {problem}") from error
