"""``aionode bag diff`` and ``shrink``: recordings as tests."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from aionode.cli._support.exit import INTERRUPTED
from aionode.cli._support.options import json_option
from aionode.cli._support.output import Output
from aionode.cli._support.session import run_until_stopped
from aionode.errors import escaped

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.bag.replaying.shrinking import Piece

__all__ = ["diff_command", "shrink_command"]


@click.command("diff")
@click.argument("a", metavar="A")
@click.argument("b", metavar="B")
@click.option(
    "--tolerance", type=click.FloatRange(min=0), default=0.0, help="Allowed difference of numbers."
)
@click.option(
    "--time-tolerance", type=click.FloatRange(min=0), default=0.0, metavar="SECONDS",
    help="Allowed difference of times.",
)  # fmt: skip
@click.option(
    "--limit", type=click.IntRange(min=1), default=10, help="Differences to show per topic."
)
@json_option
def diff_command(
    a: str, b: str, tolerance: float, time_tolerance: float, limit: int, json: bool
) -> None:
    """Print the first differences between two bags, by topic, time and field.

    The exit status is 1 if they differ.
    """
    from aionode.bag import compare  # the extra `bag` may be missing

    output = Output(json=json)
    differences = compare(a, b, tolerance, time_tolerance_sec=time_tolerance, limit=limit)
    for difference in differences:
        record = {
            "topic": difference.topic,
            "time_ns": difference.time_ns,
            "field": difference.field,
            "a": difference.left,
            "b": difference.right,
        }
        output.item(str(difference), record)
    if not differences:
        output.text("no differences")
    raise click.exceptions.Exit(1 if differences else 0)


@click.command("shrink", context_settings={"ignore_unknown_options": True})
@click.argument("bag", metavar="BAG")
@click.argument("test", metavar="-- COMMAND…", nargs=-1, required=True, type=click.UNPROCESSED)
@click.option("-o", "--output", "folder", help="Where to write the piece (default: BAG_piece).")
@json_option
def shrink_command(bag: str, test: tuple[str, ...], folder: str | None, json: bool) -> None:
    """Find the shortest piece of a bag with which a test still fails, and write it as a bag.

    COMMAND is run repeatedly, such as ``-- pytest tests/test_filter.py``; meanwhile, `replay` of
    BAG reads only the piece being tried.
    """
    output = Output(json=json)
    place = Path(folder) if folder else Path(f"{bag.rstrip('/')}_piece")
    if place.exists():
        raise click.UsageError(f"{place} already exists; choose another folder with --output")
    status = run_until_stopped(shrink(bag, test, place, output))
    raise click.exceptions.Exit(INTERRUPTED if status is None else status)


async def shrink(bag: str, test: Sequence[str], place: Path, output: Output) -> int:
    """Search for the piece, print each shorter one found, and write the last."""
    from aionode.bag.replaying import shrinking  # as above

    def show(piece: Piece) -> None:
        seconds = (piece.end_ns - piece.start_ns) / 1e9
        output.item(
            escaped(f"fails with {seconds:.3f} s of {', '.join(piece.topics)}", one_line=True),
            piece,
        )

    async def fails(piece: Piece) -> bool:
        return await shrinking.fails(test, piece)

    piece = await shrinking.shrink(bag, fails, show)
    count = shrinking.write(piece, place)
    output.text(f"{place}: {count} messages, with which the command fails")
    return 0
