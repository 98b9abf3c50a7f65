"""Finds the definitions of interfaces: aionode's, those of folders given, and those installed."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any, Final

from aionode.errors import InterfaceNotFoundError
from aionode.interfaces import get_interface, interface_names, shipped_packages
from aionode.rclpy._ament_index_python import get_search_paths

__all__ = ["KINDS", "add_folder", "find", "has_interfaces", "names_in", "share_folder"]

KINDS: Final = ("msg", "srv", "action")

FOREIGN_TYPE: Final = re.compile(r"^\s*([a-z][a-z0-9_]*)/[A-Z]", re.MULTILINE)
"""A field whose type is of another package."""

FOUND: dict[str, type[Any]] = {}
"""The types of folders and installed packages, as aionode's classes, by ROS name."""

ASKED: set[str] = set()
"""The packages that were searched for among the installed ones."""


def add_folder(path: str | Path) -> None:
    """Add the interfaces of a folder: a package, or a folder of packages.

    Raises:
        IdlError: A definition is not valid.
        FileNotFoundError: The folder does not exist.
    """
    from aionode.idl import load_interfaces  # parsers, which few programs need

    FOUND.update(load_interfaces(path))


def find(name: str) -> type[Any]:
    """Return aionode's class of a type, by its ROS name.

    Raises:
        InterfaceNotFoundError: There is no such type.
        IdlError: Its definition is not valid.
    """
    if name in FOUND:
        return FOUND[name]
    try:
        return get_interface(name)
    except InterfaceNotFoundError:
        load_installed(name.partition("/")[0])
        if name in FOUND:
            return FOUND[name]
        return get_interface(name)


def share_folder(package: str) -> Path | None:
    """Return the share folder of an installed package that defines interfaces."""
    try:
        prefixes = get_search_paths()
    except OSError:
        return None
    for prefix in prefixes:
        folder = Path(prefix, "share", package)
        if any((folder / kind).is_dir() for kind in KINDS):
            return folder
    return None


def load_installed(package: str) -> None:
    """Load an installed package, after those whose types it uses."""
    if package in ASKED or not package.isidentifier():
        return
    ASKED.add(package)
    folder = share_folder(package)
    if folder is None:
        return
    for kind in KINDS:
        for file in folder.glob(f"{kind}/*.{kind}"):
            text = file.read_text(encoding="utf-8", errors="replace")
            for other in sorted(set(FOREIGN_TYPE.findall(text)) - shipped_packages()):
                load_installed(other)
    add_folder(folder)


def has_interfaces(package: str, kind: str = "") -> bool:
    """Return whether a package defines interfaces, of one kind if that is given."""
    if kind:
        return any(name.split("/")[1] == kind for name in names_in(package))
    return (
        package in shipped_packages()
        or f"aionode.interfaces.{package}" in sys.modules
        or share_folder(package) is not None
    )


def names_in(package: str) -> list[str]:
    """Return the ROS names of all interfaces of a package."""
    load_installed(package)
    found = {name for name in FOUND if name.startswith(f"{package}/")}
    return sorted(found.union(interface_names(package)))
