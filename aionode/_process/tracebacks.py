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
GENERATED = re.compile(r"<(snapshot of|encode|write|decode|read|construct) [\w/]+>")
"""How the functions are named that are generated for message types."""
STANDARD_LIBRARY = Path(os.__file__).parent


def is_whole() -> bool:
    """Return whether tracebacks show aionode's own lines: the environment asks for it."""
    return bool(os.environ.get(TRACEBACK_VARIABLE))


def traceback_text(error: BaseException) -> str:
    """Return the traceback of an exception, and of those that led to it, as Python prints it.

    Without aionode's own lines, unless `is_whole`, or unless nothing else would be left.
    """
    shown = traceback.TracebackException.from_exception(error)
    if not is_whole():
        hide_library(shown)
    return "".join(shown.format())


def hide_library(shown: traceback.TracebackException) -> None:
    """Take aionode's own lines out of a traceback, and out of those that belong to it."""
    kept = [line for line in shown.stack if not is_of_library(line.filename)]
    if kept:
        shown.stack[:] = kept
    parts = getattr(shown, "exceptions", None) or ()  # the members of a group
    for part in (shown.__cause__, shown.__context__, *parts):
        if part is not None:
            hide_library(part)


def is_of_library(filename: str) -> bool:
    """Whether a source file, or what takes its place, is aionode's own; examples are programs."""
    folders = Path(filename).parents
    is_own = LIBRARY in folders and EXAMPLES not in folders
    return is_own or GENERATED.fullmatch(filename) is not None


def is_of_user(frame: FrameType) -> bool:
    """Whether a frame belongs neither to aionode nor to Python's standard library."""
    filename = frame.f_code.co_filename
    path = Path(filename)
    installed = "site-packages" in path.parts
    generated = "__name__" not in frame.f_globals  # such as the validator of a message
    standard = STANDARD_LIBRARY in path.parents and not installed
    return not (generated or standard or is_of_library(filename))
