"""The goals of one action server: those that are active, and those whose results are kept."""

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
"""Most goals that may be active at once, unless a program says otherwise."""


def checked_max_goals(max_goals: int, subject: str) -> int:
    """Return how many goals may be active at once.

    Raises:
        TypeError: it is not an int.
        ValueError: it is less than 1.
    """
    if type(max_goals) is not int:  # True is no number
        raise TypeError(f"{subject}: max_goals={brief(max_goals)}; an int is needed")
    if max_goals < 1:
        raise ValueError(f"{subject}: max_goals={max_goals}; it must be at least 1")
    return max_goals


class GoalStore(dict[bytes, Any]):
    """By goal id: the goals that have not ended, and for a while those that have.

    An ended goal is forgotten after a time, or when there are too many, the oldest first.

    Args:
        now_ns: Shows the time that counts.
        limit: How many goals may be active at once, and how many that have ended are kept.
        kept_ns: How long goals are kept after their end; negative for ever.
        limit_bytes: How much the messages of active goals take at most, and as much those of kept
            ones; 0 for any. A single one always fits.
        goal_class: The class of aionode whose fields the messages have; their own by default.

    Attributes:
        kept_ns: The same.
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
        # When each kept goal is forgotten. All are kept equally long, so the first is due first.
        self._kept: dict[bytes, int] = {}

    @property
    def active(self) -> int:
        """The number of goals that have not ended."""
        return len(self) - len(self._kept)

    def refusal(self, goal: Any = None) -> str:
        """Return why no other goal may become active; empty if one may.

        Args:
            goal: Its message, where messages are weighed.
        """
        if self.active >= self._limit:
            return f"{self.active} are active: max_goals={self._limit}"
        if goal is None:
            return ""
        active = [handle.request for key, handle in self.items() if key not in self._kept]
        if not active or self._fit([goal, *active]):
            return ""
        return (
            f"more than {self._limit_bytes / 2**20:.3g} MiB of goals would be active: "
            "AIONODE_QUEUE_BYTES, or Context(queue_bytes=…), sets the limit"
        )

    def _fit(self, goals: list[Any]) -> bool:
        """Return whether messages of goals take no more than the limit."""
        kind: Any = self._goal_class or type(goals[0])
        size_of = memory_size(kind) if self._limit_bytes else None
        return size_of is None or sum(map(size_of, goals)) <= self._limit_bytes

    @property
    def due_ns(self) -> int | None:
        """When the next goal is to be forgotten; None if none waits for its time."""
        return None if self.kept_ns < 0 else next(iter(self._kept.values()), None)

    def keep(self, goal_id: bytes) -> list[Any]:
        """Keep a goal that has ended; return the goals that are forgotten for it."""
        forgotten = []
        if len(self._kept) >= self._limit:
            forgotten.append(self._forget(next(iter(self._kept))))
        self._kept[goal_id] = self._now_ns() + self.kept_ns
        if self._limit_bytes:
            while len(self._kept) > 1 and not self._fit([self[key].request for key in self._kept]):
                forgotten.append(self._forget(next(iter(self._kept))))
        return forgotten

    def expire(self) -> list[Any]:
        """Forget the goals whose time is over, and return them."""
        now_ns = self._now_ns()
        forgotten = []
        while (due_ns := self.due_ns) is not None and due_ns <= now_ns:
            forgotten.append(self._forget(next(iter(self._kept))))
        return forgotten

    def _forget(self, goal_id: bytes) -> Any:
        del self._kept[goal_id]
        return self.pop(goal_id)


class AlarmedGoalStore(GoalStore):
    """A goal store that forgets by itself, when an alarm rings.

    With no time to keep goals, it keeps them until `forget_ended`.

    Args:
        time_base: Whose steady clock counts.
        limit, kept_ns, limit_bytes: As for `GoalStore`.
    """

    def __init__(self, time_base: TimeBase, limit: int, kept_ns: int, limit_bytes: int = 0) -> None:
        super().__init__(time_base.steady_ns, limit, kept_ns, limit_bytes)
        self._time_base = time_base
        self._alarm: Alarm | None = None  # for the first, if it waits for its time

    def keep(self, goal_id: bytes) -> list[Any]:
        """Keep a goal that has ended; return the goals that are forgotten for it."""
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
        self._kept.clear()
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
