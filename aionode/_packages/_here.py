"""The workspace of this process, whose packages its program finds without a build."""

from __future__ import annotations

import re
import sys
import sysconfig
from functools import cache
from pathlib import Path

from aionode._packages._packages import Packages
from aionode._packages._workspace import workspace_of

__all__ = ["around", "here", "package_of_stand_in", "stand_in", "use", "use_stand_ins"]

GIVEN: list[Path] = []
"""The explicitly chosen workspace, if any."""

NOWHERE = Path("/package-not-found")
"""The parent of stand-ins for folders of packages; it does not exist."""

STAND_INS: list[bool] = [False]
"""Whether a missing package gets a stand-in for its folder."""

TOOLS = (
    Path(__file__).parents[1],
    *(Path(sysconfig.get_path(each)) for each in ("scripts", "purelib", "platlib", "stdlib")),
)
"""The folder of tools such as pytest and aionode's command, which work on the current folder."""


def use(folder: str | Path) -> None:
    """Set the workspace of this process.

    Raises:
        FileNotFoundError: There is no such folder.
    """
    Packages(Path(folder))  # rejects what is not a folder, before anything runs
    GIVEN[:] = [Path(folder)]


def use_stand_ins(*, wanted: bool) -> None:
    """Set whether a missing package gets a stand-in for its folder.

    A launch file looks up package folders at its top, but may not start anything from them.
    """
    STAND_INS[:] = [wanted]


def stand_in(package: str) -> Path | None:
    """Return the stand-in for the folder of a missing package, if enabled."""
    return NOWHERE / package if STAND_INS[0] else None


def package_of_stand_in(text: str) -> str | None:
    """Return the package whose stand-in a text contains, if any."""
    match = re.search(rf"{NOWHERE}/([\w-]+)", text)
    return None if match is None else match[1]


def here() -> Packages:
    """Return the packages of the workspace and the installed ones.

    The workspace is the one that was chosen, or else the one around the program. For an installed
    tool, or if there is no program file, it is the one around the current folder.
    """
    name = getattr(sys.modules.get("__main__"), "__file__", None)
    return around(Path.cwd() if name is None or is_tool(Path(name)) else Path(name))


def is_tool(program: Path) -> bool:
    """Return whether a program is installed with Python or is one of aionode's."""
    return any(program.absolute().is_relative_to(folder) for folder in TOOLS)


def around(place: Path) -> Packages:
    """Return the packages of the chosen workspace, or else of the one around a path."""
    return Packages(*GIVEN) if GIVEN else looked_up(place)


@cache
def looked_up(place: Path) -> Packages:
    """Find the packages of the workspace around a path."""
    return Packages(workspace_of(place))
