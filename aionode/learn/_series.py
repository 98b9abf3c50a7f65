"""The messages of one entry of a contract, in the order of their times."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

__all__ = ["OTHER_CLOCK", "Floats", "Ints", "Series", "in_order"]

OTHER_CLOCK: Final = 1.0
"""Seconds between stamp and arrival from which they are taken to be from two clocks."""

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


@dataclass(slots=True)
class Series:
    """The messages of one entry of a contract, in the order of their times.

    Attributes:
        times: Their times in nanoseconds, by header or arrival.
        arrivals: When they arrived.
        values: Their numbers, one row each; no columns for images.
        ordinals: Their positions among all messages of their topic.
        is_captured: Whether the times come from headers.
        backwards: How many were left out because their times were out of order.
        unstamped: How many have no time in their header; others of the topic may have one.
        invalid: How many could not be read.
        problem: What was wrong with the first of these.
    """

    times: Ints
    arrivals: Ints
    values: Floats
    ordinals: Ints
    is_captured: bool = False
    backwards: int = 0
    unstamped: int = 0
    invalid: int = 0
    problem: str = ""

    @property
    def offsets(self) -> Floats:
        """How long after its time each message arrived, in seconds."""
        return (self.arrivals.astype(np.float64) - self.times) / 1e9

    def only(self, is_kept: npt.NDArray[np.bool_]) -> Series:
        """Return some of the messages, with unchanged counts of those that were left out."""
        return replace(
            self,
            times=self.times[is_kept],
            arrivals=self.arrivals[is_kept],
            values=self.values[is_kept],
            ordinals=self.ordinals[is_kept],
        )

    def without(self, ordinals: list[int], problem: str) -> Series:
        """Return the messages without those that turned out to be unreadable."""
        found = self.only(~np.isin(self.ordinals, ordinals))
        return replace(found, invalid=self.invalid + len(ordinals), problem=self.problem or problem)


def in_order(series: Series) -> Series:
    """Return the messages whose times are in the order in which they arrived.

    A time that contradicts others is taken as wrong if it is over `OTHER_CLOCK` further from its
    arrival than is usual for the topic, so that one time in the future does not cost all later
    messages. Of the rest, messages that are not later than the one before are left out.
    """
    times = series.times
    if (np.diff(times) > 0).all():
        return series
    first, last = np.iinfo(np.int64).min, np.iinfo(np.int64).max
    latest_before = np.append(first, np.maximum.accumulate(times)[:-1])
    earliest_after = np.append(np.minimum.accumulate(times[::-1])[::-1][1:], last)
    is_contradicted = (times <= latest_before) | (times >= earliest_after)
    is_far = np.abs(series.offsets - np.median(series.offsets)) > OTHER_CLOCK
    found = series.only(~(is_contradicted & is_far))
    is_after = np.append(True, found.times[1:] > np.maximum.accumulate(found.times)[:-1])
    found = found.only(is_after[: len(found.times)])
    return replace(found, backwards=len(times) - len(found.times))
