"""The end of the process: its exit status, leaving without any wait, and giving it to a program.

A process that only called `main([...])` belongs to its own program, so it is neither left nor given
away.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from typing import TYPE_CHECKING, Final, NoReturn

import click

from aionode._process.streams import accepts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.errors import AionodeError

__all__ = ["INTERRUPTED", "OWN_PROCESS", "become", "leave", "owns_process", "status_of"]

INTERRUPTED = 130
"""The exit status of a program that Ctrl-C interrupted, by the convention of shells."""

OWN_PROCESS: Final = "own process"
"""The object of click's root context if the process is the command."""


def owns_process() -> bool:
    """Return whether the process is the command, and not a program that called `main([...])`."""
    ctx = click.get_current_context(silent=True)
    return ctx is not None and ctx.find_root().obj == OWN_PROCESS


def status_of(error: AionodeError) -> int:
    """Return the exit status for an error."""
    status: int = getattr(error, "status", 1)
    return status


def leave(status: int, text: str = "") -> None:
    """Exit at once, without waiting for threads or exit handlers.

    Output has been flushed already; flushing again could block on its reader.
    """
    if text and accepts(sys.stderr.fileno()):
        with contextlib.suppress(OSError):
            os.write(sys.stderr.fileno(), text.encode(errors="backslashreplace"))
    os._exit(status)


def become(command: Sequence[str]) -> NoReturn:
    """Run a command in the place of this process, so that signals reach the command itself.

    Raises:
        click.exceptions.Exit: The command has ended, where it cannot take the place of the process:
            on Windows, and in the process of another program.
    """
    if sys.platform != "win32" and owns_process():
        os.execv(command[0], list(command))  # noqa: S606 (the user's program)
    status = subprocess.run(command, check=False).returncode  # noqa: S603 (the same)
    raise click.exceptions.Exit(status if status >= 0 else 128 - status)
