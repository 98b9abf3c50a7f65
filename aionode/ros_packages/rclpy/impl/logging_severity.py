"""The severities of log messages."""

from aionode.logging import LoggingSeverity
from rclpy._reexports import add_names

__all__ = ["LoggingSeverity"]

add_names(__name__)
