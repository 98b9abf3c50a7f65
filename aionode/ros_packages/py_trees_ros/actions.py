"""The name that `action_clients.FromConstant` had before."""

from py_trees_ros.action_clients import FromConstant as ActionClient

__all__ = ["ActionClient"]
