"""`launch.action`: the actions of a description."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.launch.plan import Completed
from launch.condition import Condition
from launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from launch.launch_context import LaunchContext

__all__ = ["Action"]


class Action(LaunchDescriptionEntity):
    """An action, executed unless its condition is false."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        if condition is not None and not isinstance(condition, Condition):
            raise TypeError(
                f"{type(self).__name__}: condition= is {condition!r}, which is not a "
                "condition; use one of launch.conditions, such as IfCondition('true')"
            )
        self._Action__condition = condition

    @property
    def condition(self) -> Condition | None:
        """The condition."""
        return self._Action__condition

    def visit(self, context: LaunchContext) -> Any:
        """Execute the action if its condition holds."""
        if self._Action__condition is not None and not self._Action__condition.evaluate(context):
            return None
        entities = self.execute(context)
        context.steps.append(Completed(self))
        return entities

    def execute(self, context: LaunchContext) -> Any:
        """Execute the action, and return further entities or None."""
        return None
