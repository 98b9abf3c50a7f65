"""Types of clocks."""

from aionode.clock import ClockType
from rclpy._reexports import add_names

__all__ = ["ClockType"]

add_names(__name__)
