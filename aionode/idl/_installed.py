"""Interfaces of the sourced ROS 2: the definitions under AMENT_PREFIX_PATH.

They are read when a package is first imported. A package that aionode does not ship comes from
there as a whole. Of a shipped package only the types that are defined differently there do, so that
type hashes match the nodes of that system. Without a sourced ROS 2, ROS_DISTRO names the
distribution, whose differences `_distribution_differences.py` knows.

`aionode.interfaces` calls this module while it imports a package.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from aionode.errors import IdlError
from aionode.idl._build import Builder
from aionode.idl._definition import HALVES, InterfaceText, split_type_name
from aionode.idl._distribution_differences import differences
from aionode.idl._folder import PACKAGE_NAME, TYPE_NAME, read
from aionode.idl._parser import parse

__all__ = [
    "has_package",
    "has_types",
    "installed_file",
    "installed_text",
    "packages",
    "replaced_types",
]


def installed_file(typename: str) -> Path | None:
    """Return the sourced ROS 2's definition file of a type, if it has one."""
    package, kind, name = split_type_name(typename)
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        file = Path(prefix, "share", package, kind, f"{name}.{kind}")
        if prefix and file.is_file():
            return file
    return None


def installed_text(typename: str) -> str | None:
    """Return the definition of a type in the sourced ROS 2, or in the one that ROS_DISTRO names."""
    file = installed_file(typename)
    if file is not None:
        return read(file)
    return differences(os.environ.get("ROS_DISTRO", "")).get(typename)


def installed_names(package: str, kind: str) -> Iterator[str]:
    """Yield the ROS names of the types of one kind in a package of the sourced ROS 2."""
    names = {
        file.stem
        for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
        if prefix
        for file in Path(prefix, "share", package, kind).glob(f"*.{kind}")
        if TYPE_NAME.fullmatch(file.stem)
    }
    names.update(
        typename.rpartition("/")[2]
        for typename in differences(os.environ.get("ROS_DISTRO", ""))
        if typename.startswith(f"{package}/{kind}/")
    )
    return (f"{package}/{kind}/{name}" for name in sorted(names))


class InstalledTexts(Mapping[str, InterfaceText]):
    """The definitions of one package, each parsed on first use."""

    def __init__(self, package: str, kind: str) -> None:
        self._names = dict.fromkeys(installed_names(package, kind))
        self._parsed: dict[str, InterfaceText] = {}

    def __getitem__(self, typename: str) -> InterfaceText:
        if typename not in self._names:
            raise KeyError(typename)
        if typename not in self._parsed:
            text = installed_text(typename)
            assert text is not None  # noqa: S101  # it is one of the names
            self._parsed[typename] = parse(typename, text, str(installed_file(typename) or ""))
        return self._parsed[typename]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def packages() -> frozenset[str]:
    """Return the names of the sourced ROS 2's packages with interfaces."""
    return frozenset(
        folder.parent.name
        for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
        if prefix
        for kind in HALVES
        for folder in Path(prefix, "share").glob(f"*/{kind}")
        if PACKAGE_NAME.fullmatch(folder.parent.name) and any(folder.glob(f"*.{kind}"))
    )


def has_package(package: str) -> bool:
    """Return whether the sourced ROS 2 has this package, with interfaces."""
    return any(has_types(package, kind) for kind in HALVES)


def has_types(package: str, kind: str) -> bool:
    """Return whether the sourced ROS 2 has types of one kind in a package."""
    return any(True for _ in installed_names(package, kind))


def replaced_types(package: str, kind: str, shipped: Mapping[str, Any]) -> dict[str, type[Any]]:
    """Return, by name, the installed classes that differ from the shipped ones or are not shipped.

    An invalid definition is left out with a warning, so that one broken file does not make the rest
    of its package unusable.
    """
    builder = Builder(texts := InstalledTexts(package, kind), reuse=True)
    classes: dict[str, type[Any]] = {}
    for typename in texts:
        name = split_type_name(typename)[2]
        try:
            cls = builder.build(typename)
        except IdlError as error:
            text = f"{typename} of the sourced ROS 2 is left out: {error}"
            warnings.warn(text, RuntimeWarning, stacklevel=2)
            continue
        if shipped.get(name) is not cls:
            classes[name] = cls
    return classes
