"""`launch_ros.events.lifecycle`: the states of managed nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from launch.event import Event

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]


class ChangeState(Event):
    """A request to trigger a transition."""

    name = "launch_ros.events.lifecycle.ChangeState"

    def __init__(
        self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int
    ) -> None:
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id


class StateTransition(Event):
    """A managed node has changed its state."""

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action = action
        self.msg = msg
        self.timestamp = msg.timestamp
        self.transition = msg.transition.label
        self.start_state = msg.start_state.label
        self.goal_state = msg.goal_state.label


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a matcher for the node with a full name."""
    name = node_name if node_name.startswith("/") else f"/{node_name}"
    return lambda action: action.node_name == name
