"""`launch_ros.event_handlers`."""

from __future__ import annotations

from typing import Any

from launch.event import Event
from launch.event_handler import BaseEventHandler
from launch_ros.events.lifecycle import StateTransition

__all__ = ["OnStateTransition"]


class OnStateTransition(BaseEventHandler):
    """Reacts to the transitions of managed nodes."""

    def __init__(
        self,
        *,
        entities: Any,
        target_lifecycle_node: Any = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        **options: Any,
    ) -> None:
        def matcher(event: Event) -> bool:
            return (
                isinstance(event, StateTransition)
                and target_lifecycle_node in (None, event.action)
                and transition in (None, event.transition)
                and start_state in (None, event.start_state)
                and goal_state in (None, event.goal_state)
            )

        super().__init__(matcher=matcher, reaction=entities, **options)
        self._OnStateTransition__target_lifecycle_node = target_lifecycle_node
        self._OnStateTransition__goal_state = goal_state

    def describe(self) -> str:
        """Return a description of the event and its target."""
        node = self._OnStateTransition__target_lifecycle_node
        named = "a managed node" if node is None else node.describe()
        return (
            f"{named} is {self._OnStateTransition__goal_state}"
            if self._OnStateTransition__goal_state
            else f"a transition of {named}"
        )
