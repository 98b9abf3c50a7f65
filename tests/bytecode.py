"""Compiled code that all processes of the tests share."""

from __future__ import annotations

import os
import sys

__all__ = ["share_bytecode"]


def share_bytecode() -> None:
    """Have this process and its children keep compiled code, even where Python is told not to.

    Hundreds of processes would each compile aionode, for a second of processor time. It is kept
    where Python looks for that of installed packages, too: elsewhere these would be compiled anew.
    """
    sys.dont_write_bytecode = False
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
