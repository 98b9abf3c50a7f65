"""The command line: ``aionode topic list``, with the words and the output of ``ros2``.

A noun's module is imported only when that noun is used, so help and completion answer quickly.

================ ==================================================================
part             contents
================ ==================================================================
``_main``        the main program: the nouns, and errors in one line
``_nouns``       for each noun, its commands: each with its verb, a coroutine
``_support``     what nouns share: declaring commands, lookups, output, sessions
================ ==================================================================
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["main"]


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status.

    Without `argv` the process is the command, and ends with it: at once, or by its deadline while
    Zenoh still waits for a peer. With `argv` the process belongs to its program: nothing ends it,
    and closing takes as long as Zenoh does.

    Args:
        argv: The arguments without the program name; default: those of the process.
    """
    is_run = sys.argv[1:2] == ["run"]  # whose program gets arguments of its own
    try:
        # Imported here so that Ctrl-C during the import leaves no traceback either.
        from aionode.cli import _main

        status = _main.main(argv)
        # Only as the process's main program; after `run`, remaining threads are the user's.
        # Otherwise Python would wait for threads and run exit handlers, after the answer.
        if argv is None and not is_run:
            from aionode.cli._support.exit import leave

            leave(status)
    except KeyboardInterrupt:
        return 130  # the status by which shells know Ctrl-C
    else:
        return status
