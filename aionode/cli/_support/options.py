"""Options that several commands share."""

from __future__ import annotations

import contextlib
import math
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import click

__all__ = [
    "CommandT",
    "clear_full_length",
    "count_option",
    "csv_option",
    "filter_option",
    "hertz",
    "hidden_nodes_option",
    "hidden_option",
    "in_environment",
    "interfaces_option",
    "json_option",
    "name_interface_folders",
    "natural",
    "positive",
    "print_options",
    "read_values",
    "ros2_options",
    "seconds",
    "sim_time_option",
    "types_option",
    "verbose_option",
    "whole",
]

CommandT = TypeVar("CommandT", bound=Callable[..., Any])

json_option = click.option("--json", is_flag=True, help="Print one record per line, as JSON.")
verbose_option = click.option(
    "-v", "--verbose", is_flag=True, help="Print nodes, type hashes, GIDs and QoS too."
)

MAX_SECONDS = 1e9
"""Upper limit of durations in seconds: about thirty years, within the range of every clock."""

MOST = 2**31 - 1
"""Upper limit of counts; fits every queue length."""


class Number(click.FloatRange):
    """A float range that excludes ``nan``, which click accepts in every range."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return the number; fail if it is ``nan`` or out of range."""
        number: float = super().convert(value, param, ctx)
        if math.isnan(number):
            self.fail(f"{value!r} is not a number.", param, ctx)
        return number


positive = Number(min=0, min_open=True, max=MAX_SECONDS)
"""A number of seconds above zero."""

seconds = Number(min=0, max=MAX_SECONDS)
"""A number of seconds."""

hertz = Number(min=1 / MAX_SECONDS, max=1e9)
"""A rate whose period is within the range of every clock."""

natural = click.IntRange(min=1, max=MOST)
"""A count of at least one."""

whole = click.IntRange(min=0, max=MOST)
"""A count, possibly zero."""

types_option = click.option(
    "-t", "--show-types", "types", is_flag=True, help="Print the types too."
)

hidden_nodes_option = click.option(
    "-a", "--all", "hidden", is_flag=True, help="List hidden nodes as well."
)


def count_option(what: str) -> Callable[[CommandT], CommandT]:
    """Return the option that prints only the number of `what`."""
    return click.option(
        "-c", f"--count-{what}", "count", is_flag=True, help="Print only the count."
    )


def hidden_option(*names: str, what: str) -> Callable[[CommandT], CommandT]:
    """Return the option that includes hidden `what`."""
    return click.option(*names, "hidden", is_flag=True, help=f"Consider hidden {what} as well.")


def filter_option(does: str) -> Callable[[CommandT], CommandT]:
    """Return the option for a Python expression that is evaluated for each message."""
    return click.option(
        "--filter",
        "filter_text",
        metavar="EXPR",
        help=f"{does} only messages for which this Python expression is true (m: the message).",
    )


def ros2_options(command: CommandT) -> CommandT:
    """Accept ros2's options that have no meaning here, so that existing scripts run."""
    for name in ("--no-daemon", "--spin-time"):
        is_flag = name == "--no-daemon"
        command = click.option(name, hidden=True, is_flag=is_flag, expose_value=False)(command)
    return command


sim_time_option = click.option(
    "-s", "--use-sim-time", is_flag=True, help="Use the time of /clock (simulated time)."
)


# Interfaces


def interfaces_option(command: CommandT) -> CommandT:
    """Add the option for folders of interface definitions."""
    return click.option(
        "--interfaces",
        metavar="PATH",
        multiple=True,
        envvar="AIONODE_INTERFACES",
        type=click.Path(exists=True, file_okay=False, path_type=Path),
        expose_value=False,
        callback=name_interface_folders,
        help="Folder with your own .msg, .srv, .action and .idl files; also $AIONODE_INTERFACES. "
        "The workspace around the current folder is searched anyway.",
    )(command)


def name_interface_folders(
    ctx: click.Context, param: click.Parameter, value: tuple[Path, ...]
) -> None:
    """Make the interfaces of the given folders known to this process and its children."""
    if value:
        folders = os.pathsep.join(str(path.absolute()) for path in value)
        ctx.with_resource(in_environment("AIONODE_INTERFACES", folders))


@contextlib.contextmanager
def in_environment(name: str, value: str) -> Iterator[None]:
    """Set an environment variable while a command runs: the program may run other commands."""
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


def read_values(options: dict[str, Any]) -> None:
    """Replace ``stdin`` and ``values`` in `options` by the given values, read from stdin if asked.

    Raises:
        click.UsageError: values and ``--stdin`` were both given.
    """
    stdin, values = options.pop("stdin"), options["values"]
    if stdin and values is not None:
        raise click.UsageError("Give the values or --stdin, not both.")
    if stdin:
        options["values"] = sys.stdin.read()
    elif values is None:
        options["values"] = "{}"


# Printing messages

csv_option = click.option(
    "--csv", is_flag=True, help="Print all values on one line, separated by commas."
)

print_options = (
    click.option("-f", "--full-length", is_flag=True, help="Print arrays and strings in full."),
    click.option(
        "-l",
        "--truncate-length",
        metavar="N",
        type=whole,
        default=128,
        show_default=True,
        help="Print arrays and strings up to this length.",
    ),
    click.option("--no-arr", is_flag=True, help="Describe arrays instead of printing them."),
    click.option("--no-str", is_flag=True, help="Describe strings instead of printing them."),
    click.option("--flow-style", is_flag=True, help="Print each array in brackets, on one line."),
)


def clear_full_length(options: dict[str, Any]) -> None:
    """Replace ``full_length`` in `options` by a ``truncate_length`` of None."""
    if options.pop("full_length"):
        options["truncate_length"] = None
