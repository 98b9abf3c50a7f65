"""The command line: ``aionode topic list``, with the words and the output of ``ros2``.

Each noun's module is imported only when it is used, so help and completion stay fast.

================ ==================================================================
part             contents
================ ==================================================================
``_main``        the main program: the list of nouns, and errors as one line
``_nouns``       one module per noun, with its commands and their verbs (coroutines)
``_support``     shared by the nouns: declaring commands, lookups, output, sessions
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

    Without `argv`, the process is the command and ends with it: immediately, or at its deadline if
    Zenoh is still waiting for a peer. With `argv`, the process belongs to the caller's program:
    nothing ends it, and closing takes as long as Zenoh needs.

    Args:
        argv: The arguments without the program name; defaults to those of the process.
    """
    is_run = argv is None and sys.argv[1:2] == ["run"]
    try:
        # Imported here so that Ctrl-C during the import leaves no traceback either.
        if is_run:
            from aionode.cli._support.programs import module_of

            module = module_of(sys.argv[2:])
        else:
            module = None
        if module is None:
            from aionode._process.imports import uncollected

            with uncollected():
                from aionode.cli import _main
            status = _main.main(argv)
            # Only if this is the process's main program, and not after `run`, whose threads are the
            # user's: otherwise Python would wait for threads and exit handlers after the answer is
            # printed.
            if argv is None and not is_run:
                from aionode.cli._support.exit import leave

                leave(status)
            return status
    except KeyboardInterrupt:
        return 130  # the exit status that shells use for Ctrl-C
    execute(*module)
    return 0


def execute(module: str, *arguments: str) -> None:
    """Run a module in this process like ``python -m`` in a new one."""
    import runpy

    sys.argv[1:] = arguments
    if not sys.flags.safe_path:
        sys.path[0] = ""  # the current folder
    runpy.run_module(module, run_name="__main__")
