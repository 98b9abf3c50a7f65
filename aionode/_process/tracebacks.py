"""Tracebacks for users: the lines of their program, without those of aionode."""

from __future__ import annotations

import os
import re
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import FrameType

__all__ = ["TRACEBACK_VARIABLE", "is_of_user", "is_whole", "traceback_text"]

TRACEBACK_VARIABLE = "AIONODE_TRACEBACK"
"""If set to anything, aionode's own lines are shown as well."""

LIBRARY = Path(__file__).parents[1]
EXAMPLES = LIBRARY / "examples"
GENERATED = r"<(snapshot of|encode|write|decode|read|construct) [\w/]+>"
"""The names of functions generated for message types."""
STANDARD_LIBRARY = Path(os.__file__).parent


def is_whole() -> bool:
    """Return whether the environment asks for aionode's own lines in tracebacks."""
    return bool(os.environ.get(TRACEBACK_VARIABLE))


def traceback_text(error: BaseException) -> str:
    """Format the traceback of an exception, and of those that led to it, like Python.

    It omits aionode's own lines, unless `is_whole` or nothing else would be left.
    """
    shown = traceback.TracebackException.from_exception(error)
    if not is_whole():
        hide_library(shown)
    return "".join(shown.format())


def hide_library(shown: traceback.TracebackException) -> None:
    """Remove aionode's own lines from a traceback and its related ones."""
    kept = [line for line in shown.stack if not is_of_library(line.filename)]
    if kept:
        shown.stack[:] = kept
    parts = getattr(shown, "exceptions", None) or ()  # the members of a group
    for part in (shown.__cause__, shown.__context__, *parts):
        if part is not None:
            hide_library(part)


def is_of_library(filename: str) -> bool:
    """Return whether a source file, or what takes its place, is aionode's own; examples are not."""
    folders = Path(filename).parents
    is_own = LIBRARY in folders and EXAMPLES not in folders
    return is_own or re.fullmatch(GENERATED, filename) is not None


def is_of_user(frame: FrameType) -> bool:
    """Return whether a frame belongs neither to aionode nor to Python's standard library."""
    filename = frame.f_code.co_filename
    path = Path(filename)
    installed = "site-packages" in path.parts
    generated = "__name__" not in frame.f_globals  # such as the validator of a message
    standard = STANDARD_LIBRARY in path.parents and not installed
    return not (generated or standard or is_of_library(filename))
