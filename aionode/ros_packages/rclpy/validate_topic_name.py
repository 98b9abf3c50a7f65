"""Checks of names."""

from aionode.names import validate_topic_name

__all__ = ["TOPIC_SEPARATOR_STRING", "validate_topic_name"]

TOPIC_SEPARATOR_STRING = "/"
