"""Nodes for commands."""

__all__ = ["NODE_NAME_PREFIX"]

NODE_NAME_PREFIX = "_ros2cli"
"""The prefix of the names of such nodes, which hides them."""
