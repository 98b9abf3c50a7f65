"""Actions with times: what a policy's chunks leave to be sent, and when.

No input or output, and no clock: times are nanoseconds of whichever clock the caller reads.
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
        lower: The least value of each number of an action.
        upper: The greatest one.
        blend_ns: For how long a new chunk is mixed with the rest of the last one.

    Attributes:
        sent: Actions taken, in time.
        late: Actions whose time was over before they could be sent.
        clamped: Actions sent that a limit has changed.
        underruns: Periods for which there was no action, from the first action on.
    """

    def __init__(self, period_ns: int, lower: Numbers, upper: Numbers, blend_ns: int = 0) -> None:
        self._period_ns = period_ns
        self._lower, self._upper = lower, upper
        self._blend_ns = blend_ns
        self._planned: list[Planned] = []
        self._done: list[Planned] = []  # those of about one chunk, for `left_over`
        self._last_ns: int | None = None  # the time of the action sent last
        self._missed = 0  # periods since then that had no action
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
        """Plan a chunk, in place of what was planned for the same time and later.

        Args:
            chunk: A row of finite numbers for each action.
            first_ns: The time of its first action.
            now_ns: The time now: actions that are over are dropped.

        Returns:
            The number of its actions that are planned.
        """
        period_ns = self._period_ns
        times = [first_ns + index * period_ns for index in range(len(chunk))]
        first = bisect_right(times, now_ns - period_ns)
        if self._last_ns is not None:  # for these times the last chunk has sent something
            first = max(first, bisect_left(times, self._last_ns + period_ns // 2))
        self.late += first
        del self._done[: bisect_left(self._done, first_ns, key=_time)]  # before any `left_over`
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
        """Mix an action with what was planned for its time, less and less from the first one on."""
        since_ns = times[index] - times[first] + self._period_ns
        if since_ns >= self._blend_ns or not self._planned:
            return values
        before = self._planned_at(times[index])
        if before is None:
            return values
        share = since_ns / self._blend_ns
        return share * values + (1 - share) * before

    def _planned_at(self, time_ns: int) -> Numbers | None:
        """Return what is planned for a time, between two actions in proportion; None if nothing."""
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
        """Plan one action for now, in place of everything that was planned."""
        inside = np.clip(values, self._lower, self._upper)
        self._planned = [Planned(now_ns, inside, bool((inside != values).any()))]
        self._done.clear()

    def take(self, now_ns: int) -> Planned | None:
        """Remove and return the action to be sent now; None if there is none.

        Of several whose time has come, as after the loop was blocked, it is the last one.
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
        """Count the periods that had no action until now."""
        if self._last_ns is not None:
            periods = (now_ns - self._last_ns + self._period_ns // 2) // self._period_ns
            self._missed = max(self._missed, periods - 1)

    def left_over(self, first_ns: int) -> Numbers:
        """Return the actions planned for a time and each period after it, sent or not.

        Each row is the action planned next to its time, as a chunk with that first time would have
        it.
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
