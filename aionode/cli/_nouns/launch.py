"""``aionode launch``: start the processes and nodes of a launch file."""

from __future__ import annotations

import json
import os
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from typing import TYPE_CHECKING

import click

from aionode._packages import Packages, around, tools_on_path
from aionode.cli._support.exit import become
from aionode.cli._support.options import interfaces_option
from aionode.errors import CommandError, escaped

if TYPE_CHECKING:
    from aionode.launch import DeclaredArgument, Plan

__all__ = ["launch_command"]


@click.command(
    context_settings={"ignore_unknown_options": True, "allow_interspersed_args": True},
)
@click.argument("file", metavar="FILE|PACKAGE")
@click.argument("arguments", nargs=-1, metavar="[FILE] [NAME:=VALUE]...")
@click.option("-s", "--show-args", is_flag=True, help="List the arguments of the file.")
@click.option(
    "-p",
    "--print",
    "prints",
    is_flag=True,
    help="Print what would be started (command lines, parameters, environment) and exit.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON record per line.")
@click.option(
    "--log-folder",
    type=click.Path(file_okay=False),
    metavar="FOLDER",
    help="Also write the logs to this folder, one file per process, rotated at 10 MB.",
)
@click.option("--watch", is_flag=True, help="Restart a process when its program file changes.")
@click.option("--once-ready", metavar="CMD", help="Run a command when all nodes are in the graph.")
@click.option(
    "--skip-missing",
    is_flag=True,
    help="Skip whatever needs a missing package, with one warning per package.",
)
@click.option("--real", is_flag=True, help="Run the file with ROS 2's own launch, if installed.")
@click.option(
    "--workspace",
    type=click.Path(exists=True, file_okay=False),
    metavar="FOLDER",
    help="Workspace with the packages it uses, built or not (default: the one around the file).",
)
@interfaces_option
@click.option(
    "-d", "--debug", is_flag=True, help="Accepted for compatibility with ros2; has no effect."
)
@click.option(
    "-n",
    "--noninteractive",
    is_flag=True,
    help="Exit with 0 whatever happens to the processes, as ros2 launch does.",
)
def launch_command(
    file: str,
    arguments: tuple[str, ...],
    show_args: bool,
    prints: bool,
    as_json: bool,
    log_folder: str | None,
    watch: bool,
    once_ready: str | None,
    skip_missing: bool,
    real: bool,
    workspace: str | None,
    debug: bool,
    noninteractive: bool,
) -> None:
    """Start the processes and nodes of a launch file, and stop them together.

    A launch file is a ROS 2 launch file in Python, XML or YAML, or a Python file with `async def
    main(system)`. If anything in it cannot be evaluated, nothing is started. Ctrl-C stops
    everything; a second Ctrl-C ends it immediately.
    """
    from aionode.launch import Plan

    path, values = file_and_values(file, arguments, workspace)
    if real:
        run_real(path, values)
    packages = around(Path(path)) if workspace is None else Packages(Path(workspace))
    with tools_on_path(packages.starter):
        plan = Plan(path, values, workspace=workspace, skip_missing=skip_missing)
        if show_args:
            for line in map(argument_text, plan.declared):
                click.echo(escaped(line))
        elif prints:
            print_plan(plan, as_json=as_json)
        else:
            status = start(
                plan, watch=watch, once_ready=once_ready, as_json=as_json, log_folder=log_folder
            )
            if status and not noninteractive:
                raise click.exceptions.Exit(status)


def file_and_values(
    file: str, arguments: tuple[str, ...], workspace: str | None
) -> tuple[str, dict[str, str]]:
    """Return the path of the launch file, and the values of its arguments.

    Raises:
        CommandError: an argument is not NAME:=VALUE, or the package has no such file.
    """
    words = list(arguments)
    if words and ":=" not in words[0] and not Path(file).is_file():
        file = file_of_package(file, words.pop(0), workspace)
    values = {}
    for word in words:
        name, separator, value = word.partition(":=")
        if not (separator and name):
            raise CommandError(f"{word!r}: expected NAME:=VALUE, such as use_sim_time:=true")
        values[name] = value
    return file, values


def file_of_package(package: str, name: str, workspace: str | None) -> str:
    """Return the path of a launch file in the share folder of a package.

    Raises:
        CommandError: there is no such file, or there are several.
    """
    from aionode.launch import share_directory

    share = share_directory(package, workspace)
    below = files_below(share)
    files = [file for file in below if file.name == name]
    if len(files) == 1:
        return str(files[0])
    if files:
        places = ", ".join(str(file.relative_to(share)) for file in files)
        raise CommandError(f"{package}: {name} exists more than once: {places}; give its path")
    endings = ("launch.py", "launch.xml", "launch.yaml", "launch.yml", ".launch")
    known = sorted(file.name for file in below if file.name.endswith(endings))
    raise CommandError(
        f"{package}: no file {name} in {share}; available: {', '.join(known) or 'none'}"
    )


def files_below(share: Path) -> list[Path]:
    """Return the files below a folder of data, each once, following links to folders."""
    files: dict[Path, Path] = {}
    seen: set[Path] = set()
    for place, folders, names in os.walk(share, followlinks=True):
        folders.sort()
        folders[:] = [] if Path(place).resolve() in seen else folders
        seen.add(Path(place).resolve())
        for name in sorted(names):
            files.setdefault(Path(place, name).resolve(), Path(place, name))
    return sorted(files.values())


def argument_text(argument: DeclaredArgument) -> str:
    """Return lines of text that describe an argument."""
    lines = [f"'{argument.name}':"]
    lines.append(f"    {argument.description or 'no description given'}")
    if argument.choices is not None:
        lines.append(f"    one of: {', '.join(argument.choices)}")
    if argument.default is not None:
        lines.append(f"    (default: {argument.default})")
    return "\n".join(lines)


def print_plan(plan: Plan, *, as_json: bool) -> None:
    """Print what would be started."""
    if as_json:
        for record in plan.records():
            click.echo(json.dumps(record))
    else:
        for line in plan.lines():
            click.echo(escaped(line))


def start(
    plan: Plan, *, watch: bool, once_ready: str | None, as_json: bool, log_folder: str | None
) -> int:
    """Start a plan; return the exit status of the first failure, or 0."""
    from aionode.launch import run_plan
    from aionode.runner import run
    from aionode.system import System, SystemLog

    _ = plan.steps  # so that errors in the file are reported before anything starts
    log = SystemLog(json=as_json, folder=log_folder)
    system = System(Path(plan.path).name.partition(".")[0], log=log)

    async def main() -> None:
        async with system:
            await run_plan(plan, system, watch=watch, once_ready=once_ready)

    run(main, args=[])
    return system.exit_status


def run_real(path: str, values: dict[str, str]) -> None:
    """Replace this process by ROS 2's own launch.

    Raises:
        CommandError: it is not installed.
    """
    if not (is_installed("launch") and is_installed("launch_ros")):
        raise CommandError(
            "--real: ROS 2's launch and launch_ros are not installed here; source ROS 2, or "
            "omit --real: aionode supports what most launch files use"
        )
    arguments = [f"{name}:={value}" for name, value in values.items()]
    become([sys.executable, "-m", "aionode.launch", str(Path(path)), *arguments])


def is_installed(package: str) -> bool:
    """Return whether a package other than aionode's own, which is marked as such, is installed."""
    spec = PathFinder.find_spec(package)
    if spec is None or spec.origin is None:
        return False
    text = Path(spec.origin).read_text(encoding="utf-8", errors="replace")
    return "aionode" not in text[:300]
