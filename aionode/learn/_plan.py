"""Actions with times: which actions of a policy's chunks are to be sent, and when.

This module does no I/O and reads no clock: times are nanoseconds by the caller's clock.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Numbers = npt.NDArray[np.float64]

__all__ = ["ActionPlan", "Planned"]


class Planned(NamedTuple):
    """One action.

    Attributes:
        time_ns: When it is to be sent. It applies for one period from then on.
        values: What to send.
        clamped: Whether a limit has changed it.
    """

    time_ns: int
    values: Numbers
    clamped: bool


class ActionPlan:
    """The actions that are still to be sent, in the order of their times.

    Args:
        period_ns: The time between two actions of a chunk.
        lower: The lower limit of each number of an action.
        upper: The upper limits.
        blend_ns: How long a new chunk is blended with the rest of the last one.

    Attributes:
        sent: Actions taken, in time.
        late: Actions whose time had passed before they could be sent.
        clamped: Actions sent that a limit has changed.
        underruns: Periods for which there was no action, from the first action on.
    """

    def __init__(self, period_ns: int, lower: Numbers, upper: Numbers, blend_ns: int = 0) -> None:
        self._period_ns = period_ns
        self._lower, self._upper = lower, upper
        self._blend_ns = blend_ns
        self._planned: list[Planned] = []
        self._done: list[Planned] = []  # about one chunk of them, for `left_over`
        self._last_ns: int | None = None  # the time of the last action sent
        self._missed = 0  # periods without an action since then
        self._underruns = 0
        self.sent = self.late = self.clamped = 0

    @property
    def underruns(self) -> int:
        """Periods for which there was no action, from the first action on."""
        return self._underruns + self._missed

    @property
    def next_ns(self) -> int | None:
        """When the next action is to be sent; None without one."""
        return self._planned[0].time_ns if self._planned else None

    @property
    def end_ns(self) -> int | None:
        """When the last action ends; None before the first chunk."""
        if self._planned:
            return self._planned[-1].time_ns + self._period_ns
        return None if self._last_ns is None else self._last_ns + self._period_ns

    def put(self, chunk: Numbers, first_ns: int, now_ns: int) -> int:
        """Plan a chunk, replacing what was planned for the same time and later.

        Args:
            chunk: A row of finite numbers for each action.
            first_ns: The time of its first action.
            now_ns: The current time: actions whose time has passed are dropped.

        Returns:
            The number of its actions that are planned.
        """
        period_ns = self._period_ns
        times = [first_ns + index * period_ns for index in range(len(chunk))]
        first = bisect_right(times, now_ns - period_ns)
        if self._last_ns is not None:  # actions of the last chunk were sent for these times
            first = max(first, bisect_left(times, self._last_ns + period_ns // 2))
        self.late += first
        # `left_over` needs no earlier ones.
        del self._done[: bisect_left(self._done, first_ns, key=_time)]
        if first == len(times):
            return 0
        values = np.clip(chunk, self._lower, self._upper)
        clamped = (values != chunk).any(axis=1)
        fresh = [
            Planned(times[index], self._blended(values[index], times, index, first), clamped[index])
            for index in range(first, len(times))
        ]
        kept = bisect_left(self._planned, times[first] - period_ns // 2, key=_time)
        self._planned[kept:] = fresh
        return len(fresh)

    def _blended(self, values: Numbers, times: list[int], index: int, first: int) -> Numbers:
        """Blend an action with what was planned for its time, less and less along the chunk."""
        since_ns = times[index] - times[first] + self._period_ns
        if since_ns >= self._blend_ns or not self._planned:
            return values
        before = self._planned_at(times[index])
        if before is None:
            return values
        share = since_ns / self._blend_ns
        return share * values + (1 - share) * before

    def _planned_at(self, time_ns: int) -> Numbers | None:
        """Return what is planned for a time, interpolated between actions; None if nothing is."""
        planned = [*self._done[-1:], *self._planned]
        after = bisect_left(planned, time_ns, key=_time)
        if after == len(planned):
            last = planned[-1]
            return last.values if time_ns < last.time_ns + self._period_ns // 2 else None
        if after == 0:
            return planned[0].values
        (before_ns, before, _), (after_ns, values, _) = planned[after - 1], planned[after]
        share = (time_ns - before_ns) / (after_ns - before_ns)
        return (1 - share) * before + share * values

    def put_now(self, values: Numbers, now_ns: int) -> None:
        """Plan one action for now, replacing everything that was planned."""
        inside = np.clip(values, self._lower, self._upper)
        self._planned = [Planned(now_ns, inside, bool((inside != values).any()))]
        self._done.clear()

    def take(self, now_ns: int) -> Planned | None:
        """Remove and return the action to be sent now; None if there is none.

        If several are due, as after the loop was blocked, the last one is returned.
        """
        due = bisect_right(self._planned, now_ns, key=_time)
        if due == 0:
            return None
        action = self._planned[due - 1]
        in_time = now_ns < action.time_ns + self._period_ns
        self.late += due - in_time
        del self._planned[:due]
        if not in_time:
            return None
        self.note_time(action.time_ns)
        self._underruns += self._missed
        self._missed = 0
        self._last_ns = action.time_ns
        self._done.append(action)
        self.sent += 1
        self.clamped += bool(action.clamped)
        return action

    def note_time(self, now_ns: int) -> None:
        """Count the periods without an action until now."""
        if self._last_ns is not None:
            periods = (now_ns - self._last_ns + self._period_ns // 2) // self._period_ns
            self._missed = max(self._missed, periods - 1)

    def left_over(self, first_ns: int) -> Numbers:
        """Return the actions planned for a time and for each period after it, sent or not.

        Each row is the action planned closest to its time, as in a chunk with that first time.
        """
        known = [*self._done, *self._planned]
        if not known:
            return np.empty((0, len(self._lower)))
        times = np.array([each.time_ns for each in known])
        wanted = np.arange(first_ns, times[-1] + self._period_ns // 2, self._period_ns)
        nearest = np.abs(times - wanted[:, np.newaxis]).argmin(axis=1)
        return np.array([known[index].values for index in nearest]).reshape(-1, len(self._lower))


def _time(action: Planned) -> int:
    return action.time_ns
