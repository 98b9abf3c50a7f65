"""Where installed packages are."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

from aionode.rclpy._ament_index_python.resources import get_resource, get_resources
from aionode.rclpy._ament_index_python.search_paths import get_search_paths

__all__ = [
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
]

PACKAGE_NAME = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]+")
"""As in REP 127, with the hyphens that it tolerates."""


class PackageNotFoundError(KeyError):
    """There is no installed package of that name."""


def get_packages_with_prefixes() -> dict[str, str]:
    """Return the prefix of each installed package, by its name."""
    return get_resources("packages")


def get_package_prefix(package_name: str) -> str:
    """Return the folder into which a package was installed.

    Raises:
        PackageNotFoundError: It is in none of the folders of AMENT_PREFIX_PATH.
        ValueError: Its name is not valid.
        OSError: AMENT_PREFIX_PATH is not set.
    """
    if not PACKAGE_NAME.fullmatch(package_name):
        raise ValueError(f"'{package_name}' is not a valid package name")
    try:
        return get_resource("packages", package_name)[1]
    except LookupError:
        problem = f"package '{package_name}' not found, searching: {get_search_paths()}"
        raise PackageNotFoundError(problem) from None


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """Return the folder with the data of a package, with a warning if it does not exist."""
    path = Path(get_package_prefix(package_name), "share", package_name)
    if print_warning and not path.exists():
        warning = f"Share directory for {package_name} ({path}) does not exist."
        warnings.warn(warning, stacklevel=2)
    return str(path)


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """Return the folder with the data of a package, as a Path."""
    path = Path(get_package_share_directory(package_name, print_warning=False))
    if print_warning and not path.exists():
        warnings.warn(f"Share path for {package_name} ({path}) does not exist.", stacklevel=2)
    return path
