"""Cancel requests that reach the server before it has accepted their goal."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from aionode.clock import TimeBase

__all__ = ["EarlyCancels"]

KEPT_NS = 10_000_000_000
MAX_KEPT = 1000


class EarlyCancels:
    """The ids of goals that were cancelled while they were queued, or being decided on.

    They are kept for 10 s, and the newest 1000 of them.

    Args:
        time_base: Whose steady clock counts.
    """

    def __init__(self, time_base: TimeBase) -> None:
        self._time_base = time_base
        self._since_ns: dict[bytes, int] = {}

    def __contains__(self, goal_id: object) -> bool:
        return goal_id in self._since_ns

    def note(self, goal_id: bytes) -> None:
        """Keep for a while that a goal was cancelled that the server does not know."""
        now_ns = self._time_base.steady_ns()
        for known, since_ns in list(self._since_ns.items()):
            if now_ns - since_ns > KEPT_NS or len(self._since_ns) >= MAX_KEPT:
                del self._since_ns[known]
        self._since_ns[goal_id] = now_ns
