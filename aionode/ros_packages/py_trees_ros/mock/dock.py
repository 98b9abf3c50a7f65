"""A mock server for docking."""

from __future__ import annotations

from typing import Any

from py_trees_ros_interfaces.action import Dock as DockAction

from py_trees_ros.mock.actions import GenericServer

__all__ = ["Dock"]


class Dock(GenericServer):
    """The node ``docking_controller``, whose action ``dock`` docks and undocks.

    Args:
        duration: How long it takes, in seconds.
    """

    def __init__(self, duration: float = 2.0) -> None:
        super().__init__(
            node_name="docking_controller",
            action_name="dock",
            action_type=DockAction,
            generate_feedback_message=self._feedback,
            goal_received_callback=self._note,
            duration=duration,
        )
        self.title = ""

    def _note(self, goal: Any) -> None:
        self.title = "Dock" if goal.dock else "UnDock"

    def _feedback(self) -> Any:
        return DockAction.Feedback(percentage_completed=self.percent_completed)
