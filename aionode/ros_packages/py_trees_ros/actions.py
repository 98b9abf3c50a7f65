"""Provides `action_clients.FromConstant` under its former name."""

from py_trees_ros.action_clients import FromConstant as ActionClient

__all__ = ["ActionClient"]
