"""`launch.events.matchers`: the processes that a request concerns."""

from __future__ import annotations

from launch.events.process import (
    matches_action,
    matches_executable,
    matches_name,
    matches_pid,
)

__all__ = ["matches_action", "matches_executable", "matches_name", "matches_pid"]
