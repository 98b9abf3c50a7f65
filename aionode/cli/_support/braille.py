"""Draws numbers over time with Braille characters, each of which has two by four dots."""

from __future__ import annotations

import math
import sys
from collections import deque
from dataclasses import dataclass, field
from itertools import islice
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

__all__ = ["COLOURS", "Line", "chart"]

MAX_POINTS: Final = 10_000
"""Maximum number of points of a line; beyond it, every four become their lowest and highest."""

COLOURS: Final = ("blue", "red", "green", "yellow", "magenta", "cyan")
"""The colours of lines, in order, by rich's names."""

BLANK: Final = 0x2800

DOTS: Final = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
"""The bit of each dot in a character, by row and column."""

LABEL: Final = 10
"""The width of a label and the axis behind it, in characters."""

MIN_WIDTH: Final = LABEL + 10


@dataclass(slots=True)
class Line:
    """One number over time.

    Attributes:
        name: Its name in the legend.
        keep_ns: How long values are kept, in nanoseconds; None for all of them.
        points: Times in nanoseconds, and values; a value that is not finite is a gap.
    """

    name: str
    keep_ns: int | None = None
    points: deque[tuple[int, float]] = field(default_factory=deque)

    def add(self, time_ns: int, value: float) -> None:
        """Add a value; start over when time goes backwards, as when a bag starts again."""
        points = self.points
        if points and time_ns < points[-1][0]:
            points.clear()
        points.append((time_ns, value))
        if self.keep_ns is not None:
            while points[0][0] < time_ns - self.keep_ns:
                points.popleft()
        if len(points) > MAX_POINTS:
            self.points = thinned(points)

    def between(self, start_ns: int, end_ns: int) -> list[tuple[int, float]]:
        """Return the points in a time span."""
        return [point for point in self.points if start_ns <= point[0] <= end_ns]


def thinned(points: deque[tuple[int, float]]) -> deque[tuple[int, float]]:
    """Return about half of the points, the lowest and highest of every four: they look the same."""
    newest = points.pop()
    kept: deque[tuple[int, float]] = deque()
    waiting = iter(points)
    while group := list(islice(waiting, 4)):
        gaps = [point for point in group if not math.isfinite(point[1])]
        finite = [point for point in group if math.isfinite(point[1])]
        of_group = gaps[:1]
        if finite:
            of_group += [min(finite, key=value_of), max(finite, key=value_of)]
        kept.extend(sorted(set(of_group)))
    kept.append(newest)
    return kept


def value_of(point: tuple[int, float]) -> float:
    """Return the value of a point."""
    return point[1]


def chart(
    lines: Sequence[Line], *, width: int, height: int, start_ns: int, end_ns: int
) -> list[tuple[str, str]]:
    """Return a chart of lines as pieces of text, each with the name of its colour, if any.

    Args:
        lines: The lines to draw, all on one scale.
        width: Number of characters in a row.
        height: Number of rows, including the axis and the legend of each line.
        start_ns: The time at the left edge.
        end_ns: The time at the right edge.
    """
    columns = max(width, MIN_WIDTH) - LABEL
    rows = max(height - 1 - len(lines), 3)
    shown = [line.between(start_ns, end_ns) for line in lines]
    low, high = scale_of(value for points in shown for _, value in points)
    canvas = Canvas(columns, rows)
    for number, points in enumerate(shown):
        canvas.draw(points, number, start_ns, end_ns, low, high)
    pieces: list[tuple[str, str]] = []
    for row in range(rows):
        value = high - (high - low) * (row + 0.5) / rows
        label = f"{value:.4g}" if row % 3 == 0 or row == rows - 1 else ""
        pieces.append((f"{label[: LABEL - 2]:>{LABEL - 2}} ┤", ""))
        for bits, owner in zip(canvas.bits[row], canvas.owners[row], strict=True):
            pieces.append((chr(BLANK | bits), COLOURS[owner % len(COLOURS)] if bits else ""))
        pieces.append(("\n", ""))
    seconds = (end_ns - start_ns) / 1e9
    left, right = f"-{seconds:.3g} s", "0"
    pieces.append((f"{'':{LABEL - 1}}└{left}{right:─>{columns - len(left)}}\n", ""))
    for number, (line, points) in enumerate(zip(lines, shown, strict=True)):
        newest = f"{points[-1][1]:.6g}" if points else "nothing yet"
        text = f"{'':{LABEL}}{line.name}: {newest}"[:width]
        pieces.append((text + "\n" * (number + 1 < len(lines)), COLOURS[number % len(COLOURS)]))
    return pieces


def scale_of(values: Iterable[float]) -> tuple[float, float]:
    """Return the least and the greatest value to show, with some space around the values."""
    finite = [value for value in values if math.isfinite(value)]
    if not finite:
        return -1.0, 1.0
    low, high = min(finite), max(finite)
    spare = (high / 2 - low / 2) * 0.1 or abs(high) * 0.1 or 1.0
    return max(low - spare, -sys.float_info.max), min(high + spare, sys.float_info.max)


class Canvas:
    """Dots in characters.

    Args:
        columns: Number of characters in a row.
        rows: Number of rows.

    Attributes:
        bits: The dots of each character.
        owners: The number of the line that was drawn last in each character.
    """

    def __init__(self, columns: int, rows: int) -> None:
        self.bits = [[0] * columns for _ in range(rows)]
        self.owners = [[0] * columns for _ in range(rows)]
        self._width, self._height = 2 * columns, 4 * rows

    def draw(
        self,
        points: Iterable[tuple[int, float]],
        number: int,
        start_ns: int,
        end_ns: int,
        low: float,
        high: float,
    ) -> None:
        """Draw a line through points."""
        before: tuple[int, int] | None = None
        for time_ns, value in points:
            if not math.isfinite(value):
                before = None
                continue
            x = (time_ns - start_ns) * (self._width - 1) // max(end_ns - start_ns, 1)
            share = (value / 2 - low / 2) / (high / 2 - low / 2)  # halves: the range may overflow
            y = min(max(round((1 - share) * (self._height - 1)), 0), self._height - 1)
            self._connect(before or (x, y), (x, y), number)
            before = (x, y)

    def _connect(self, start: tuple[int, int], end: tuple[int, int], number: int) -> None:
        steps = max(abs(end[0] - start[0]), abs(end[1] - start[1]), 1)
        for step in range(steps + 1):
            x = start[0] + round((end[0] - start[0]) * step / steps)
            y = start[1] + round((end[1] - start[1]) * step / steps)
            self.bits[y // 4][x // 2] |= DOTS[y % 4][x % 2]
            self.owners[y // 4][x // 2] = number
