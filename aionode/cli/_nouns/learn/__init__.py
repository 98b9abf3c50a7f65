"""``aionode learn``: from demonstrations to data sets for robot learning."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._support.options import interfaces_option, json_option
from aionode.cli._support.output import Output

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["learn_command"]

SHARE = click.FloatRange(0, 1)


@click.group("learn")
def learn_command() -> None:
    """Turn demonstrations into data sets for robot learning, by a contract.

    A contract is a YAML file that names the topics that a policy observes and commands.
    """


@learn_command.command("export")
@interfaces_option
@click.argument("episodes", nargs=-1, required=True)
@click.option("--lerobot", "out", required=True, metavar="OUT", help="The folder of the data set.")
@click.option("--contract", metavar="FILE", help="The contract; default: that of the recording.")
@click.option("--task", default="", help="The task; default: that of each recording.")
@click.option("--codec", type=click.Choice(["h264", "av1"]), default="h264", help="Of the videos.")
@click.option(
    "-j", "--jobs", type=click.IntRange(0), default=0, help="Bags at a time; 0 for a good number."
)
@click.option("--max-dropped", type=SHARE, default=0.05, help="Share of rows that may be missing.")
@click.option(
    "--max-repeated", type=SHARE, default=0.2, help="Share of rows that may repeat a picture."
)
@click.option(
    "--max-rate-error", type=SHARE, default=0.05, help="How far the rate may be from fps."
)
@json_option
def export_command(episodes: tuple[str, ...], out: str, **values: Any) -> None:
    """Convert episodes to a data set of LeRobot, format v3.0.

    Each of EPISODES is a bag, or a folder of bags. Each picture of the contract's reference is a
    row; everything else is as of its time. Prints what became of the messages. The exit status is 1
    if something is over the limits. What was interrupted goes on when it is started again.
    """
    from aionode.learn import Contract, Limits, export

    output = Output(json=values["json"])
    contract = values["contract"]
    with progress_bar("Exporting") as progress:
        exported = export(
            out,
            episodes,
            contract=None if contract is None else Contract.load(contract),
            task=values["task"],
            codec=values["codec"],
            jobs=values["jobs"],
            limits=Limits(values["max_dropped"], values["max_repeated"], values["max_rate_error"]),
            progress=progress,
        )
    output.item(
        exported.text,
        {
            "path": exported.path,
            "episodes": exported.episodes,
            "rows": exported.rows,
            "problems": exported.problems,
            "reports": exported.reports,
        },
    )
    raise click.exceptions.Exit(1 if exported.problems else 0)


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None] | None]:
    """Show a progress bar inside the block, if stderr is a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(what, total=None)
        yield lambda done, total: shown.update(task, completed=done, total=total)
