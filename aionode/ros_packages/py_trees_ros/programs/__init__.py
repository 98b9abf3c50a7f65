"""The programs of py_trees_ros: ``aionode run -m py_trees_ros.programs.tree_watcher``."""

from py_trees_ros.programs import blackboard_watcher, tree_watcher

__all__ = ["blackboard_watcher", "tree_watcher"]
