"""Cancel requests that reach the server before it has accepted their goal."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from aionode.clock import TimeBase

__all__ = ["EarlyCancels"]

KEPT_NS = 10_000_000_000
MAX_KEPT = 1000


class EarlyCancels:
    """The ids of goals that were canceled while they were queued, or being decided on.

    The newest 1000 are kept for 10 s.

    Args:
        time_base: Provides the steady clock.
    """

    def __init__(self, time_base: TimeBase) -> None:
        self._time_base = time_base
        self._since_ns: dict[bytes, int] = {}

    def __contains__(self, goal_id: object) -> bool:
        return goal_id in self._since_ns

    def note(self, goal_id: bytes) -> None:
        """Remember for a while that a goal unknown to the server was canceled."""
        now_ns = self._time_base.steady_ns()
        for known, since_ns in list(self._since_ns.items()):
            if now_ns - since_ns > KEPT_NS or len(self._since_ns) >= MAX_KEPT:
                del self._since_ns[known]
        self._since_ns[goal_id] = now_ns
