"""``aionode launch``: processes and nodes as a launch file says."""

from __future__ import annotations

import json
import os
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from typing import TYPE_CHECKING

import click

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
    help="Print what would be started: command lines, parameters, environment. Start nothing.",
)
@click.option("--json", "as_json", is_flag=True, help="One record of JSON a line.")
@click.option(
    "--log-folder",
    type=click.Path(file_okay=False),
    metavar="FOLDER",
    help="Write the log into files as well, one for each process; they are rotated at 10 MB.",
)
@click.option(
    "--watch", is_flag=True, help="Restart a process when the file of its program changes."
)
@click.option("--once-ready", metavar="CMD", help="Run a command when all nodes are in the graph.")
@click.option(
    "--skip-missing",
    is_flag=True,
    help="Leave out what needs a package that is not there, with one warning for each package.",
)
@click.option("--real", is_flag=True, help="Run the file with ROS 2's launch, if it is installed.")
@click.option(
    "--workspace",
    type=click.Path(exists=True, file_okay=False),
    metavar="FOLDER",
    help="The packages that the file names, which need no build; else the workspace around it.",
)
@interfaces_option
@click.option("-d", "--debug", is_flag=True, help="Accepted, as in ros2 launch; changes nothing.")
@click.option(
    "-n",
    "--noninteractive",
    is_flag=True,
    help="The exit status is that of ros2 launch: 0, whatever becomes of the processes.",
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
    """Start processes and nodes as a launch file says, and stop them together.

    A launch file is one of ROS 2, in Python, XML or YAML, or has `async def main(system)`. Nothing
    is started if anything in it cannot be evaluated. Ctrl-C stops everything, and a second one ends
    it at once.
    """
    from aionode.launch import Plan

    path, values = file_and_values(file, arguments, workspace)
    if real:
        run_real(path, values)
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
        CommandError: An argument is not NAME:=VALUE, or the package has no such file.
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
    """Return the path of a launch file of a package: the one below its share folder.

    Raises:
        CommandError: It has no such file, or several.
    """
    from aionode.launch import share_directory

    share = share_directory(package, workspace)
    below = files_below(share)
    files = [file for file in below if file.name == name]
    if len(files) == 1:
        return str(files[0])
    if files:
        places = ", ".join(str(file.relative_to(share)) for file in files)
        raise CommandError(f"{package}: {name} is there more than once: {places}; give its path")
    endings = ("launch.py", "launch.xml", "launch.yaml", "launch.yml", ".launch")
    known = sorted(file.name for file in below if file.name.endswith(endings))
    raise CommandError(
        f"{package}: no file {name} in {share}; it has: {', '.join(known) or 'none'}"
    )


def files_below(share: Path) -> list[Path]:
    """Return the files in a folder of data, each once, also those in folders that are links."""
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
    """Return what an argument is, in some lines."""
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
    """Start what a plan says; return the exit status of the first failure, or 0."""
    from aionode.launch import run_plan
    from aionode.runner import run
    from aionode.system import System, SystemLog

    _ = plan.steps  # whatever is wrong with the file is said before anything begins
    log = SystemLog(json=as_json, folder=log_folder)
    system = System(Path(plan.path).name.partition(".")[0], log=log)

    async def main() -> None:
        async with system:
            await run_plan(plan, system, watch=watch, once_ready=once_ready)

    run(main, args=[])
    return system.exit_status


def run_real(path: str, values: dict[str, str]) -> None:
    """Run ROS 2's launch in the place of this process.

    Raises:
        CommandError: It is not installed.
    """
    if not (is_installed("launch") and is_installed("launch_ros")):
        raise CommandError(
            "--real: ROS 2's launch and launch_ros are not installed here; source a ROS 2, or "
            "leave out --real: aionode has the names that most launch files use"
        )
    arguments = [f"{name}:={value}" for name, value in values.items()]
    become([sys.executable, "-m", "aionode.launch", str(Path(path)), *arguments])


def is_installed(package: str) -> bool:
    """Return whether a package is there that is not aionode's, which says so at its beginning."""
    spec = PathFinder.find_spec(package)
    if spec is None or spec.origin is None:
        return False
    text = Path(spec.origin).read_text(encoding="utf-8", errors="replace")
    return "aionode" not in text[:300]
