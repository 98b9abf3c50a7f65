"""Finds interfaces: aionode's, those of the sourced ROS 2, and those of folders that are named."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from aionode.errors import InterfaceNotFoundError
from aionode.interfaces import get_interface, interface_names, shipped_packages

if TYPE_CHECKING:
    from aionode.idl._named import NamedInterfaces

__all__ = ["add_folder", "add_workspace", "find", "has_interfaces", "names_in"]

NAMED: list[NamedInterfaces] = []
"""The interfaces of the folders that were named, if any was."""


def add_folder(path: str | Path) -> None:
    """Add the interfaces of a folder: a package, or a folder of packages.

    Nothing of it is read before a program imports a package that aionode does not have.

    Raises:
        FileNotFoundError: The folder does not exist.
    """
    if not NAMED:
        from aionode.idl._named import NamedFinder, NamedInterfaces  # parsers, for few programs

        NAMED.append(NamedInterfaces())
        sys.meta_path.insert(0, NamedFinder(NAMED[0]))
    NAMED[0].add(path)


def find(name: str) -> type[Any]:
    """Return aionode's class of a type, by its ROS name.

    Raises:
        InterfaceNotFoundError: There is no such type.
        IdlError: Its definition is not valid.
    """
    if NAMED and NAMED[0].has(name):
        return NAMED[0].build(name)
    try:
        described: type[Any] = get_interface(name)
    except InterfaceNotFoundError:
        if not add_workspace(name.partition("/")[0]):
            raise
        described = find(name)
    return described


def add_workspace(package: str) -> bool:
    """Add the interfaces of the workspace if one of its packages has this name and is new.

    Returns:
        Whether they were added.
    """
    from aionode.rclpy._workspace import here  # only for what is not found otherwise

    packages = here()
    source = packages.sources().get(package)
    if source is None or packages.workspace is None or (NAMED and NAMED[0].names(package)):
        return False
    if not any((source / kind).is_dir() for kind in ("msg", "srv", "action")):
        return False
    add_folder(packages.workspace)
    return True


def has_interfaces(package: str, kind: str = "") -> bool:
    """Return whether a package defines interfaces, of one kind if that is given."""
    if kind:
        return any(name.split("/")[1] == kind for name in names_in(package))
    if NAMED and NAMED[0].names(package):
        return True
    try:
        import_module(f"aionode.interfaces.{package}")
    except ModuleNotFoundError:
        return False
    return True


def names_in(package: str) -> list[str]:
    """Return the ROS names of all interfaces of a package."""
    named = NAMED[0].names(package) if NAMED else []
    if named and package not in shipped_packages():
        return sorted(named)
    return sorted({*named, *interface_names(package)})
