"""Loggers."""

from aionode.logging import RcutilsLogger
from rclpy._reexports import add_names

__all__ = ["RcutilsLogger"]

add_names(__name__)
