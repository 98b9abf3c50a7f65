"""Types of clocks."""

from aionode.clock import ClockType

__all__ = ["ClockType"]
