"""Checks of names."""

from aionode.names import validate_full_topic_name
from rclpy._reexports import add_names

__all__ = ["validate_full_topic_name"]

add_names(__name__)
