"""The command line: ``aionode topic list``, with the words and the output of ``ros2``.

One module for each noun, imported when that noun is used, so that help and completion answer at
once. In it each verb is a coroutine with plain arguments, and beside it the declaration of the
command that parses them: the coroutine is what tests call, and what a program may call.

====================== =============================================================
module                 what is in it
====================== =============================================================
`command`              groups that import late, errors in one line, the main program
`session`              a node for a command, signals, the exit status
`output`               what a command prints: text for people, ``--json`` for programs
`options`              options that several commands share
`completing`           names for the shell to complete
`lookup`               names on the network and their types
`text`                 messages and endpoints as text
one for each noun      its verbs
====================== =============================================================
"""

from aionode.cli.command import main

__all__ = ["main"]
