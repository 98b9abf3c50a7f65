"""Checks of names."""

from aionode.names import validate_topic_name
from rclpy._reexports import add_names

__all__ = ["TOPIC_SEPARATOR_STRING", "validate_topic_name"]

TOPIC_SEPARATOR_STRING = "/"

add_names(__name__)
