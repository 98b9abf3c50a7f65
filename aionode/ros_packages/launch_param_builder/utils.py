"""`launch_param_builder.utils`: reads files for parameters."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, TypeAlias

from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml

__all__ = [
    "ParameterBuilderFileNotFoundError",
    "ParameterValueType",
    "get_path",
    "load_file",
    "load_xacro",
    "load_yaml",
    "raise_if_file_not_found",
]

ParameterValueType: TypeAlias = (
    str | int | float | bool | list[str] | list[int] | list[float] | list[bool] | bytes
)
"""The possible types of a parameter."""


class ParameterBuilderFileNotFoundError(KeyError):
    """A file for a parameter does not exist."""


def raise_if_file_not_found(file_path: Path) -> None:
    """Raise ParameterBuilderFileNotFoundError if a file does not exist."""
    if not file_path.exists():
        raise ParameterBuilderFileNotFoundError(f"File {file_path} doesn't exist")


def load_file(file_path: Path) -> str:
    """Return the text of a file."""
    raise_if_file_not_found(file_path)
    return read_file(file_path).decode()


def load_yaml(file_path: Path) -> Any:
    """Return the content of a YAML file."""
    return loaded_yaml(load_file(file_path))


def load_xacro(file_path: Path, mappings: Mapping[str, str] | None = None) -> str:
    """Return the XML that xacro generates from a file.

    Raises:
        ModuleNotFoundError: xacro is not installed; the extra ``xacro`` installs it.
    """
    raise_if_file_not_found(file_path)
    xml: str = import_module("xacro").process_file(str(file_path), mappings=mappings).toxml()
    return xml


def get_path(package_name: str, file_path: str) -> str:
    """Return the path of a file of a package."""
    packages = import_module("ament_index_python.packages")
    return str(Path(packages.get_package_share_directory(package_name), file_path))
