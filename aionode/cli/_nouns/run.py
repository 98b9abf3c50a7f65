"""``aionode run``: node classes together in one process, or a program of rclpy."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from aionode._node_source import FITS, node_maker
from aionode.interfaces import shipped_packages

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["run_command"]

ROS_ARGS = "--ros-args"


@click.command(
    context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False},
)
@click.argument(
    "args", nargs=-1, metavar="[MODULE:CLASS...|PROGRAM.py [ARGS]...]", type=click.UNPROCESSED
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
    "--check",
    is_flag=True,
    help="List what programs import, and whether it is there; run nothing. Takes folders as well.",
)
def run_command(
    args: tuple[str, ...], module: str | None, rclpy: bool, interfaces: tuple[str, ...], check: bool
) -> None:
    """Run node classes together in one process, or a program of rclpy.

    Each MODULE:CLASS is imported, from the current folder or an installed package, and created
    without arguments; a file such as talker.py:Talker works too. What follows --ros-args applies to
    all nodes.

    A file that imports rclpy, or a message package such as std_msgs, runs as it is, without ROS:
    aionode takes their place. What follows the name of the file are its own arguments.

    With --check, nothing runs: for each file, and each Python file of a folder, there is a list of
    what it imports and where that is. The exit status is 1 if something is missing.
    """
    from aionode.runner import run

    if check and (module is not None or not args):
        raise click.UsageError("--check takes files and folders, such as src/my_robot/talker.py.")
    if check:
        run_program(interfaces, ("--check", *args))
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


def is_rclpy_program(name: str) -> bool:
    """Return whether a name is that of a file that imports rclpy or ROS's message packages.

    An executable that an installed package has in Python is one, too: it imports that package.
    """
    if not name.endswith(".py"):
        return is_script(name)
    try:
        tree = ast.parse(Path(name).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return False
    modules = {
        module
        for node in ast.walk(tree)
        for module in (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    return not {"rclpy", *shipped_packages()}.isdisjoint(
        module.partition(".")[0] for module in modules
    )


def is_script(name: str) -> bool:
    """Return whether a name is that of a file that Python runs, by the first line of the file."""
    try:
        with Path(name).open("rb") as file:
            first = file.readline(200)
    except OSError:
        return False
    return first.startswith(b"#!") and b"python" in first


def run_program(interfaces: Sequence[str], program: Sequence[str]) -> NoReturn:
    """Run a program of rclpy in the place of this process, as it is the owner of its signals.

    Args:
        interfaces: Folders with message packages.
        program: Its file, or ``-m`` and its module, and its arguments.
    """
    folders = [part for folder in interfaces for part in ("--interfaces", folder)]
    command = [sys.executable, "-m", "aionode.rclpy", *folders, *program]
    if sys.platform == "win32":  # where the new process would not take the place of this one
        sys.exit(subprocess.run(command, check=False).returncode)  # noqa: S603 (the user's program)
    os.execv(sys.executable, command)  # noqa: S606 (the same)
