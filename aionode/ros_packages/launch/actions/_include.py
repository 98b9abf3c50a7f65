"""The action that includes another launch file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from launch.action import Action
from launch.actions._scope import SetLaunchConfiguration
from launch.launch_context import LaunchContext
from launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    LaunchDescriptionSource,
)

__all__ = ["IncludeLaunchDescription"]


class IncludeLaunchDescription(Action):
    """Includes another launch file, with arguments."""

    def __init__(
        self,
        launch_description_source: Any,
        *,
        launch_arguments: Iterable[tuple[Any, Any]] | None = None,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self.launch_description_source = launch_description_source
        pairs = getattr(launch_arguments, "items", None)
        self.launch_arguments = list(pairs() if callable(pairs) else launch_arguments or ())

    def execute(self, context: LaunchContext) -> list[Any]:
        """Return the arguments, and the entities of the file."""
        source = self.launch_description_source
        before = context.get_locals_as_dict()
        sets = [SetLaunchConfiguration(*pair) for pair in self.launch_arguments]
        described = source.get_launch_description(context)
        location = Path(source.location).absolute()
        context.extend_locals(
            {
                "current_launch_file_path": str(location),
                "current_launch_file_directory": str(location.parent),
            }
        )
        return [*sets, described, Restore(before)]


class Restore(Action):
    """Makes `ThisLaunchFileDir` the folder of the including file again."""

    def __init__(self, before: dict[str, Any]) -> None:
        super().__init__()
        self.before = before

    def execute(self, context: LaunchContext) -> None:
        """Restore the folder of the file."""
        for name in ("current_launch_file_path", "current_launch_file_directory"):
            if name in self.before:
                context.extend_locals({name: self.before[name]})
