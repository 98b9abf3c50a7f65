"""``aionode trace``: the callbacks of all processes on one axis of time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from aionode.cli._support.command import command
from aionode.cli._support.options import positive
from aionode.errors import CommandError, escaped
from aionode.observe import record_trace

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.node import Node
    from aionode.observe import Trace

__all__ = ["record", "trace_command"]


@click.group("trace")
def trace_command() -> None:
    """Record what all processes do, callback by callback."""


@command(
    trace_command,
    "record",
    click.argument("path", metavar="FILE", type=click.Path(path_type=Path)),
    click.option(
        "-d", "--duration", type=positive, default=10.0, show_default=True, help="Time in s."
    ),
)
async def record(node: Node, path: Path, *, output: Output, duration: float = 10.0) -> int:
    """Record the callbacks of all processes, with arrows for messages, into FILE.

    https://ui.perfetto.dev and chrome://tracing open it. Processes take part if they keep causes,
    that is, are started with AIONODE_CAUSES=1; the others are named. The exit status is 1 if none
    does.

    Args:
        node: The command's node.
        path: Where to write it.
        output: Where to print.
        duration: How long to record, in seconds.

    Raises:
        CommandError: the file cannot be written.
    """
    with output.waiting(f"Recording for {duration:g} s"):
        trace = await record_trace(node, duration)
    write(path, trace)
    notes = {
        "callbacks are not recorded: start it with AIONODE_CAUSES=1": trace.not_kept,
        "no answer": trace.silent,
        "its version of aionode is too old, or reports callbacks in another form": trace.older,
    }
    lines = [f"{path}: {trace.callbacks} callbacks"]
    if trace.lost:
        lines.append(
            f"{trace.lost} callbacks and sent items are missing: a process had more of them than "
            "it keeps between two queries, or the trace was full; record for a shorter time"
        )
    lines += [
        f"{', '.join(nodes)}: {text}"
        for text, those in notes.items()
        for nodes in those.values()
        if nodes
    ]
    output.item(
        "\n".join(escaped(line, one_line=True) for line in lines),
        {
            "file": str(path),
            "callbacks": trace.callbacks,
            "lost": trace.lost,
            "not_kept": trace.not_kept,
            "silent": trace.silent,
            "older": trace.older,
        },
    )
    return int(not trace.callbacks)


def write(path: Path, trace: Trace) -> None:
    """Write a trace to a file."""
    try:
        path.write_bytes(trace.to_json())
    except OSError as error:
        raise CommandError(f"{path}: cannot be written: {error.strerror}") from error
