"""``aionode top``: what all processes of a robot do, live."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from aionode.cli._nouns.top.tables import record_of, text_of
from aionode.cli._support.options import json_option, positive, ros2_options
from aionode.cli._support.session import run_verb
from aionode.errors import CommandError
from aionode.observe import observe, rates

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.node import Node

__all__ = ["top", "top_command"]


@click.command("top")
@click.option("--once", is_flag=True, help="Print one snapshot as text and exit.")
@click.option(
    "--interval", type=positive, default=2.0, show_default=True, help="Time between updates, in s."
)
@json_option
@ros2_options
def top_command(json: bool, once: bool, interval: float) -> None:
    """Show what all processes of a robot do: rates, losses, callbacks, processors, memory, log.

    The processes are asked for their counts, so no topic is subscribed to. --once and --json need
    only aionode; the live view needs the extra `tui`.
    """
    run_verb(
        lambda node, output: top(node, output=output, once=once, interval=interval),
        json=json,
        endless=not once,
    )


async def top(node: Node, *, output: Output, once: bool = False, interval: float = 2.0) -> None:
    """Show what all processes do, until Ctrl-C.

    Args:
        node: The command's node.
        output: Where to print.
        once: Whether to print one snapshot and return.
        interval: The time between two snapshots, in seconds.

    Raises:
        CommandError: the live view cannot be shown.
    """
    if not (once or output.json):
        await live(node, output, interval)
        return
    before = await observe(node)
    while True:
        await node.get_clock().sleep(interval)
        after = await observe(node)
        found = rates(before, after)
        output.item(text_of(found), record_of(found))
        if once:
            return
        before = after


async def live(node: Node, output: Output, interval: float) -> None:
    """Show the live view."""
    try:
        from aionode.cli._nouns.top.screen import TopApp
    except ImportError as error:
        if error.name is None or error.name.partition(".")[0] != "textual":
            raise
        raise CommandError(
            "the live view needs Textual, which is not installed: pip install 'aionode[tui]'; "
            "`aionode top --once` prints a snapshot without it"
        ) from error
    if not (output.is_terminal and sys.stdin.isatty()):
        raise CommandError("the live view needs a terminal; use --once or --json")
    await TopApp(node, interval).run_async()
