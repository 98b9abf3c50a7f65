"""`launch.launch_description_entity`: the elements of a launch description."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from launch.launch_context import LaunchContext

__all__ = ["LaunchDescriptionEntity", "set_where", "where_of"]


class LaunchDescriptionEntity:
    """A part of a launch description."""

    _LaunchDescriptionEntity__where: str
    """The file and line where the program created it."""

    def __new__(cls, *_args: Any, **_options: Any) -> Self:
        """Create an entity that knows its place in the user's file."""
        entity = super().__new__(cls)
        frame = sys._getframe(1)
        entity._LaunchDescriptionEntity__where = f"{frame.f_code.co_filename}:{frame.f_lineno}"
        return entity

    def visit(self, context: LaunchContext) -> Any:
        """Execute the entity, and return further entities or None."""
        return None

    def describe(self) -> str:
        """Return a description of the entity."""
        return type(self).__name__

    def get_asyncio_future(self) -> None:
        """Return None: the engine tracks what is running."""


def where_of(entity: LaunchDescriptionEntity) -> str:
    """Return the file and line where the program created an entity."""
    return entity._LaunchDescriptionEntity__where


def set_where(entity: LaunchDescriptionEntity, where: str) -> None:
    """Set the file and line of an entity that a file in XML or YAML describes."""
    entity._LaunchDescriptionEntity__where = where
