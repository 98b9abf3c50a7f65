"""Durations."""

from aionode.clock import Duration, Infinite

__all__ = ["Duration", "Infinite"]
