"""The workspace of this process: the packages that its program finds without a build."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

from aionode._packages import Packages, workspace_of

__all__ = ["around", "here", "use"]

GIVEN: list[Path] = []
"""The workspace that was named, if one was."""

STARTER = Path(__file__).parent / "__main__.py"
"""The program of this process until the file or module that it starts has taken that place."""


def use(folder: str | Path) -> None:
    """Take a folder for the workspace of this process.

    Raises:
        FileNotFoundError: There is no such folder.
    """
    Packages(Path(folder))  # refuses what is no folder, before anything runs
    GIVEN[:] = [Path(folder)]


def here() -> Packages:
    """Return the packages of the workspace, and the installed ones.

    The workspace is the one that was named, or else the one around the program. Before a module
    runs, and where there is no program's file, it is the one around the current folder.
    """
    name = getattr(sys.modules.get("__main__"), "__file__", None)
    return around(Path.cwd() if name is None or Path(name) == STARTER else Path(name))


def around(place: Path) -> Packages:
    """Return the packages of the workspace that was named, or else of the one around a place."""
    return Packages(*GIVEN) if GIVEN else looked_up(place)


@cache
def looked_up(place: Path) -> Packages:
    """Return the packages of the workspace around a place."""
    return Packages(workspace_of(place))
