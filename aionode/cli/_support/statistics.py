"""Statistics of a stream of messages: rate, bandwidth, age.

Pure computation: nothing is received or printed here.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

__all__ = [
    "Bandwidth",
    "Intervals",
    "Spread",
    "Throughput",
    "Window",
    "size_texts",
    "spread_of",
    "table_text",
]


@dataclass(frozen=True, slots=True)
class Spread:
    """Mean, extremes, population standard deviation and count of durations in nanoseconds."""

    mean: float
    low: int
    high: int
    deviation: float
    count: int

    @property
    def rate_hz(self) -> float:
        """How many of them there are in a second; 0 if they are all zero."""
        return 1e9 / self.mean if self.mean else 0.0


def spread_of(values: Sequence[int]) -> Spread:
    """Return the spread of at least one duration."""
    count = len(values)
    mean = sum(values) / count
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / count)
    return Spread(mean, min(values), max(values), deviation, count)


class Window:
    """The newest durations, and whether any has been added since the last `spread`."""

    def __init__(self, size: int) -> None:
        self._values: deque[int] = deque(maxlen=size)
        self._fresh = False

    def add(self, value_ns: int) -> None:
        """Add a duration; the oldest is dropped when the window is full."""
        self._values.append(value_ns)
        self._fresh = True

    def clear(self) -> bool:
        """Drop all durations; return whether there were any."""
        had = bool(self._values)
        self._values.clear()
        self._fresh = False
        return had

    def spread(self) -> Spread | None:
        """Return the spread, or None if nothing was added since the last call."""
        if not self._fresh:
            return None
        self._fresh = False
        return spread_of(list(self._values))


class Intervals(Window):
    """The time between one message and the next."""

    def __init__(self, size: int) -> None:
        super().__init__(size)
        self._last_ns: int | None = None

    def arrive(self, now_ns: int) -> bool:
        """Record a message; return whether time went backwards, which resets the window."""
        last_ns, self._last_ns = self._last_ns, now_ns
        if last_ns is None:
            return False
        if now_ns < last_ns:
            return self.clear()
        self.add(now_ns - last_ns)
        return False


@dataclass(frozen=True, slots=True)
class Throughput:
    """Bytes per second of the messages in a window, and their sizes in bytes."""

    bytes_per_s: float
    count: int
    mean: float
    low: int
    high: int


class Bandwidth:
    """Sizes and arrival times of the newest messages."""

    def __init__(self, size: int) -> None:
        self._messages: deque[tuple[int, int]] = deque(maxlen=size)

    def arrive(self, now_ns: int, size_bytes: int) -> None:
        """Record a message."""
        self._messages.append((now_ns, size_bytes))

    def rate(self, now_ns: int) -> Throughput | None:
        """Return the rate since the oldest message; None with less than two.

        The oldest message starts the measured time, so its own bytes do not count. The time ends
        with the newest message, or at `now_ns` once the next one is overdue.
        """
        if len(self._messages) < 2:
            return None
        sizes = [size for _, size in self._messages]
        first_ns, last_ns = self._messages[0][0], self._messages[-1][0]
        overdue_ns = now_ns - last_ns - (last_ns - first_ns) / (len(sizes) - 1)
        duration_s = (last_ns - first_ns + max(overdue_ns, 0)) / 1e9
        if duration_s <= 0:
            return None
        total = sum(sizes)
        speed = (total - sizes[0]) / duration_s
        return Throughput(speed, len(sizes), total / len(sizes), min(sizes), max(sizes))


def size_texts(bytes_per_s: float, *sizes: float) -> list[str]:
    """Return the rate and sizes as text, all in the unit that suits the rate."""
    if bytes_per_s < 1e3:
        return [f"{size:.0f} B" for size in (bytes_per_s, *sizes)]
    unit, divisor = ("KB", 1e3) if bytes_per_s < 1e6 else ("MB", 1e6)
    return [f"{size / divisor:.2f} {unit}" for size in (bytes_per_s, *sizes)]


def table_text(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table for a plain terminal."""
    widths = [max(len(row[i]) for row in (header, *rows)) for i in range(len(header))]
    head = "   ".join(word.center(width) for word, width in zip(header, widths, strict=True))
    line = "=" * (sum(widths) + 3 * (len(widths) - 1))
    body = "\n".join(
        "   ".join(word.ljust(width) for word, width in zip(row, widths, strict=True))
        for row in rows
    )
    return f"{head}\n{line}\n{body}\n"
