"""Mock servers in place of a robot's."""

from py_trees_ros.mock import actions, dock

__all__ = ["actions", "dock"]
