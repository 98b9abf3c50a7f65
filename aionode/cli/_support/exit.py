"""Ending the process: its exit status, leaving without waiting, and replacing it by a program.

A process that merely called `main([...])` belongs to its own program, so it is neither ended nor
replaced.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from typing import TYPE_CHECKING, Final, NoReturn

import click

from aionode._process.streams import accepts
from aionode._process.temporary import remove_temporary_folders

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.errors import AionodeError

__all__ = ["INTERRUPTED", "OWN_PROCESS", "become", "leave", "owns_process", "status_of"]

INTERRUPTED = 130
"""The exit status of a program interrupted by Ctrl-C, by shell convention."""

OWN_PROCESS: Final = "own process"
"""The ``obj`` of click's root context if the process is the command."""


def owns_process() -> bool:
    """Return whether the process is the command, and not a program that called `main([...])`."""
    ctx = click.get_current_context(silent=True)
    return ctx is not None and ctx.find_root().obj == OWN_PROCESS


def status_of(error: AionodeError) -> int:
    """Return the exit status for an error."""
    status: int = getattr(error, "status", 1)
    return status


def leave(status: int, text: str = "") -> None:
    """Exit immediately, without waiting for threads or exit handlers.

    Temporary folders are removed, as an exit handler would do.

    Output has already been flushed; flushing again could block on its reader.
    """
    if text and accepts(sys.stderr.fileno()):
        with contextlib.suppress(OSError):
            os.write(sys.stderr.fileno(), text.encode(errors="backslashreplace"))
    remove_temporary_folders()
    os._exit(status)


def become(command: Sequence[str]) -> NoReturn:
    """Replace this process by a command, so that signals reach the command itself.

    Raises:
        click.exceptions.Exit: the command has ended, where it cannot replace the process: on
            Windows, and inside another program.
    """
    if sys.platform != "win32" and owns_process():
        os.execv(command[0], list(command))  # noqa: S606 (the user's program)
    status = subprocess.run(command, check=False).returncode  # noqa: S603 (the same)
    raise click.exceptions.Exit(status if status >= 0 else 128 - status)
