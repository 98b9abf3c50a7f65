"""Checks of names."""

from aionode.parameter import validate_parameter_name
from rclpy._reexports import add_names

__all__ = ["validate_parameter_name"]

add_names(__name__)
