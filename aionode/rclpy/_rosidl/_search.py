"""Finds interfaces: aionode's, those of the sourced ROS 2, and those of folders that are named."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

from aionode.interfaces import get_interface, interface_names

__all__ = ["add_folder", "find", "has_interfaces", "names_in"]

NAMED: dict[str, type[Any]] = {}
"""The types of the folders that were named, as aionode's classes, by ROS name."""


def add_folder(path: str | Path) -> None:
    """Add the interfaces of a folder: a package, or a folder of packages.

    Raises:
        IdlError: A definition is not valid.
        FileNotFoundError: The folder does not exist.
    """
    from aionode.idl import load_interfaces  # parsers, which few programs need

    NAMED.update(load_interfaces(path))


def find(name: str) -> type[Any]:
    """Return aionode's class of a type, by its ROS name.

    Raises:
        InterfaceNotFoundError: There is no such type.
        IdlError: Its definition is not valid.
    """
    return NAMED.get(name) or get_interface(name)


def has_interfaces(package: str, kind: str = "") -> bool:
    """Return whether a package defines interfaces, of one kind if that is given."""
    if kind:
        return any(name.split("/")[1] == kind for name in names_in(package))
    try:
        import_module(f"aionode.interfaces.{package}")
    except ModuleNotFoundError:
        return False
    return True


def names_in(package: str) -> list[str]:
    """Return the ROS names of all interfaces of a package."""
    found = {name for name in NAMED if name.startswith(f"{package}/")}
    return sorted(found.union(interface_names(package)))
