"""``aionode run``: node classes together in one process, or a program of rclpy."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from aionode.cli._support.programs import Programs, replace_process

__all__ = ["run_command"]

ROS_ARGS = "--ros-args"


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
    help="Run a module as a program of rclpy, or call a function, as a package's executable does.",
)
@click.option("--rclpy", is_flag=True, help="Take a file for a program of rclpy in any case.")
@click.option(
    "--interfaces",
    multiple=True,
    type=click.Path(),
    metavar="FOLDER",
    help="Message packages that a program of rclpy uses; may be repeated.",
)
@click.option(
    "--workspace",
    type=click.Path(exists=True, file_okay=False),
    metavar="FOLDER",
    help="The packages that can be run and used; else those around the program, or around here.",
)
@click.option(
    "--check",
    is_flag=True,
    help="List what programs import, and whether it is there; run nothing. Takes folders as well.",
)
def run_command(
    args: tuple[str, ...],
    module: str | None,
    rclpy: bool,
    interfaces: tuple[str, ...],
    workspace: str | None,
    check: bool,
) -> None:
    """Run node classes together in one process, or a program of rclpy.

    Each MODULE:CLASS is imported, from the current folder or an installed package, and created
    without arguments; a file such as talker.py:Talker works too. What follows --ros-args applies to
    all nodes.

    A file that imports rclpy, or a message package such as std_msgs, runs as it is, without ROS:
    aionode takes their place. What follows the name of the file are its own arguments.

    A folder with a package.xml is a package as it is, without a build: PACKAGE EXECUTABLE runs what
    its setup files name, and MODULE:FUNCTION a function such as my_robot.talker:main. Packages that
    are installed, or built and sourced, are found as well.

    With --check, nothing runs: for each file, and each Python file of a folder, there is a list of
    what it imports and where that is. The exit status is 1 if something is missing.
    """
    programs = Programs(interfaces, workspace)
    if check and (module is not None or not args):
        raise click.UsageError("--check takes files and folders, such as src/my_robot/talker.py.")
    if check:
        replace_process(programs.under_rclpy("--check", *args))
    if module is not None:
        replace_process(programs.under_rclpy("-m", module, *args))
    if args and rclpy:
        replace_process(programs.under_rclpy(*args))
    command = programs.command(args)
    if command is not None:
        replace_process(command)
    # Not before: a program that takes the place of this process needs no nodes here.
    from aionode._node_source import FITS, node_maker
    from aionode.runner import run

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
    sys.path[:0] = [str(Path.cwd()), *programs.module_folders(specs)]
    run(*(node_maker(spec) for spec in specs), args=list(ros_args))
