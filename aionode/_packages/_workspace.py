"""Finds the packages of a workspace, which have a ``package.xml``, and other Python projects."""

from __future__ import annotations

import os
import re
from collections import deque
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from aionode._packages._setup_files import SETUP_FILES

__all__ = ["MANIFEST", "MAX_FOLDERS", "Sources", "package_folder", "sources_in", "workspace_of"]

MANIFEST: Final = "package.xml"

MAX_DEPTH: Final = 6
"""How many folders deep below the workspace packages are searched for."""

MAX_FOLDERS: Final = 10_000
"""Maximum folders that are searched: a workspace has some hundreds, a home folder any number."""

IGNORED: Final = frozenset({"COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE", "pyvenv.cfg"})
"""ROS's tools ignore a folder with one of the first three files, and everything below it; the last
is that of a virtual environment, whose packages are installed or not.
"""

BUILT: Final = frozenset({"build", "install", "log", "node_modules", "__pycache__"})
"""Folders that contain copies of packages, or no packages."""

NAME: Final = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


class Sources(NamedTuple):
    """What a workspace contains.

    Attributes:
        packages: The folders of ROS packages, by name.
        projects: The folders with setup files of Python that are not within a ROS package.
    """

    packages: dict[str, Path]
    projects: list[Path]


def package_folder(place: Path) -> Path | None:
    """Return the package folder that contains a file or folder, if any."""
    place = place.resolve()
    folders = (folder for folder in (place, *place.parents) if (folder / MANIFEST).is_file())
    return next(folders, None)


def workspace_of(place: Path) -> Path | None:
    """Return the workspace of a file or folder, if there is one.

    That is a folder ``src`` in it or around it, else the repository around it, else the package
    that contains it.
    """
    place = place.resolve()
    if place.is_file():
        place = place.parent
    own = package_folder(place)
    if own is None and (place / "src").is_dir():
        return place / "src"
    start = own or place
    around = (start, *start.parents)
    sources = next((folder for folder in around if folder.name == "src"), None)
    return sources or next((folder for folder in around if (folder / ".git").exists()), own)


@cache
def sources_in(workspace: Path) -> Sources:
    """Return the packages and projects below a folder, or that folder itself.

    As with ROS's tools, a package cannot contain another one. Of two packages with one name, the
    one in the outermost folder counts, then the first by folder name. A project may contain others,
    and if the workspace is a folder ``src``, it may be that of the project around it. The result is
    cached for the life of the process.
    """
    found = Sources({}, [])
    if workspace.name == "src" and not SETUP_FILES.isdisjoint(content(workspace.parent)[0]):
        found.projects.append(workspace.parent)
    waiting = deque([(workspace, 0)])
    for _ in range(MAX_FOLDERS):
        if not waiting:
            break
        folder, depth = waiting.popleft()
        files, folders = content(folder)
        if not IGNORED.isdisjoint(files):
            continue
        if MANIFEST in files:
            found.packages.setdefault(package_name(folder), folder)
            continue
        if not SETUP_FILES.isdisjoint(files):
            found.projects.append(folder)
        if depth < MAX_DEPTH:
            waiting.extend((folder / name, depth + 1) for name in folders)
    return found


def content(folder: Path) -> tuple[set[str], list[str]]:
    """Return the names of the files in a folder, and of the folders that may hold packages."""
    files: set[str] = set()
    folders: list[str] = []
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                if not is_folder(entry):
                    files.add(entry.name)
                elif not entry.name.startswith(".") and entry.name not in BUILT:
                    folders.append(entry.name)
    except OSError:  # an unreadable folder has no packages for this user
        return set(), []
    return files, sorted(folders)


def is_folder(entry: os.DirEntry[str]) -> bool:
    """Return whether an entry is a folder, or a link to one that can be reached."""
    try:
        return entry.is_dir()
    except OSError:  # a link to itself, or into a folder of another user
        return False


def package_name(folder: Path) -> str:
    """Return the name in the ``package.xml`` of a folder, or else the folder's name."""
    try:
        text = (folder / MANIFEST).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return folder.name
    match = NAME.search(text)
    return match[1] if match else folder.name


def package_of(file: Path) -> str | None:
    """Return the name of the package whose source folder contains a file, if one does."""
    folder = package_folder(file)
    return None if folder is None else package_name(folder)
