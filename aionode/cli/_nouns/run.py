"""``aionode run``: run node classes together in one process, or an rclpy program.

A program, or an executable of a package, replaces this process. One in Python whose name comes
first is started before this module is imported: see `aionode.cli.main`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import click

from aionode.cli._support.exit import become
from aionode.cli._support.options import interfaces_option
from aionode.cli._support.programs import Programs

__all__ = ["run_command"]

ROS_ARGS: Final = "--ros-args"


@click.command(
    context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False},
)
@click.argument(
    "args",
    nargs=-1,
    metavar="[MODULE:CLASS...|PROGRAM.py [ARGS]...|PACKAGE EXECUTABLE [ARGS]...]",
    type=click.UNPROCESSED,
)
@click.option(
    "-m",
    "module",
    metavar="MODULE[:FUNCTION]",
    help="Run a module as an rclpy program, or call a function, as an entry point does.",
)
@click.option("--rclpy", is_flag=True, help="Always treat the file as an rclpy program.")
@interfaces_option
@click.option(
    "--workspace",
    type=click.Path(exists=True, file_okay=False),
    metavar="FOLDER",
    help="Workspace to search for packages (default: the one around the program or this folder).",
)
@click.option(
    "--check",
    is_flag=True,
    help="List what programs or folders import and whether it is available; run nothing.",
)
def run_command(
    args: tuple[str, ...],
    module: str | None,
    rclpy: bool,
    workspace: str | None,
    check: bool,
) -> None:
    """Run node classes together in one process, or an rclpy program.

    Each MODULE:CLASS is imported, from the current folder or an installed package, and created
    without arguments; a file such as talker.py:Talker works too. Arguments after --ros-args apply
    to all nodes.

    A file that imports rclpy, or a message package such as std_msgs, runs unmodified and without
    ROS: aionode provides both. Arguments after the file name are the program's own.

    A folder with a package.xml is usable without a build: PACKAGE EXECUTABLE runs an entry point
    from its setup files, and MODULE:FUNCTION a function such as my_robot.talker:main. Packages that
    are installed, or built and sourced, are found as well.

    With --check, nothing is run: for each file, and each Python file in a folder, it lists the
    imports and where they are found. The exit status is 1 if something is missing.
    """
    programs = Programs(workspace)
    if check and (module is not None or not args):
        raise click.UsageError("--check takes files and folders, such as src/my_robot/talker.py.")
    if check:
        become(programs.under_rclpy("--check", *args))
    if module is not None:
        become(programs.under_rclpy("-m", module, *args))
    if args and rclpy:
        become(programs.under_rclpy(*args))
    command = programs.command(args)
    if command is not None:
        become(command)
    run_nodes(args, programs)


def run_nodes(args: Sequence[str], programs: Programs) -> None:
    """Run the nodes named before ``--ros-args`` in this process.

    Raises:
        UsageError: there is an option, or nothing at all, before ``--ros-args``.
        CommandError: a node is missing, or a file that runs its own nodes is not alone.
    """
    # Imported late: a program that replaces this process needs no nodes here.
    from aionode.runner import run
    from aionode.system.node_source import FITS, makers_of

    at = args.index(ROS_ARGS) if ROS_ARGS in args else len(args)
    specs, ros_args = args[:at], args[at:]
    for spec in specs:
        if spec.startswith("-"):
            raise click.UsageError(
                f"No such option '{spec}': arguments of nodes follow {ROS_ARGS}."
            )
    if not specs:
        raise click.UsageError(f"Nothing to run: {FITS}.")
    programs.use_workspace(specs)
    sys.path[:0] = [str(Path.cwd()), *programs.module_folders(specs)]
    sys.argv[:] = [specs[0], *ros_args]  # for a file that runs its own nodes
    makers = makers_of(specs)
    if makers:
        run(*makers, args=list(ros_args))
