"""`launch.frontend.parser`: launch files in XML and YAML, read by a program."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, TextIO

from launch.invalid_launch_file_error import InvalidLaunchFileError

if TYPE_CHECKING:
    from launch.launch_description import LaunchDescription

__all__ = ["ENDINGS", "Entity", "InvalidFrontendLaunchFileError", "Parser"]

ENDINGS = ("xml", "launch", "yaml", "yml")


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """A launch file in XML or YAML cannot be read."""


class Entity:
    """A launch file in XML or YAML, for `Parser.parse_description`."""

    type_name = "launch"

    def __init__(self, description: LaunchDescription) -> None:
        self._Entity__description = description


class Parser:
    """Reads launch files in XML and YAML."""

    @classmethod
    def load(cls, file: str | os.PathLike[str] | TextIO) -> tuple[Entity, Parser]:
        """Return the content of a file, and a parser that makes a description of it.

        Raises:
            InvalidFrontendLaunchFileError: It is not a launch file in XML or YAML.
        """
        from aionode.launch.running import description_of_text  # which imports this package

        try:
            if isinstance(file, str | os.PathLike):
                path, text = os.fspath(file), None
            else:
                path, text = getattr(file, "name", "<text>"), file.read().encode()
            return Entity(description_of_text(path, text, ENDINGS)), cls()
        except ValueError as error:
            extension = os.path.splitext(path)[1][1:]  # noqa: PTH122  # of any text
            raise InvalidFrontendLaunchFileError(extension, likely_errors=[error]) from error

    def parse_description(self, entity: Any) -> LaunchDescription:
        """Return the description in a file."""
        description: LaunchDescription = entity._Entity__description
        return description

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """Return the extensions of such files."""
        return list(ENDINGS)

    @classmethod
    def is_filename_valid(cls, filename: str) -> bool:
        """Return whether a file has such an extension."""
        return filename.endswith(tuple(f".{ending}" for ending in ENDINGS))
