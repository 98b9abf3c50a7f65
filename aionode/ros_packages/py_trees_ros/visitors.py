"""Visitors of trees: one logs how long setup takes, one creates messages."""

from __future__ import annotations

from typing import Any

import py_trees.visitors
from py_trees_ros_interfaces.msg import BehaviourTree

from aionode.clock import S_TO_NS, MachineTime
from py_trees_ros import conversions

__all__ = ["SetupLogger", "TreeToMsgVisitor"]


class SetupLogger(py_trees.visitors.VisitorBase):
    """Logs at level DEBUG how long the setup of each behaviour takes.

    Args:
        node: The node that logs.
    """

    def __init__(self, node: Any) -> None:
        super().__init__(full=True)
        self.node = node

    def initialise(self) -> None:
        """Start measuring."""
        self.start_time = self.last_time = MachineTime.steady_ns()

    def run(self, behaviour: Any) -> None:
        """Log the time since the previous behaviour."""
        now = MachineTime.steady_ns()
        took_sec = (now - self.last_time) / S_TO_NS
        self.node.get_logger().debug(f"'{behaviour.name}'.setup: {took_sec:.4f}s")
        self.last_time = now

    def finalise(self) -> None:
        """Log the total time."""
        took_sec = (MachineTime.steady_ns() - self.start_time) / S_TO_NS
        self.node.get_logger().debug(f"Total tree setup time: {took_sec:.4f}s")


class TreeToMsgVisitor(py_trees.visitors.VisitorBase):
    """Converts a tree to a message, which is its attribute ``tree``."""

    def __init__(self) -> None:
        super().__init__(full=True)

    def initialise(self) -> None:
        """Start a new message."""
        self.tree = BehaviourTree()

    def run(self, behaviour: Any) -> None:
        """Add a behaviour to the message."""
        self.tree.behaviours.append(conversions.behaviour_to_msg(behaviour))
