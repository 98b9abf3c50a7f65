"""The main program: its nouns, and how their errors are reported.

Click is the only large import here; a noun's module is imported only when it is used.
"""

from __future__ import annotations

import errno
import importlib
import io
import sys
from typing import TYPE_CHECKING, Any

import click

from aionode._process.imports import uncollected
from aionode._process.streams import discard, open_missing
from aionode.cli._support.error_text import limited, one_line
from aionode.cli._support.exit import INTERRUPTED, OWN_PROCESS, status_of
from aionode.cli._support.options import in_environment
from aionode.cli._support.output import unwritable
from aionode.errors import AionodeError

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["LateGroup", "main", "report", "root"]

NOUNS = {
    "action": "Send goals; list and inspect actions.",
    "bag": "Record, play, inspect, repair and compare bags.",
    "completion": "Print the completion script of a shell.",
    "deploy": "Copy a workspace to a robot, where systemd runs it.",
    "doctor": "Find out why endpoints do not communicate.",
    "gateway": "Serve the robot to browsers, programs and apps.",
    "graph": "Draw nodes and what they share; show what does not match.",
    "interface": "Show message, service and action types.",
    "launch": "Start the processes and nodes of a launch file.",
    "learn": "Turn demonstrations into data sets for robot learning.",
    "lifecycle": "Show and change the states of managed nodes.",
    "mcp": "Let a language model's program use the robot.",
    "new": "Write a package with a node, a message and a test.",
    "node": "List and inspect nodes.",
    "param": "Read and set the parameters of nodes.",
    "pkg": "List packages and what they can start.",
    "router": "Connect machines, as rmw_zenohd does.",
    "run": "Run node classes together in one process.",
    "service": "List, find and call services.",
    "system": "Show what runs in a system; stop and restart its members.",
    "teleop": "Drive a robot from the keyboard.",
    "tf": "Show and publish transforms between frames.",
    "top": "Show what all processes of a robot do.",
    "topic": "List, print, publish and measure topics.",
    "trace": "Record what all processes do, callback by callback.",
    "why": "Show what led to the latest message of a topic.",
}
"""One line of help per noun; the noun's module holds its command, e.g. ``topic_command``."""

UNWRITABLE = {
    getattr(errno, name, errno.EIO) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO", "EBADF")
}
"""Errors of writing to a file or terminal that accepts no more data."""


class LateGroup(click.Group):
    """The top-level group, which imports a noun when it is used."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the nouns."""
        return list(NOUNS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a noun and return its command."""
        if cmd_name not in NOUNS:
            return None
        with uncollected():
            module = importlib.import_module(f"aionode.cli._nouns.{cmd_name}")
        command: click.Command = getattr(module, f"{cmd_name}_command")
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the named command; the error for an unknown name suggests a similar one.

        Click's own lookup would only search commands that are already imported.
        """
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            import difflib  # only for an error text

            close = difflib.get_close_matches(args[0], self.list_commands(ctx), 1)
            if close and args[0] not in self.list_commands(ctx):
                text = f"No such command '{args[0]}'. Did you mean '{close[0]}'?"
                raise click.UsageError(text, ctx) from error
            raise

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; end quietly when the reader of its output goes away."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            discard(sys.stdout)
            ctx.exit(0)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(NOUNS.items()))


@click.group(
    cls=LateGroup,
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
@click.pass_context
def root(ctx: click.Context, transport: str | None) -> None:
    """Inspect and use nodes, topics, services, parameters and actions.

    Commands, options and output are those of ros2. Every command that prints data has --json, which
    prints one record per line. There is no daemon: every answer is current.
    """
    if transport is not None:
        ctx.with_resource(in_environment("AIONODE_TRANSPORT", transport))


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status.

    Errors are printed as one line on stderr. When the reader of the output goes away (``head``),
    the command ends quietly; a full disk is an error.

    Args:
        argv: The arguments without the program name; defaults to those of the process.
    """
    open_missing()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # Print characters that the stream cannot encode as escapes instead of raising.
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
    """Run the command line, report any error, and return the exit status."""
    process = OWN_PROCESS if argv is None else None
    try:
        status = root.main(args=argv, prog_name="aionode", standalone_mode=False, obj=process)
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
    except (OSError, ModuleNotFoundError) as error:
        return report(system_text(error), 1)
    return status if isinstance(status, int) else 0


def system_text(error: OSError | ModuleNotFoundError) -> str:
    """Return the message for an error that is not aionode's own; re-raise it if it is a bug."""
    if isinstance(error, ModuleNotFoundError):
        if "pip install 'aionode[" not in str(error):
            raise error
        return str(error)
    if error.errno not in UNWRITABLE:
        raise error
    discard(sys.stdout)
    return unwritable(error)  # written by click: help, completion scripts


def report(text: str, status: int) -> int:
    """Print an error, if stderr can be written to, and return the exit status."""
    try:
        sys.stderr.write(f"{text}\n")
        sys.stderr.flush()
    except OSError:
        discard(sys.stderr)
    return status


def usage_text(error: click.UsageError) -> str:
    """Return one line that says what is wrong with the arguments and where to find help."""
    where = error.ctx.command_path if error.ctx is not None else "aionode"
    problem = limited(" ".join(error.format_message().split()))
    return f"{where}: {problem} See '{where} --help'."
