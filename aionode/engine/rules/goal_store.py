"""The goals of one action server: active goals, and those whose results are kept."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.errors import brief
from aionode.message.memory_size import memory_size

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Alarm, TimeBase

__all__ = [
    "MAX_GOALS",
    "AlarmedGoalStore",
    "GoalStore",
    "checked_max_goals",
]

MAX_GOALS = 1000
"""Default limit of active goals."""


def checked_max_goals(max_goals: int, subject: str) -> int:
    """Validate and return the maximum number of active goals.

    Raises:
        TypeError: it is not an int.
        ValueError: it is less than 1.
    """
    if type(max_goals) is not int:  # bool does not count
        raise TypeError(f"{subject}: max_goals={brief(max_goals)}; expected an int")
    if max_goals < 1:
        raise ValueError(f"{subject}: max_goals={max_goals}; it must be at least 1")
    return max_goals


class GoalStore(dict[bytes, Any]):
    """Goals by id: those that have not ended, and for a while those that have.

    An ended goal is forgotten after a while, or when there are too many, oldest first.

    Args:
        now_ns: Returns the current time.
        limit: Maximum number of active goals, and of ended goals that are kept.
        kept_ns: How long to keep goals after their end; negative for forever.
        limit_bytes: Maximum size of the messages of active goals, and likewise of those of kept
            goals; 0 for no limit. A single one always fits.
        goal_class: The aionode class with the messages' fields; by default their own class.

    Attributes:
        kept_ns: How long to keep goals after their end.
    """

    def __init__(
        self,
        now_ns: Callable[[], int],
        limit: int,
        kept_ns: int,
        limit_bytes: int = 0,
        goal_class: Any = None,
    ) -> None:
        super().__init__()
        self._now_ns = now_ns
        self._limit = limit
        self._limit_bytes = limit_bytes
        self._goal_class = goal_class
        self.kept_ns = kept_ns
        # When each kept goal expires. All are kept for the same time, so they are in order.
        self._kept: dict[bytes, int] = {}
        # The sizes of the goals' messages, and the sums for the active and the kept ones.
        self._sizes: dict[bytes, int] = {}
        self._active_bytes = self._kept_bytes = 0

    def __setitem__(self, goal_id: bytes, handle: Any) -> None:
        """Add a goal, which is active until `keep`."""
        super().__setitem__(goal_id, handle)
        size = self._sizes[goal_id] = self._size(handle.request) if self._limit_bytes else 0
        self._active_bytes += size

    def clear(self) -> None:
        """Forget all goals."""
        super().clear()
        self._kept.clear()
        self._sizes.clear()
        self._active_bytes = self._kept_bytes = 0

    @property
    def active(self) -> int:
        """The number of goals that have not ended."""
        return len(self) - len(self._kept)

    def refusal(self, goal: Any = None) -> str:
        """Return why no further goal may become active; empty if one may.

        Args:
            goal: Its message, if its size matters.
        """
        if self.active >= self._limit:
            return f"{self.active} are active: max_goals={self._limit}"
        if goal is None or not (self._limit_bytes and self.active):
            return ""
        if self._active_bytes + self._size(goal) <= self._limit_bytes:
            return ""
        return (
            f"more than {self._limit_bytes / 2**20:.3g} MiB of goals would be active: "
            "AIONODE_QUEUE_BYTES, or Context(queue_bytes=…), sets the limit"
        )

    def _size(self, goal: Any) -> int:
        """Return the size of a goal's message; 0 if all have the same."""
        kind: Any = self._goal_class or type(goal)
        size_of = memory_size(kind)
        return 0 if size_of is None else size_of(goal)

    @property
    def due_ns(self) -> int | None:
        """The time at which the next goal expires; None if none does."""
        return None if self.kept_ns < 0 else next(iter(self._kept.values()), None)

    def keep(self, goal_id: bytes) -> list[Any]:
        """Keep a goal that has ended; return the goals that are forgotten to make room."""
        forgotten = []
        if len(self._kept) >= self._limit:
            forgotten.append(self._forget(next(iter(self._kept))))
        self._kept[goal_id] = self._now_ns() + self.kept_ns
        self._active_bytes -= self._sizes[goal_id]
        self._kept_bytes += self._sizes[goal_id]
        if self._limit_bytes:
            while len(self._kept) > 1 and self._kept_bytes > self._limit_bytes:
                forgotten.append(self._forget(next(iter(self._kept))))
        return forgotten

    def expire(self) -> list[Any]:
        """Forget expired goals, and return them."""
        now_ns = self._now_ns()
        forgotten = []
        while (due_ns := self.due_ns) is not None and due_ns <= now_ns:
            forgotten.append(self._forget(next(iter(self._kept))))
        return forgotten

    def _forget(self, goal_id: bytes) -> Any:
        del self._kept[goal_id]
        self._kept_bytes -= self._sizes.pop(goal_id)
        return self.pop(goal_id)


class AlarmedGoalStore(GoalStore):
    """A goal store that forgets expired goals by itself, using an alarm.

    If goals are kept for no time, they are kept until `forget_ended`.

    Args:
        time_base: Provides the steady clock.
        limit, kept_ns, limit_bytes: As for `GoalStore`.
    """

    def __init__(self, time_base: TimeBase, limit: int, kept_ns: int, limit_bytes: int = 0) -> None:
        super().__init__(time_base.steady_ns, limit, kept_ns, limit_bytes)
        self._time_base = time_base
        self._alarm: Alarm | None = None  # for the first goal to expire

    def keep(self, goal_id: bytes) -> list[Any]:
        """Keep a goal that has ended; return the goals that are forgotten to make room."""
        forgotten = super().keep(goal_id)
        if self._alarm is None and self.kept_ns:
            self._set_alarm()
        return forgotten

    def forget_ended(self) -> None:
        """Forget the goals that are not to be kept, once their end has been published."""
        if not self.kept_ns:
            for goal_id in list(self._kept):
                self._forget(goal_id)

    def close(self) -> list[Any]:
        """Forget all goals, and return them."""
        goals = list(self.values())
        self.clear()
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        return goals

    def _set_alarm(self) -> None:
        self._alarm = None
        due_ns = self.due_ns
        if due_ns is not None:
            self._alarm = self._time_base.call_at(due_ns, self._on_alarm)

    def _on_alarm(self) -> None:
        self.expire()
        self._set_alarm()
