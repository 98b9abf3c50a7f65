"""The goals of one action server: those that are active, and those whose results are kept."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Protocol

from aionode.errors import brief

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from aionode.clock import TimeBase
    from aionode.clock._time_base import Alarm
    from aionode.endpoints.actions.goal import GoalKey

__all__ = ["GoalStore", "StatusPace", "checked_max_goals"]

SPACING_S = 0.0001
"""The shortest time between two status messages, in seconds for each goal that they list."""

UNSPACED = 10
"""Up to how many listed goals every change is sent in the next iteration of the loop."""


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


class StoredGoal(Protocol):
    """What the store needs of a `ServerGoalHandle`."""

    _key: GoalKey


class GoalStore(dict[bytes, Any]):
    """By goal id: the goals that have not ended, and for a while those that have.

    An ended goal is forgotten after a time, or when there are too many, the oldest first.

    Args:
        time_base: Whose steady clock counts.
        limit: How many goals may be active at once, and how many that have ended are kept.
        kept_ns: How long goals are kept after their end.

    Attributes:
        kept_ns: The same.
    """

    def __init__(self, time_base: TimeBase, limit: int, kept_ns: int) -> None:
        super().__init__()
        self._time_base = time_base
        self._limit = limit
        self.kept_ns = kept_ns
        # When each kept goal is forgotten. All are kept equally long, so the first is due first.
        self._kept: dict[bytes, int] = {}
        self._alarm: Alarm | None = None  # for the first, if it waits for its time

    @property
    def active(self) -> int:
        """How many goals have not ended."""
        return len(self) - len(self._kept)

    @property
    def is_full(self) -> bool:
        """Whether no other goal may become active."""
        return self.active >= self._limit

    def add(self, goal: StoredGoal) -> None:
        """Take a goal that was accepted."""
        self[goal._key.goal_id] = goal

    def keep(self, goal_id: bytes) -> None:
        """Keep a goal that has ended; with no time to keep it, until `forget_ended`."""
        if len(self._kept) >= self._limit:
            self._forget(next(iter(self._kept)))
        self._kept[goal_id] = self._time_base.steady_ns() + self.kept_ns
        if self._alarm is None and self.kept_ns:
            self._set_alarm()

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

    def _forget(self, goal_id: bytes) -> None:
        del self._kept[goal_id], self[goal_id]

    def _set_alarm(self) -> None:
        self._alarm = None
        if self._kept:
            due_ns = next(iter(self._kept.values()))
            self._alarm = self._time_base.call_at(due_ns, self._expire)

    def _expire(self) -> None:
        now_ns = self._time_base.steady_ns()
        for goal_id, due_ns in list(self._kept.items()):
            if due_ns > now_ns:
                break
            self._forget(goal_id)
        self._set_alarm()


class StatusPace:
    """Decides when the states of all goals are published, after one of them has changed.

    A status message lists every goal that is active or kept, so sending a long list for each change
    would cost more than the goals themselves. All changes of one iteration of the loop go into one
    message. With many goals there is a shortest time between two messages as well, which grows with
    the list; the first change after a rest is sent at once, and the last one always.

    It counts real time, as the list takes that to send, whatever clock the node has.

    Args:
        send: Publishes the states.
        goals: What is listed.
    """

    def __init__(self, send: Callable[[], None], goals: Collection[bytes]) -> None:
        self._send = send
        self._goals = goals
        self._next_s = 0.0  # of the loop's time: when the next message may be sent
        self._due: asyncio.Handle | None = None

    def note_change(self) -> None:
        """Have the states sent soon."""
        if self._due is None:
            loop = asyncio.get_running_loop()
            if loop.time() < self._next_s:
                self._due = loop.call_at(self._next_s, self.flush)
            else:
                self._due = loop.call_soon(self.flush)

    def flush(self) -> None:
        """Send the states now, if any has changed since they were sent."""
        if self._due is None:
            return
        self._due.cancel()
        self._due = None
        listed = len(self._goals)
        self._send()
        if listed > UNSPACED:
            self._next_s = asyncio.get_running_loop().time() + listed * SPACING_S
