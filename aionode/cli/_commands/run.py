"""``aionode run``: its commands, arguments and options."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from aionode.cli._verbs.run import FITS, ROS_ARGS, node_maker

__all__ = ["run_command"]


@click.command(
    context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False},
)
@click.argument("args", nargs=-1, required=True, metavar="MODULE:CLASS...", type=click.UNPROCESSED)
def run_command(args: tuple[str, ...]) -> None:
    """Run node classes together in one process.

    Each MODULE:CLASS is imported, from the current folder or an installed package, and created
    without arguments; a file such as talker.py:Talker works too. What follows --ros-args applies to
    all nodes.
    """
    from aionode.runner import run

    at = args.index(ROS_ARGS) if ROS_ARGS in args else len(args)
    specs, ros_args = args[:at], args[at:]
    for spec in specs:
        if spec.startswith("-"):
            raise click.UsageError(
                f"No such option '{spec}': arguments of nodes follow {ROS_ARGS}."
            )
    if not specs:
        raise click.UsageError(f"Nothing to run: {FITS}.")
    sys.path.insert(0, str(Path.cwd()))
    run(*(node_maker(spec) for spec in specs), args=list(ros_args))
