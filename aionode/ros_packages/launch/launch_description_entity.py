"""`launch.launch_description_entity`: what a launch description consists of."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from launch.launch_context import LaunchContext

__all__ = ["LaunchDescriptionEntity"]


class LaunchDescriptionEntity:
    """A part of a launch description."""

    _LaunchDescriptionEntity__where: str
    """The file and line where the program made it."""

    def __new__(cls, *_args: Any, **_options: Any) -> Self:
        """Make an entity that knows its place in the user's file."""
        entity = super().__new__(cls)
        frame = sys._getframe(1)
        entity._LaunchDescriptionEntity__where = f"{frame.f_code.co_filename}:{frame.f_lineno}"
        return entity

    def visit(self, context: LaunchContext) -> Any:
        """Do what the entity is for, and return further entities or None."""
        return None

    def describe(self) -> str:
        """Return what it is."""
        return type(self).__name__

    def get_asyncio_future(self) -> None:
        """Return None: the engine knows what runs."""
