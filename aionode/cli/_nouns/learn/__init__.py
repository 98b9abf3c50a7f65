"""``aionode learn``: from demonstrations to data sets for robot learning."""

from __future__ import annotations

import asyncio
import sys
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._nouns.bag.terminal import SPACE, keys_pressed, progress_shown
from aionode.cli._support.files import FilesGroup
from aionode.cli._support.options import interfaces_option, json_option, positive
from aionode.cli._support.output import Output
from aionode.cli._support.session import run_until_stopped, run_verb
from aionode.errors import AionodeError, escaped

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterator

    from aionode.learn import Episodes
    from aionode.node import Node

__all__ = ["learn_command"]

SHARE = click.FloatRange(0, 1)


@click.group("learn", cls=FilesGroup)
def learn_command() -> None:
    """Turn demonstrations into data sets for robot learning, by a contract.

    A contract is a YAML file that names the topics that a policy observes and commands.
    """


@learn_command.command("check")
@interfaces_option
@click.argument("contract")
@click.option("--time", "length", type=positive, default=3.0, help="Seconds to listen.")
@json_option
def check_command(contract: str, length: float, json: bool) -> None:
    """Compare a running robot with a contract.

    Prints the rate of each topic, its age at each picture and its QoS, and what does not fit. The
    exit status is 1 if something does not.
    """
    from aionode.learn import Contract, check

    read = Contract.load(contract)

    async def verb(node: Node, output: Output) -> int:
        found = await check(node, read, length)
        marked = [f"! {problem}" for problem in found.problems]
        output.item(
            escaped("\n".join([found.text, *marked])),
            {"topics": found.topics, "problems": found.problems},
        )
        return 1 if found.problems else 0

    run_verb(verb, json=json, busy=True)


@learn_command.command("record")
@interfaces_option
@click.option("--contract", required=True, metavar="FILE", help="The contract.")
@click.option("--task", default="", help="The task; default: that of the contract.")
@click.option("-o", "--output", "folder", default="episodes", help="The folder of the episodes.")
@click.option("--topic", "topics", multiple=True, help="A further topic to record.")
@click.option("--node-name", default="episodes", help="Name of the node.")
def record_command(
    contract: str, task: str, folder: str, topics: tuple[str, ...], node_name: str
) -> None:
    """Record demonstrations, each as a bag of its own, until Ctrl-C.

    SPACE starts an episode, and ends it as a success; f ends it as a failure, d discards it, and r
    discards it and starts again. The services ~/start, ~/end, ~/fail, ~/discard and ~/again do the
    same, and so does the action ~/record. A full disk ends the command with status 1.
    """
    from aionode.engine.context import Context
    from aionode.learn import Contract, Episodes
    from aionode.runner import best_loop_factory

    read = Contract.load(contract)

    async def record() -> None:
        episodes = Episodes(
            folder, read, task=task, topics=topics, context=Context(), node_name=node_name
        )
        async with episodes, asyncio.TaskGroup() as tasks:
            name = episodes.node.get_fully_qualified_name()
            episodes.node.get_logger().info(
                f"Ready to record into {folder}: SPACE or {name}/start starts an episode"
            )
            with keys_pressed(episode_keys(episodes, tasks), wanted=True):
                async with progress_shown(lambda: episodes.text, 3):
                    await episodes.failed()

    status = run_until_stopped(record(), loop_factory=best_loop_factory())
    raise click.exceptions.Exit(status or 0)


def episode_keys(episodes: Episodes, tasks: asyncio.TaskGroup) -> dict[str, Callable[[], object]]:
    """Return what the keys do."""

    async def toggle() -> object:
        return await (episodes.start() if episodes.current is None else episodes.end())

    async def told(act: Callable[[], Awaitable[object]]) -> None:
        try:
            await act()
        except (AionodeError, OSError) as error:
            episodes.node.get_logger().error(str(error))

    def pressed(act: Callable[[], Awaitable[object]]) -> None:
        tasks.create_task(told(act))

    acts = {SPACE: toggle, "f": episodes.fail, "d": episodes.discard, "r": episodes.again}
    return {key: partial(pressed, act) for key, act in acts.items()}


@learn_command.command("export")
@interfaces_option
@click.argument("episodes", nargs=-1, required=True)
@click.option("--lerobot", "out", required=True, metavar="OUT", help="The folder of the data set.")
@click.option("--contract", metavar="FILE", help="The contract; default: that of the recording.")
@click.option("--task", default="", help="The task; default: that of each recording.")
@click.option("--codec", type=click.Choice(["h264", "av1"]), default="h264", help="Video codec.")
@click.option("-j", "--jobs", type=click.IntRange(0), default=0, help="Bags at a time; 0 chooses.")
@click.option("--max-dropped", type=SHARE, default=0.05, help="Maximum share of missing rows.")
@click.option(
    "--max-repeated", type=SHARE, default=0.2, help="Maximum share of rows that repeat an image."
)
@click.option(
    "--max-rate-error",
    type=SHARE,
    default=0.05,
    help="Maximum deviation of the rate, as a share of fps.",
)
@click.option("--failures", is_flag=True, help="Also export failed episodes.")
@json_option
def export_command(episodes: tuple[str, ...], out: str, **values: Any) -> None:
    """Convert episodes to a data set of LeRobot, format v3.0.

    Each of EPISODES is a bag, or a folder of bags. Each picture of the contract's reference becomes
    a row; everything else is as of its time. Prints what became of the messages. The exit status is
    1 if a limit is exceeded. An export that was interrupted continues when it is started again.
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
            failures=values["failures"],
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
