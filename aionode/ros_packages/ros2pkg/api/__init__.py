"""Queries of `ros2 pkg`."""

from __future__ import annotations

from collections.abc import KeysView
from typing import Any

from aionode import errors
from aionode._packages import here, starter_file
from ament_index_python.packages import (
    PackageNotFoundError,
    get_package_prefix,
    get_packages_with_prefixes,
)

__all__ = [
    "PackageNotFound",
    "get_executable_paths",
    "get_package_names",
    "get_prefix_path",
    "package_name_completer",
]


class PackageNotFound(Exception):  # noqa: N818  # ROS's name
    """There is no package with this name."""

    def __init__(self, package_name: str) -> None:
        super().__init__(package_name)
        self.package_name = package_name


def get_package_names() -> KeysView[str]:
    """Return the names of packages, including those of the workspace."""
    return get_packages_with_prefixes().keys()


def get_prefix_path(package_name: str) -> str | None:
    """Return the folder where a package is installed, or its source; None if there is neither."""
    try:
        return get_package_prefix(package_name)
    except (PackageNotFoundError, ValueError):
        return None


def get_executable_paths(*, package_name: str) -> list[str]:
    """Return the executable files of a package, in order.

    A program without a file, such as one of a package that is not built, is represented by a script
    that starts it.

    Raises:
        PackageNotFound: There is no such package.
    """
    packages = here()
    try:
        executables = packages.executables(package_name)
    except errors.PackageNotFoundError as error:
        raise PackageNotFound(package_name) from error
    is_source = package_name in packages.sources()
    return [
        str(starter_file(name, packages.command(package_name, name)))
        if is_source or executables[name].is_standard
        else executables[name].target
        for name in sorted(executables)
    ]


def package_name_completer(**kwargs: Any) -> KeysView[str]:
    """Return the names of packages, for an argument of a command."""
    return get_package_names()
