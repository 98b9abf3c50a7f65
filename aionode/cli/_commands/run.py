"""``aionode run``: its commands, arguments and options."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from aionode.cli._verbs.run import FITS, ROS_ARGS, is_rclpy_program, node_maker, run_program

__all__ = ["run_command"]


@click.command(
    context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False},
)
@click.argument(
    "args", nargs=-1, metavar="[MODULE:CLASS...|PROGRAM.py [ARGS]...]", type=click.UNPROCESSED
)
@click.option("-m", "module", metavar="MODULE", help="Run a module as a program of rclpy.")
@click.option("--rclpy", is_flag=True, help="Take a file for a program of rclpy in any case.")
@click.option(
    "--interfaces",
    multiple=True,
    type=click.Path(),
    metavar="FOLDER",
    help="Message packages that a program of rclpy uses; may be repeated.",
)
def run_command(
    args: tuple[str, ...], module: str | None, rclpy: bool, interfaces: tuple[str, ...]
) -> None:
    """Run node classes together in one process, or a program of rclpy.

    Each MODULE:CLASS is imported, from the current folder or an installed package, and created
    without arguments; a file such as talker.py:Talker works too. What follows --ros-args applies to
    all nodes.

    A file that imports rclpy, or a message package such as std_msgs, runs as it is, without ROS:
    aionode takes their place. What follows the name of the file are its own arguments.
    """
    from aionode.runner import run

    if module is not None:
        run_program(interfaces, ("-m", module, *args))
    elif args and (rclpy or is_rclpy_program(args[0])):
        run_program(interfaces, args)
    if rclpy or interfaces:
        raise click.UsageError("--rclpy and --interfaces are for programs of rclpy.")
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
