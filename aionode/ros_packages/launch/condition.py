"""`launch.condition`: whether an action is executed."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from launch.launch_context import LaunchContext

__all__ = ["Condition"]


class Condition:
    """Decides whether an action is executed."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether the action is executed."""
        if self._predicate is None:
            raise NotImplementedError(f"{type(self).__name__}.evaluate")
        return self._predicate(context)
