"""Observations of a robot: the value of each feature of a contract at a time."""

from __future__ import annotations

import asyncio
from bisect import bisect_right
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode.clock import S_TO_NS, Time
from aionode.errors import StaleError
from aionode.learn._series import Series, in_order
from aionode.qos import qos_profile_sensor_data

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable, Sequence
    from types import TracebackType
    from typing import Self

    from aionode import Node, Subscription
    from aionode.learn._entries import Array, Observation

__all__ = ["Observations", "Seen"]

START_SEC: Final = 5.0
"""How long each topic may take until its first message."""

KEPT_NS: Final = 1_000_000_000
"""How much earlier than a reference message other messages of its time may arrive."""

KEPT: Final = 2_000
"""Maximum messages kept of a topic."""

NEXT: Final = 0.75
"""The minimum time between two observations, as a fraction of their period: cameras jitter."""


class History:
    """The newest messages of one topic, in the order of their times and arrivals.

    Messages whose times contradict others are left out as by an export, so a policy sees what it
    was trained on; one with a time in the future is kept until the next message contradicts it.
    """

    def __init__(self) -> None:
        self.times: list[int] = []
        self.arrivals: list[int] = []
        self.messages: list[Any] = []

    def add(self, time_ns: int, arrival_ns: int, message: Any) -> None:
        """Keep a message, and forget those that no reference will ask for."""
        if self.arrivals and arrival_ns < self.arrivals[-1]:  # a simulation has restarted
            self._keep([])
        self.times.append(time_ns)
        self.arrivals.append(arrival_ns)
        self.messages.append(message)
        count = len(self.times)
        if count > 1 and time_ns <= self.times[-2]:
            times, arrivals = np.array(self.times, np.int64), np.array(self.arrivals, np.int64)
            series = Series(times, arrivals, np.empty((count, 0)), np.arange(count))
            self._keep(in_order(series).ordinals.tolist())
        # By their arrivals: a time in the future does not make the others old.
        too_old = bisect_right(self.arrivals, arrival_ns - KEPT_NS) - 1
        forgotten = max(too_old, len(self.times) - KEPT, 0)
        del self.times[:forgotten], self.arrivals[:forgotten], self.messages[:forgotten]

    def _keep(self, places: list[int]) -> None:
        for each in (self.times, self.arrivals, self.messages):
            each[:] = [each[place] for place in places]

    def age_ns(self, time_ns: int) -> int | None:
        """Return how old the newest message was at a time; None if there was none."""
        index = bisect_right(self.times, time_ns) - 1
        return None if index < 0 else time_ns - self.times[index]

    def value(self, entry: Observation, time_ns: int) -> Array:
        """Return the value of an entry at a time that is not before its first message."""
        index = bisect_right(self.times, time_ns) - 1
        value = entry.value(self.messages[index])
        if not entry.is_interpolated or index + 1 == len(self.times):
            return value
        share = (time_ns - self.times[index]) / (self.times[index + 1] - self.times[index])
        between: Array = value + np.float32(share) * (entry.value(self.messages[index + 1]) - value)
        return between


class Seen:
    """An observation of a robot at one time.

    Attributes:
        at: The time, by the node's clock: that of a message of the reference topic.
        values: The array of each feature by its name, as in the rows of a data set. Those of
            images may be read-only views of a message.
        age: How old each feature was then, in seconds.
    """

    __slots__ = ("age", "at", "values")

    def __init__(self, at: Time, values: dict[str, Array], age: dict[str, float]) -> None:
        self.at = at
        self.values = values
        self.age = age

    def __repr__(self) -> str:
        ages = ", ".join(f"{name} {age:.3f} s old" for name, age in self.age.items())
        return f"<Seen at {self.at.nanoseconds / S_TO_NS:.3f}: {ages}>"


class Observations:
    """Observations of a running robot. Created by `Contract.observe`, for ``async with``.

    It subscribes to the observed topics while the block is open, with best-effort reliability,
    which is compatible with every publisher.
    """

    def __init__(
        self,
        node: Node,
        entries: Sequence[Observation],
        main: Observation,
        fps: float,
        max_age: Callable[[Observation], float],
    ) -> None:
        self._node = node
        self._clock = node.get_clock()
        self._entries = entries
        self._topic = main.topic
        self._fps = fps
        self._limits = {entry.topic: max_age(entry) for entry in entries}
        self._histories = {entry.topic: History() for entry in entries}
        self._reference = self._histories[self._topic]
        self._arrived = asyncio.Event()  # a message of the reference topic
        self._began_ns = 0
        self._last_ns: int | None = None  # the last reference that was used
        self._is_complete = False  # whether there has been an observation
        self._subscriptions: list[Subscription[Any]] = []

    async def __aenter__(self) -> Self:
        """Subscribe to the topics."""
        self._began_ns = self._clock.now_ns()
        for entry in {entry.topic: entry for entry in self._entries}.values():
            subscription = self._node.create_subscription(
                entry.message_type,
                entry.topic,
                partial(self._take, entry),
                qos_profile_sensor_data,
            )
            self._subscriptions.append(subscription)
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Unsubscribe."""
        for subscription in self._subscriptions:
            subscription.destroy()

    def _take(self, entry: Observation, message: Any) -> None:
        now_ns = self._clock.now_ns()
        self._histories[entry.topic].add(entry.time_of(message, now_ns), now_ns, message)
        if entry.topic == self._topic:
            self._arrived.set()

    async def at(self, frequency: float | None = None) -> AsyncGenerator[Seen, None]:
        """Yield an observation at each message of the reference topic.

        Everything else is as of the time of that message. Messages that arrived while the program
        was busy are skipped: the next observation is the newest one.

        Args:
            frequency: Maximum observations per second; by default, the contract's `fps`.

        Raises:
            StaleError: a topic is older than its `max_age`, or silent for the first 5 s (a
                TimeoutError). Another ``async for`` continues.
            MessageError: a message does not fit the contract (a ValueError).
        """
        apart_ns = round(NEXT * S_TO_NS / (frequency or self._fps))
        while True:
            await self._until_newer(apart_ns)
            self._last_ns = self._reference.times[-1]
            try:
                seen = self.newest()
            except StaleError:
                if self._is_starting():
                    continue
                raise
            self._is_complete = True
            yield seen

    def _is_starting(self) -> bool:
        """Return whether missing topics may still arrive."""
        passed_ns = self._clock.now_ns() - self._began_ns
        return not self._is_complete and passed_ns < START_SEC * S_TO_NS

    async def _until_newer(self, apart_ns: int) -> None:
        """Wait for a message of the reference topic.

        Raises:
            StaleError: it is silent for too long.
        """
        times, arrivals = self._reference.times, self._reference.arrivals
        # If the last reference is later than the newest one, its time was in the future, and it
        # has been left out since.
        while not times or (
            self._last_ns is not None and self._last_ns <= times[-1] < self._last_ns + apart_ns
        ):
            self._arrived.clear()
            over_ns = self._began_ns + round(START_SEC * S_TO_NS)
            if times and not self._is_starting():
                over_ns = min(times[-1], arrivals[-1]) + self._limit_ns()
            if over_ns <= self._clock.now_ns():
                raise self._stale({self._topic: self._age_ns() if times else None})
            alarm = self._clock.call_at(over_ns, self._arrived.set)
            try:
                await self._arrived.wait()
            finally:
                alarm.cancel()

    def newest(self) -> Seen:
        """Return the observation at the newest message of the reference topic.

        Raises:
            StaleError: a topic is older than its `max_age`, or was never heard (a TimeoutError).
            MessageError: a message does not fit the contract (a ValueError).
        """
        at_ns = self._reference.times[-1] if self._reference.times else self._clock.now_ns()
        ages: dict[str, int] = {}
        stale: dict[str, int | None] = {}
        for entry in self._entries:
            age_ns = self._histories[entry.topic].age_ns(at_ns)
            if age_ns is None or age_ns > self._limits[entry.topic] * S_TO_NS:
                stale[entry.topic] = age_ns
            else:
                ages[entry.feature] = max(age_ns, ages.get(entry.feature, 0))
        if self._reference.times and abs(self._age_ns()) > self._limit_ns():
            stale[self._topic] = self._age_ns()
        if stale:
            raise self._stale(stale)
        parts: dict[str, list[Array]] = {}
        for entry in self._entries:
            value = self._histories[entry.topic].value(entry, at_ns)
            parts.setdefault(entry.feature, []).append(value)
        return Seen(
            Time(nanoseconds=at_ns, clock_type=self._clock.clock_type),
            {name: np.concatenate(each) if each[1:] else each[0] for name, each in parts.items()},
            {name: age_ns / S_TO_NS for name, age_ns in ages.items()},
        )

    def _age_ns(self) -> int:
        """Return the age of the newest message of the reference."""
        return self._clock.now_ns() - self._reference.times[-1]

    def _limit_ns(self) -> int:
        """Return the age that the newest message of the reference may reach."""
        return round((self._limits[self._topic] + 1 / self._fps) * S_TO_NS)

    def _stale(self, ages_ns: dict[str, int | None]) -> StaleError:
        ages = {
            topic: None if age_ns is None else age_ns / S_TO_NS for topic, age_ns in ages_ns.items()
        }
        return StaleError(ages, {**self._limits, self._topic: self._limit_ns() / S_TO_NS})
