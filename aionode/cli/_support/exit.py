"""The end of the process: its exit status, and leaving without any wait."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import TYPE_CHECKING

from aionode._streams import accepts

if TYPE_CHECKING:
    from aionode.errors import AionodeError

__all__ = ["INTERRUPTED", "leave", "status_of"]

INTERRUPTED = 130
"""The exit status of a program that Ctrl-C interrupted, by the convention of shells."""


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
