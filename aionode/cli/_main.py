"""The main program: its nouns, and how their errors are reported.

Click is the only large import here; of the nouns, only the one that is used is imported.
"""

from __future__ import annotations

import difflib
import errno
import importlib
import io
import os
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from aionode._streams import discard, open_missing
from aionode.cli._support.error_text import limited, one_line, status_of
from aionode.cli._support.output import unwritable
from aionode.errors import AionodeError

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["LateGroup", "main", "report", "root"]

NOUNS = {
    "action": (
        "aionode.cli._commands.action:action",
        "Send goals; list and inspect actions.",
    ),
    "completion": (
        "aionode.cli._commands.completion:completion",
        "Print the completion script of a shell.",
    ),
    "doctor": (
        "aionode.cli._commands.doctor:doctor_command",
        "Find out why endpoints do not communicate.",
    ),
    "interface": (
        "aionode.cli._commands.interface:interface",
        "Show message, service and action types.",
    ),
    "lifecycle": (
        "aionode.cli._commands.lifecycle:lifecycle",
        "Show and change the states of managed nodes.",
    ),
    "node": ("aionode.cli._commands.node:node", "List and inspect nodes."),
    "param": ("aionode.cli._commands.param:param", "Read and set the parameters of nodes."),
    "router": (
        "aionode.cli._commands.router:router_command",
        "Connect machines, as rmw_zenohd does.",
    ),
    "run": ("aionode.cli._commands.run:run_command", "Run node classes together in one process."),
    "service": ("aionode.cli._commands.service:service", "List, find and call services."),
    "topic": ("aionode.cli._commands.topic:topic", "List, print, publish and measure topics."),
}

UNWRITABLE = {
    getattr(errno, name, errno.EIO) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO", "EBADF")
}
"""The errors of writing to a file or terminal that accepts no more data."""

INTERRUPTED = 130
"""The exit status of a program that Ctrl-C interrupted, by the convention of shells."""


class LateGroup(click.Group):
    """A group whose commands are imported when they are used.

    Args:
        late: For each command, its location (``module:attribute``) and one line of help.
    """

    def __init__(self, *args: Any, late: Mapping[str, tuple[str, str]], **options: Any) -> None:
        super().__init__(*args, **options)
        self.late = late

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands."""
        return [*super().list_commands(ctx), *self.late]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, importing it."""
        if cmd_name not in self.late:
            return super().get_command(ctx, cmd_name)
        module, _, attribute = self.late[cmd_name][0].partition(":")
        command: click.Command = getattr(importlib.import_module(module), attribute)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the named command; the error for an unknown one suggests a similar name.

        Click itself searches only the commands that are already imported.
        """
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            close = difflib.get_close_matches(args[0], self.list_commands(ctx), 1)
            if close and args[0] not in self.list_commands(ctx):
                text = f"No such command '{args[0]}'. Did you mean '{close[0]}'?"
                raise click.UsageError(text, ctx) from error
            raise

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; it ends quietly when the reader of its output goes away."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            discard(sys.stdout)
            ctx.exit(0)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in self.late.items()])


@click.group(
    cls=LateGroup,
    late=NOUNS,
    name="aionode",
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.version_option(package_name="aionode", prog_name="aionode")
@click.option(
    "--transport",
    type=click.Choice(["zenoh", "rcl"]),
    help="How to reach other nodes: rmw_zenoh's format, or the ROS 2 that is installed (rcl, over "
    "DDS); also $AIONODE_TRANSPORT.",
)
def root(transport: str | None) -> None:
    """Inspect and use nodes, topics, services, parameters and actions.

    Commands, options and output are those of ros2. Every command that prints data has --json, which
    prints one record per line. There is no daemon: every answer is current.
    """
    if transport is not None:
        os.environ["AIONODE_TRANSPORT"] = transport


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status.

    Errors are one line on stderr. When the reader goes away, as ``head`` does, the command
    ends quietly; a full disk is an error.

    Args:
        argv: The arguments without the program name; default: those of the process.
    """
    open_missing()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # Characters that the stream cannot encode are printed as escapes, not raised.
            stream.reconfigure(errors="backslashreplace")
    status = run(argv)
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        discard(sys.stdout)
    except OSError as error:
        discard(sys.stdout)
        return report(unwritable(error), 1)
    return status


def run(argv: Sequence[str] | None) -> int:
    """Run the command line, report an error, and return the exit status."""
    try:
        status = root.main(args=argv, prog_name="aionode", standalone_mode=False)
    except click.exceptions.NoArgsIsHelpError as error:
        sys.stdout.write(f"{error.format_message()}\n")
        return 0
    except click.UsageError as error:
        return report(usage_text(error), error.exit_code)
    except click.ClickException as error:
        return report(error.format_message(), error.exit_code)
    except (click.Abort, KeyboardInterrupt):
        return INTERRUPTED
    except AionodeError as error:
        return report(one_line(error), status_of(error))
    except OSError as error:
        if error.errno not in UNWRITABLE:
            raise
        discard(sys.stdout)
        return report(unwritable(error), 1)  # written by click: help, completion scripts
    return status if isinstance(status, int) else 0


def report(text: str, status: int) -> int:
    """Print an error, if stderr can be written to, and return the exit status."""
    try:
        sys.stderr.write(f"{text}\n")
        sys.stderr.flush()
    except OSError:
        discard(sys.stderr)
    return status


def usage_text(error: click.UsageError) -> str:
    """Return in one line what is wrong with the arguments, and which help describes them."""
    where = error.ctx.command_path if error.ctx is not None else "aionode"
    problem = limited(" ".join(error.format_message().split()))
    return f"{where}: {problem} See '{where} --help'."
