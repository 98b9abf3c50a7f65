"""Checks of names."""

from aionode.names import validate_node_name
from rclpy._reexports import add_names

__all__ = ["validate_node_name"]

add_names(__name__)
