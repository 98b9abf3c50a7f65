"""Runs a program, and writes one byte to a file descriptor as soon as one of its nodes runs.

``python tests/support/announcing.py 5 examples/talker.py …``: when a test has read that byte,
signals are handled, so it needs no sleep.
"""

from __future__ import annotations

import os
import runpy
import sys

from aionode import Node


def main() -> None:
    """Run the program that the arguments name: a file, or ``-m`` and a module."""
    descriptor = int(sys.argv[1])
    enter = Node.__aenter__

    async def enter_and_announce(self: Node) -> Node:
        await enter(self)
        os.write(descriptor, b".")
        return self

    Node.__aenter__ = enter_and_announce  # type: ignore[assignment, method-assign]  # Self
    sys.argv = sys.argv[2:]
    if sys.argv[0] == "-m":
        sys.argv = sys.argv[1:]
        runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
    else:
        sys.path.insert(0, os.path.dirname(sys.argv[0]))  # noqa: PTH120 - as Python does it
        runpy.run_path(sys.argv[0], run_name="__main__")


if __name__ == "__main__":
    main()
