"""Nodes for commands."""

__all__ = ["NODE_NAME_PREFIX"]

NODE_NAME_PREFIX = "_ros2cli"
"""How the names of such nodes begin, which hides them."""
