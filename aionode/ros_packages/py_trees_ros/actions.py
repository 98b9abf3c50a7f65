"""The former name of `action_clients.FromConstant`."""

from py_trees_ros.action_clients import FromConstant as ActionClient

__all__ = ["ActionClient"]
