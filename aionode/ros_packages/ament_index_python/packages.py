"""Finds packages: those of the workspace, and installed ones."""

from __future__ import annotations

import os as os
import pathlib as pathlib
import re
import warnings
from collections.abc import Callable
from pathlib import Path

from aionode import errors
from aionode._packages import Packages, here, stand_in
from ament_index_python.resources import PACKAGES, get_resources
from ament_index_python.resources import get_resource as get_resource
from ament_index_python.search_paths import get_search_paths as get_search_paths

__all__ = [
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
]

PACKAGE_NAME = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]+")
"""The pattern of package names in REP 127, with the hyphens that it tolerates."""


class PackageNotFoundError(KeyError):
    """There is no package of that name."""


def get_packages_with_prefixes() -> dict[str, str]:
    """Return the prefix of each package, by its name; see `get_package_prefix`."""
    return get_resources(PACKAGES)


def get_package_prefix(package_name: str) -> str:
    """Return the folder into which a package was installed; in a workspace, its source folder.

    Raises:
        PackageNotFoundError: There is no such package; the error suggests similar names.
        ValueError: Its name is not valid.
    """
    packages = checked(package_name)
    source = packages.sources().get(package_name)
    return str(source or looked_up(package_name, packages.prefix))


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """Return the folder with the data of a package, with a warning if it does not exist.

    For a package of the workspace, which needs no build, this is its source folder, or a folder of
    links if its rules install files elsewhere. For a package of ROS that is not installed, it is
    the folder that aionode has in its place.
    """
    below = Path("share", package_name)
    path = looked_up(package_name, checked(package_name).share, below)
    if print_warning and stand_in(package_name) is None and not path.exists():
        warning = f"Share directory for {package_name} ({path}) does not exist."
        warnings.warn(warning, stacklevel=2)
    return str(path)


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """Return the folder with the data of a package, as a Path."""
    path = Path(get_package_share_directory(package_name, print_warning=False))
    if print_warning and not path.exists():
        warnings.warn(f"Share path for {package_name} ({path}) does not exist.", stacklevel=2)
    return path


def checked(package_name: str) -> Packages:
    """Return the known packages, if the name of one is valid."""
    if not PACKAGE_NAME.fullmatch(package_name):
        raise ValueError(f"'{package_name}' is not a valid package name")
    return here()


def looked_up(package_name: str, look_up: Callable[[str], Path], below: Path = Path()) -> Path:
    """Return a folder of a package, or the one `below` the prefix of its stand-in."""
    try:
        return look_up(package_name)
    except errors.PackageNotFoundError as error:
        other = stand_in(package_name)
        if other is not None:
            return other / below
        problem = f"package '{package_name}' not found, searching: {list(error.places)}"
        hint = f"; did you mean {error.suggestions[0]}?" if error.suggestions else ""
        raise PackageNotFoundError(problem + hint) from None
