"""The resources of installed packages: files of which only the names count."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from aionode.rclpy._ament_index_python.constants import RESOURCE_INDEX_SUBFOLDER
from aionode.rclpy._ament_index_python.search_paths import get_search_paths

__all__ = [
    "InvalidResourceNameError",
    "InvalidResourceTypeNameError",
    "get_resource",
    "get_resource_types",
    "get_resources",
    "has_resource",
]


class InvalidResourceTypeNameError(ValueError):
    """The type of a resource has a slash in its name."""


class InvalidResourceNameError(ValueError):
    """A resource has a slash in its name."""


def folders(resource_type: str) -> list[tuple[str, Path]]:
    """Return the prefixes that may have resources of a type, and the folders with them."""
    if not resource_type:
        raise AssertionError("The resource type must not be empty")
    if "/" in resource_type or "\\" in resource_type:
        raise InvalidResourceTypeNameError(f"Resource type '{resource_type}' is invalid")
    return [
        (prefix, Path(prefix, RESOURCE_INDEX_SUBFOLDER, resource_type))
        for prefix in get_search_paths()
    ]


def find(resource_type: str, resource_name: str) -> tuple[str, Path] | None:
    """Return the prefix and the file of a resource."""
    places = folders(resource_type)
    if not resource_name:
        raise AssertionError("The resource name must not be empty")
    if "/" in resource_name or "\\" in resource_name:
        raise InvalidResourceNameError(f"Resource name '{resource_name}' is invalid")
    for prefix, folder in places:
        if (folder / resource_name).is_file():
            return prefix, folder / resource_name
    return None


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the content of a resource, and the prefix where it is.

    Raises:
        LookupError: There is no such resource.
        OSError: AMENT_PREFIX_PATH is not set, or the file cannot be read.
    """
    resource = find(resource_type, resource_name)
    if resource is None:
        raise LookupError(
            f"Could not find the resource '{resource_name}' of type '{resource_type}'"
        )
    prefix, file = resource
    return file.read_text(), prefix


def has_resource(resource_type: str, resource_name: str) -> str | Literal[False]:
    """Return the prefix where a resource is, or False."""
    resource = find(resource_type, resource_name)
    return resource[0] if resource else False


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the prefix of each resource of a type, by its name."""
    prefixes: dict[str, str] = {}
    for prefix, folder in folders(resource_type):
        for file in folder.iterdir() if folder.is_dir() else ():
            if not file.is_dir() and not file.name.startswith("."):
                prefixes.setdefault(file.name, prefix)
    return prefixes


def get_resource_types() -> set[str]:
    """Return the types of all resources."""
    indexes = [Path(prefix, RESOURCE_INDEX_SUBFOLDER) for prefix in get_search_paths()]
    return {
        folder.name
        for index in indexes
        if index.is_dir()
        for folder in index.iterdir()
        if folder.is_dir() and not folder.name.startswith(".")
    }
