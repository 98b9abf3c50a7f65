"""Stamps of messages in nanoseconds."""

from __future__ import annotations

from typing import Any

__all__ = ["nanoseconds"]


def nanoseconds(stamp: Any) -> int:
    """Return a stamp or duration in nanoseconds; stamps of others may be before 1970."""
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)
