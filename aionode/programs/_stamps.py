"""Stamps of messages in nanoseconds."""

from __future__ import annotations

from typing import Any

from aionode.interfaces.builtin_interfaces.msg import Time

__all__ = ["nanoseconds", "stamp_of"]


def nanoseconds(stamp: Any) -> int:
    """Return a stamp or duration in nanoseconds; stamps from other programs may be before 1970."""
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)


def stamp_of(time_ns: int) -> Time:
    """Return a time as a stamp; in a simulation, an offset may put it before 1970."""
    sec, nanosec = divmod(time_ns, 10**9)
    return Time(sec=sec, nanosec=nanosec)
