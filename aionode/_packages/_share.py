"""The share folder of a package, as its build rules would install it.

If the rules install a file at another place than in the source, a folder of links presents the
package's files in their installed places; nothing is copied or executed.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path, PurePosixPath
from typing import Final

from aionode._packages._cmake import MAX_FILES, Install, installs_of
from aionode._packages._setup_files import data_files

__all__ = ["share_of"]

Tree = dict[str, "Path | Tree"]
"""The contents of a folder by name: a file or folder to link to, or a nested tree."""

TEMPORARY: Final = ".aionode-"


@cache
def share_of(folder: Path, package: str) -> Path:
    """Return the share folder of a workspace package.

    That is its source folder, unless its setup.py, setup.cfg or CMakeLists.txt installs files below
    ``share/PACKAGE`` at other places than in the source. In that case it is a folder of links in
    the user's cache (XDG_CACHE_HOME), updated once per process.
    """
    moved = moved_files(folder, package)
    if not moved:
        return folder
    tree: Tree = {child.name: child for child in folder.iterdir() if child.name[0] != "."}
    for place, source in moved:
        put(tree, place.parts, source)
    name = hashlib.sha256(os.fsencode(folder)).hexdigest()[:16]
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    share = Path(home, "aionode", "share", name, package)
    try:
        show(tree, share)
    except OSError:  # no home, or it is read-only
        share = Path(tempfile.mkdtemp(prefix="aionode_share_"), package)
        show(tree, share)
    return share


def moved_files(folder: Path, package: str) -> list[tuple[PurePosixPath, Path]]:
    """Return the files whose place in the share folder differs from the source, by that place."""
    moved = []
    for rule in [*data_files(folder), *installs_of(folder, package)]:
        place = place_of(rule, package)
        if place is None or folder / place == rule.source or not rule.source.exists():
            continue
        moved.append((place, rule.source))
    return moved[:MAX_FILES]


def place_of(rule: Install, package: str) -> PurePosixPath | None:
    """Return where in the share folder a rule installs its file; None if elsewhere."""
    whole = PurePosixPath(os.path.normpath(PurePosixPath(rule.folder, rule.name)))
    share = PurePosixPath("share", package)
    return whole.relative_to(share) if whole.is_relative_to(share) else None


def put(tree: Tree, parts: tuple[str, ...], source: Path) -> None:
    """Put a file or folder into a tree, beside what the folder there already contains."""
    if parts and not (source.is_dir() and (parts[0] in tree or len(parts) > 1)):
        *folders, name = parts
        for part in folders:
            tree = inner_of(tree, part)
        if name not in tree or not source.is_dir():
            tree[name] = source
            return
        parts = (name,)
    for part in parts:
        tree = inner_of(tree, part)
    for child in source.iterdir():
        put(tree, (child.name,), child)


def inner_of(tree: Tree, name: str) -> Tree:
    """Return the subtree of a folder in a tree, for adding more to it."""
    inner = tree.get(name, {})
    if isinstance(inner, Path):
        inner = {child.name: child for child in inner.iterdir()} if inner.is_dir() else {}
    tree[name] = inner
    return inner


def show(tree: Tree, folder: Path) -> None:
    """Populate a folder with links for a tree; another process may do so at the same time."""
    folder.mkdir(parents=True, exist_ok=True)
    for entry in list(os.scandir(folder)):
        if entry.name not in tree and not entry.name.startswith(TEMPORARY):
            clear(Path(entry))
    for name, part in tree.items():
        place = folder / name
        if isinstance(part, dict):
            if place.is_symlink():
                clear(place)
            show(part, place)
        elif not (place.is_symlink() and place.readlink() == part):
            if place.is_dir() and not place.is_symlink():
                clear(place)
            link = folder / f"{TEMPORARY}{os.getpid()}-{name}"
            with suppress(FileExistsError):
                link.symlink_to(part)
            link.replace(place)


def clear(place: Path) -> None:
    """Remove a link, or a folder of links."""
    with suppress(FileNotFoundError):  # another process was faster
        if place.is_symlink():
            place.unlink()
        else:
            show({}, place)
            place.rmdir()
