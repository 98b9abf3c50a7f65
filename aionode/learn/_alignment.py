"""Rows of a data set from the messages of topics: everything as of the time of an image.

On a grid of equal steps, the age of each image would depend on where the grid happens to
begin, and differ between episodes. So each message of the reference makes a row, and a row is
dropped if something in it is too old.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from aionode.learn._series import Floats, Ints, Series
    from aionode.learn.contract import Action, Contract, Observation

__all__ = [
    "MAX_GAP",
    "Aligned",
    "aligned",
    "pictures_per_row",
]

MAX_GAP: Final = 1.5
"""Maximum periods between two rows of one episode."""

MAX_SEC: Final = 2000.0
"""Maximum seconds of an episode: readers compare times, 32-bit floats, to within 0.1 ms."""

ROUNDING_NS: Final = 1000
"""How late a message may be and still count: periods are not whole nanoseconds."""


@dataclass(slots=True)
class Aligned:
    """The rows of a recording.

    Attributes:
        times: The time of each row in nanoseconds.
        chosen: For each entry, the position in its series of the message for each row.
        ages: For each entry, the age of that message in seconds.
        values: For each entry, the numbers of each row.
        starts: The first row of each episode.
        references: The number of messages that could have made rows.
        stale: For each entry, the number of rows dropped because it, alone or with others, was too
            old.
        gaps: The gaps between rows that are too long, in seconds.
    """

    times: Ints
    chosen: list[Ints]
    ages: list[Floats]
    values: list[Floats]
    starts: list[int]
    references: int
    stale: list[int]
    gaps: list[float]

    @property
    def ends(self) -> list[int]:
        """The row after the last one of each episode."""
        return [*self.starts[1:], len(self.times)] if self.starts else []


def aligned(contract: Contract, series: Sequence[Series]) -> Aligned:
    """Return the rows made from messages.

    Args:
        contract: The contract.
        series: The messages of each of its entries.
    """
    times = references(contract, series[contract.entries.index(contract.main)].times)
    period_ns = 1e9 / contract.fps
    found = [
        sampled(
            each,
            times + (round(period_ns) if position >= len(contract.observations) else 0),
            contract.max_age(entry),
            is_interpolated=entry.is_interpolated,
        )
        for position, (entry, each) in enumerate(zip(contract.entries, series, strict=True))
    ]
    stale = [
        ages > max_age_of(contract, entry)
        for entry, (_, ages, _) in zip(contract.entries, found, strict=True)
    ]
    is_kept = ~np.logical_or.reduce(stale)
    kept = times[is_kept]
    steps = np.diff(kept)
    is_gap = steps > MAX_GAP * period_ns
    starts = [0, *(np.flatnonzero(is_gap) + 1).tolist()] if len(kept) else []
    return Aligned(
        kept,
        [chosen[is_kept] for chosen, _, _ in found],
        [ages[is_kept] for _, ages, _ in found],
        [values[is_kept] for _, _, values in found],
        shortened(starts, len(kept), int(MAX_SEC * contract.fps)),
        len(times),
        [int(each.sum()) for each in stale],
        (steps[is_gap] / 1e9).tolist(),
    )


def max_age_of(contract: Contract, entry: Observation | Action) -> float:
    """Return the age in seconds above which a row is dropped, with room for rounding."""
    return contract.max_age(entry) + 1e-9


def references(contract: Contract, times: Ints) -> Ints:
    """Return the times that make rows: every second one of a camera at twice the rate."""
    if len(times) < 2:
        return times
    step = float(np.median(np.diff(times)))
    every = pictures_per_row(1e9 / step, contract.fps) if step > 0 else 1
    if every == 1:
        return times
    least = (every - 0.5) * step
    kept = [int(times[0])]
    for time in times.tolist():
        if time - kept[-1] >= least:
            kept.append(time)
    return np.array(kept, np.int64)


def pictures_per_row(rate_hz: float, fps: int) -> int:
    """Return how many images of a camera there are per row."""
    return max(round(rate_hz / fps), 1)


def sampled(
    series: Series, times: Ints, max_age: float, *, is_interpolated: bool
) -> tuple[Ints, Floats, Floats]:
    """Return for each time the last message up to it: its position, age in seconds and numbers.

    Numbers are interpolated if the next message is within `max_age` as well. The age
    is infinite if there is no message.
    """
    count = len(series.times)
    if not count:
        nothing = np.zeros((len(times), series.values.shape[1]))
        return np.zeros(len(times), np.int64), np.full(len(times), np.inf), nothing
    places = np.searchsorted(series.times, times + ROUNDING_NS, side="right") - 1
    chosen = np.maximum(places, 0)
    ages = np.where(places < 0, np.inf, np.maximum(times - series.times[chosen], 0) / 1e9)
    values = series.values[chosen]
    if is_interpolated and values.shape[1]:
        following = np.minimum(chosen + 1, count - 1)
        spans = (series.times[following] - series.times[chosen]) / 1e9
        is_near = (spans > 0) & (ages <= max_age) & (spans - ages <= max_age)
        share = np.where(is_near, ages, 0) / np.where(is_near, spans, 1)
        values = values + share[:, None] * (series.values[following] - values)
    return chosen, ages, values


def shortened(starts: list[int], count: int, longest: int) -> list[int]:
    """Return the starts of episodes, split so that none has more than `longest` rows."""
    return [
        first for start, end in pairwise([*starts, count]) for first in range(start, end, longest)
    ]
