"""The resources of packages: marker files of which only the names matter.

A package of the workspace has the resource that marks its presence, as if it were installed into
its source folder. Python's own prefix, where pip installs, is searched after the folders of
AMENT_PREFIX_PATH.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Final, Literal

from aionode._packages import here
from ament_index_python.constants import (
    AMENT_PREFIX_PATH_ENV_VAR,
    RESOURCE_INDEX_SUBFOLDER,
)
from ament_index_python.search_paths import get_search_paths

__all__ = [
    "InvalidResourceNameError",
    "InvalidResourceTypeNameError",
    "get_resource",
    "get_resource_types",
    "get_resources",
    "has_resource",
]


PACKAGES: Final = "packages"
"""The type of the resource that each package has: a file with its name."""


class InvalidResourceTypeNameError(ValueError):
    """The type of a resource has a slash in its name."""


class InvalidResourceNameError(ValueError):
    """A resource has a slash in its name."""


def searched() -> list[str]:
    """Return the folders that may contain an index: those of ROS, if any, then Python's own."""
    return [*(get_search_paths() if os.environ.get(AMENT_PREFIX_PATH_ENV_VAR) else ()), sys.prefix]


def folders(resource_type: str) -> list[tuple[str, Path]]:
    """Return the prefixes that may contain resources of a type, each with its folder."""
    if not resource_type:
        raise AssertionError("The resource type must not be empty")
    if "/" in resource_type or "\\" in resource_type:
        raise InvalidResourceTypeNameError(f"Resource type '{resource_type}' is invalid")
    return [
        (prefix, Path(prefix, RESOURCE_INDEX_SUBFOLDER, resource_type)) for prefix in searched()
    ]


def find(resource_type: str, resource_name: str) -> tuple[str, Path | None] | None:
    """Return the prefix and the file of a resource; a package of the workspace has no file."""
    places = folders(resource_type)
    if not resource_name:
        raise AssertionError("The resource name must not be empty")
    if "/" in resource_name or "\\" in resource_name:
        raise InvalidResourceNameError(f"Resource name '{resource_name}' is invalid")
    if resource_type == PACKAGES and (source := here().sources().get(resource_name)):
        return str(source), None
    for prefix, folder in places:
        if (folder / resource_name).is_file():
            return prefix, folder / resource_name
    return None


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the content of a resource, and its prefix.

    Raises:
        LookupError: There is no such resource.
        OSError: The file cannot be read.
    """
    resource = find(resource_type, resource_name)
    if resource is None:
        raise LookupError(
            f"Could not find the resource '{resource_name}' of type '{resource_type}'"
        )
    prefix, file = resource
    return "" if file is None else file.read_text(), prefix


def has_resource(resource_type: str, resource_name: str) -> str | Literal[False]:
    """Return the prefix that contains a resource, or False."""
    resource = find(resource_type, resource_name)
    return resource[0] if resource else False


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the prefix of each resource of a type, by its name."""
    prefixes: dict[str, str] = {}
    for prefix, folder in folders(resource_type):
        for file in folder.iterdir() if folder.is_dir() else ():
            if not file.is_dir() and not file.name.startswith("."):
                prefixes.setdefault(file.name, prefix)
    if resource_type == PACKAGES:
        prefixes |= {name: str(folder) for name, folder in here().sources().items()}
    return prefixes


def get_resource_types() -> set[str]:
    """Return the types of all resources."""
    indexes = [Path(prefix, RESOURCE_INDEX_SUBFOLDER) for prefix in searched()]
    known = {PACKAGES} if here().sources() else set()
    return known | {
        folder.name
        for index in indexes
        if index.is_dir()
        for folder in index.iterdir()
        if folder.is_dir() and not folder.name.startswith(".")
    }
