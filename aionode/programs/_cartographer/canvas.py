"""Paints submaps into one grid, with the rules of cartographer's submap_painter and of cairo."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np

from aionode.programs._cartographer.submaps import Array, Submap

__all__ = ["Base", "Canvas"]

PADDING: Final = 5
"""The cells around all submaps."""

MAX_SIDE: Final = 32_767
"""The longest side of a picture in cairo."""

MAX_CELLS: Final = 1 << 26
"""The most cells of a map: up to 600 MB while it is painted."""

STROKE: Final = 1 << 20
"""How many cells of a submap are read at a time: each cell of the map needs four or more."""

DOWNSCALED: Final = 4 / 3
"""From this many cells of a submap per cell of the map on, their mean is taken, as in cairo."""

WIDEST: Final = 16.0
"""The most cells of a submap, in each direction, that count for one cell of the map."""

ACTIVE: Final = 2
"""How many of the last submaps Cartographer is still changing."""

SMALLEST: Final = 1e-12
"""The least part of a cell of the map that a cell of a submap has to cover."""

MEDIUM: Final = 128
"""The intensity before the first submap."""

UNKNOWN: Final = -1

OCCUPANCY: Final = np.floor((1 - np.arange(256) / 255) * 100 + 0.5).astype(np.int8)
"""The occupancy in percent, by intensity."""


class Base(NamedTuple):
    """The part of a map that seldom changes.

    Attributes:
        submaps: The submaps in it.
        start: Where the origin of the frame is, in cells.
        intensity: What is painted.
        seen: Which cells are painted.
    """

    submaps: list[Submap]
    start: tuple[float, float]
    intensity: Array
    seen: Array


class Canvas:
    """A map in the making.

    Args:
        submaps: The submaps; later ones are painted over earlier ones.
        resolution: The side of a cell in metres.
        base: That of an earlier map, with which this one begins if it can.

    Attributes:
        origin: The lower left corner of the map, in metres.
        base: The map without the submaps that will have changed next time; None if there is none.

    Raises:
        ValueError: The map would be too large.
    """

    def __init__(
        self, submaps: Sequence[Submap], resolution: float, base: Base | None = None
    ) -> None:
        placed = []
        corners = []
        with np.errstate(over="ignore", invalid="ignore"):
            for submap in submaps:
                matrix, shift = (part / resolution for part in submap.affine())
                placed.append((matrix, shift, submap.texture.cells))
                corners.append(corners_of(submap.texture.cells, 0.0) @ matrix.T + shift)
            # Single precision, as in the original, or the size would sometimes differ by one.
            pixels = np.concatenate(corners).astype(np.float32)
            low = pixels.min(axis=0)
            size = np.ceil(pixels.max(axis=0) - low) + 2 * PADDING
        if not (size.max() <= MAX_SIDE and float(size[0]) * float(size[1]) <= MAX_CELLS):
            raise ValueError(
                f"the submaps need a map of {size[0]:.0f} x {size[1]:.0f} cells; at most "
                f"{MAX_CELLS}, and {MAX_SIDE} in each direction, can be used"
            )
        width, height = (int(length) for length in size)
        start = np.float32(PADDING) - low
        self.placed = [
            (matrix, shift + start.astype(float), cells) for matrix, shift, cells in placed
        ]
        self.submaps = list(submaps)
        self.start = (float(start[0]), float(start[1]))
        self.base: Base | None = None
        self.done = 0
        if base is not None and self.begins_with(base, (height, width)):
            self.base = base
            self.intensity, self.seen = base.intensity.copy(), base.seen.copy()
            self.done = len(base.submaps)
        else:
            self.intensity = np.full((height, width), MEDIUM, np.uint8)
            self.seen = np.zeros((height, width), np.uint8)
        self.origin = (-self.start[0] * resolution, (self.start[1] - height) * resolution)

    def begins_with(self, base: Base, shape: tuple[int, int]) -> bool:
        """Return whether the first submaps have been painted in the same cells."""
        count = len(base.submaps)
        same_cells = (base.start, base.seen.shape) == (self.start, shape)
        return same_cells and self.submaps[:count] == base.submaps

    def strokes(self) -> Iterator[bool]:
        """Paint the submaps, in order; yield True after each part, which takes a moment."""
        for at, (matrix, shift, cells) in enumerate(self.placed):
            if at < self.done:
                continue
            if at == len(self.placed) - ACTIVE and at > self.done:
                layers = self.intensity.copy(), self.seen.copy()
                self.base = Base(self.submaps[:at], self.start, *layers)
            back = inverse(matrix)
            if back is None:
                continue
            brush = Brush(cells, back, shift)
            corners = corners_of(cells, brush.margin) @ matrix.T + shift
            limits = self.seen.shape[::-1]
            left, top = (int(each) for each in np.clip(np.floor(corners.min(axis=0)), 0, limits))
            right, bottom = (int(each) for each in np.clip(np.ceil(corners.max(axis=0)), 0, limits))
            rows = max(1, STROKE // (brush.taps * max(1, right - left)))
            for row in range(top, bottom, rows):
                area = (slice(row, min(row + rows, bottom)), slice(left, right))
                self.paint(area, brush)
                yield True

    def paint(self, area: tuple[slice, slice], brush: Brush) -> None:
        """Paint a part of a submap over what is there."""
        inside, (intensity, opacity, seen) = brush.sample(*area)
        for layer, over in ((self.intensity[area], intensity), (self.seen[area], seen)):
            under = layer[inside] * (255 - opacity) + 128
            layer[inside] = np.minimum(255, over + ((under >> 8) + under >> 8))

    def occupancy(self) -> Array:
        """Return the occupancies of the map, with the lowest row first."""
        seen, intensity = self.seen[::-1], self.intensity[::-1]
        return np.where(seen, OCCUPANCY[intensity], np.int8(UNKNOWN))


def inverse(matrix: Array) -> Array | None:
    """Return the inverse of a matrix; None if a submap that it places cannot be drawn.

    Such a submap is seen from the side, or far smaller than a cell of the map.
    """
    (a, b), (c, d) = matrix.tolist()
    determinant = a * d - b * c
    if abs(determinant) < SMALLEST:
        return None
    rows = (d, -b), (-c, a)
    return np.array([[value / determinant for value in row] for row in rows])


def corners_of(cells: Array, margin: float) -> Array:
    """Return the corners of a submap, in its cells, and a margin around it."""
    height, width = cells.shape[:2]
    sides = (-margin, width + margin), (-margin, height + margin)
    return np.array([(x, y) for x in sides[0] for y in sides[1]])


class Brush:
    """A submap that can be sampled at the cells of a map.

    Args:
        cells: The cells of the submap.
        back: The matrix from the cells of the map to those of the submap.
        shift: The first cell of the submap, in the map.
    """

    def __init__(self, cells: Array, back: Array, shift: Array) -> None:
        self.back = back
        self.shift = shift
        # How many cells of the submap count for one of the map, in each direction.
        steps = np.hypot(back[:, 0], back[:, 1])
        self.reaches = np.where(steps < DOWNSCALED, 1.0, np.minimum(steps, WIDEST))
        self.taps = int(np.prod(np.ceil(self.reaches) + 1))
        self.margin = int(np.ceil(self.reaches.max()))
        self.limits = np.array(cells.shape[1::-1]) + self.margin
        self.width = cells.shape[1] + 4 * self.margin
        around = ((2 * self.margin, 2 * self.margin),) * 2
        self.cells = np.pad(cells, (*around, (0, 0))).reshape(-1, 3)

    def sample(self, rows: slice, columns: slice) -> tuple[Array, Array]:
        """Return which cells of an area the submap covers, and what it has there."""
        x = np.arange(columns.start, columns.stop) + (0.5 - self.shift[0])
        y = np.arange(rows.start, rows.stop)[:, None] + (0.5 - self.shift[1])
        places = [to_x * x + to_y * y for to_x, to_y in self.back]
        inside = np.logical_and.reduce(
            [
                (place > -self.margin) & (place < limit)
                for place, limit in zip(places, self.limits, strict=True)
            ]
        )
        across, along = (
            list(taps(place[inside], reach))
            for place, reach in zip(places, self.reaches, strict=True)
        )
        sampled = np.zeros((np.count_nonzero(inside), 3), np.float32)
        for row, along_weight in along:
            start = (row + 2 * self.margin) * self.width + 2 * self.margin
            for column, across_weight in across:
                weight = (along_weight * across_weight)[:, None]
                sampled += weight * self.cells[start + column]
        return inside, np.rint(sampled).astype(np.uint16).T


def taps(at: Array, reach: float) -> Iterator[tuple[Array, Array]]:
    """Yield the cells around positions, and their weights, which add up to 1.

    The weight is that of a box as wide as the reach, of interpolated cells.
    """
    half = (reach + 1) / 2
    first = np.ceil(at - half - 0.5).astype(np.int64)
    weights = [
        np.clip(half - np.abs(first + (step + 0.5) - at), 0.0, 1.0)
        for step in range(int(np.ceil(reach)) + 1)
    ]
    total = np.sum(weights, axis=0)
    for step, weight in enumerate(weights):
        yield first + step, (weight / total).astype(np.float32)
