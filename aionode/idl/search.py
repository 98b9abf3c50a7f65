"""Finds interfaces for rclpy programs, in the places searched by `aionode.interfaces`.

A given folder may define a type differently from aionode; rclpy programs get that definition.
"""

from __future__ import annotations

import os
import re
import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from aionode.interfaces import get_interface, interface_names, shipped_packages

if TYPE_CHECKING:
    from aionode.idl.named import NamedInterfaces

__all__ = ["add_folder", "find", "has_interfaces", "module_name", "names_in"]


def add_folder(path: str | Path) -> None:
    """Add the interfaces of a folder: a package, or a folder of packages.

    It is not read until a program imports a package that aionode does not have.

    Raises:
        FileNotFoundError: The folder does not exist.
    """
    from aionode.idl.named import named  # parsers, needed by few programs

    named().add(path)


def folders() -> NamedInterfaces | None:
    """Return the interfaces of the given folders, if there may be any."""
    if "aionode.idl.named" not in sys.modules and not os.environ.get("AIONODE_INTERFACES"):
        return None
    from aionode.idl.named import named

    return named()


def find(name: str) -> type[Any]:
    """Return aionode's class for a type, by its ROS name.

    Raises:
        InterfaceNotFoundError: There is no such type.
        IdlError: Its definition is not valid.
    """
    if (named := folders()) is not None and named.has(name):
        return named.build(name)
    described: type[Any] = get_interface(name)
    return described


def has_interfaces(package: str, kind: str = "") -> bool:
    """Return whether a package defines interfaces, or interfaces of one kind."""
    if kind:
        return any(name.split("/")[1] == kind for name in names_in(package))
    if (named := folders()) is not None and named.names(package):
        return True
    try:
        import_module(f"aionode.interfaces.{package}")
    except ModuleNotFoundError:
        return False
    return True


def names_in(package: str) -> list[str]:
    """Return the ROS names of all interfaces of a package."""
    named = folders()
    names = [] if named is None else named.names(package)
    if names and package not in shipped_packages():
        return sorted(names)
    return sorted({*names, *interface_names(package)})


def module_name(package: str, kind: str, name: str) -> str:
    """Return the module that rosidl generates for an interface: ``std_msgs.msg._string``."""
    words = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    words = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", words)
    return f"{package}.{kind}._{words.lower()}"
