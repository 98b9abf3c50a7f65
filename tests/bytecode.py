"""Compiled code that all processes of the tests share."""

from __future__ import annotations

import os
import sys
from pathlib import Path

__all__ = ["share_bytecode"]


def share_bytecode() -> None:
    """Have this process and its children keep compiled code, even where Python is told not to.

    Hundreds of processes would each compile aionode, for a second of processor time. What they
    share is not written beside the sources then.
    """
    if sys.dont_write_bytecode:
        sys.dont_write_bytecode = False
        sys.pycache_prefix = str(Path(__file__).parent.parent / ".pytest_cache" / "bytecode")
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix
