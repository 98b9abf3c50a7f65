"""Checks of names."""

from aionode.names import validate_namespace
from rclpy._reexports import add_names

__all__ = ["validate_namespace"]

add_names(__name__)
