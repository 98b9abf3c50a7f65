"""The command line: ``aionode topic list``, with the words and the output of ``ros2``.

One module for each noun, imported when that noun is used, so that help and completion answer at
once. In it each verb is a coroutine with plain arguments, and beside it the declaration of the
command that parses them: the coroutine is what tests call, and what a program may call.

====================== =============================================================
module                 what is in it
====================== =============================================================
`command`              groups that import late, errors in one line, the main program
`session`              a node for a command, signals, the exit status
`ending`               an end at the promised time
`output`               what a command prints: text for people, ``--json`` for programs
`options`              options that several commands share
`completing`           names for the shell to complete
`lookup`               names on the network and their types
`text`                 messages and endpoints as text
one for each noun      its commands, and its verbs where those are short
====================== =============================================================

Where verbs have modules of their own, these are `topics`, `echo`, `pub` and `measure` for topics,
`parameters` and `diagnosis`.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["main"]


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status.

    Args:
        argv: The arguments without the name of the program; those of the process without it.
    """
    try:
        # Imported here, so that Ctrl-C in the first moment leaves no traceback.
        from aionode.cli import _main as command

        status = command.main(argv)
        # As the process's own main program. The threads of nodes that were run are the user's.
        if argv is None and sys.argv[1:2] != ["run"]:
            from aionode.cli._support.ending import leave_if_busy

            leave_if_busy(status)
    except KeyboardInterrupt:
        return 130  # what shells know as ended by Ctrl-C
    else:
        return status
