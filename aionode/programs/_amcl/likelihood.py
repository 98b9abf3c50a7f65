"""How well a scan fits a map: the distance from where its beams end to the nearest obstacle."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from aionode.programs._poses import Array

__all__ = ["Field", "Sensor"]

OCCUPIED: Final = 100
FREE: Final = 0
MAX_REACH: Final = 200
"""The number of cells up to which distances are computed: ten metres for cells of 5 cm."""


class Field:
    """The distances to the nearest obstacle on a map.

    Args:
        grid: The map, as `OccupancyGrid`.
        reach: The longest distance, in m; anything farther away counts as that far.
    """

    def __init__(self, grid: Any, reach: float) -> None:
        info = grid.info
        self.reach = reach
        self.resolution = float(info.resolution)
        self.origin = float(info.origin.position.x), float(info.origin.position.y)
        cells = np.asarray(grid.data, dtype=np.int8).reshape(info.height, info.width)
        self.distances = distances_of(cells == OCCUPIED, reach / self.resolution) * self.resolution
        self.free = np.argwhere(cells == FREE)

    def at(self, x: Array, y: Array) -> Array:
        """Return the distances at points; beyond the map they are the longest."""
        column = np.floor((x - self.origin[0]) / self.resolution)
        row = np.floor((y - self.origin[1]) / self.resolution)
        height, width = self.distances.shape
        is_inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        result = np.full(x.shape, self.reach)
        inside = row[is_inside].astype(np.intp), column[is_inside].astype(np.intp)
        result[is_inside] = self.distances[inside]
        return result

    def random_poses(self, count: int, random: np.random.Generator) -> Array:
        """Return poses in free cells."""
        chosen = self.free[random.integers(len(self.free), size=count)]
        x = self.origin[0] + (chosen[:, 1] + 0.5) * self.resolution
        y = self.origin[1] + (chosen[:, 0] + 0.5) * self.resolution
        return np.column_stack([x, y, random.uniform(-math.pi, math.pi, count)])


def distances_of(is_occupied: npt.NDArray[np.bool_], reach: float) -> npt.NDArray[np.float32]:
    """Return the distance of each cell to the nearest occupied one, in cells.

    First along the columns, then, for each distance along the rows, the hypotenuse.
    """
    most = min(math.ceil(reach), MAX_REACH)
    along = np.where(is_occupied, np.float32(0.0), np.float32(np.inf))
    for _ in range(most):
        along[1:] = np.minimum(along[1:], along[:-1] + 1)
        along[:-1] = np.minimum(along[:-1], along[1:] + 1)
        if np.isfinite(along).all():
            break
    squares = along * along
    best = squares.copy()
    for step in range(1, min(most, is_occupied.shape[1] - 1) + 1):
        np.minimum(best[:, step:], squares[:, :-step] + step * step, out=best[:, step:])
        np.minimum(best[:, :-step], squares[:, step:] + step * step, out=best[:, :-step])
    result: npt.NDArray[np.float32] = np.minimum(np.sqrt(best), np.float32(reach))
    return result


@dataclass(frozen=True)
class Sensor:
    """The model of a laser.

    Attributes:
        z_hit: The share of beams that end at obstacles.
        z_rand: The share of those that end anywhere.
        sigma: The standard deviation of the former, in m.
        max_beams: How many beams of a scan are used.
        multiplies: Whether the beams' probabilities are multiplied, instead of adding their cubes,
            which is not a probability but tolerates people and furniture.
    """

    z_hit: float
    z_rand: float
    sigma: float
    max_beams: int
    multiplies: bool

    def chosen(self, count: int) -> slice:
        """Return which beams are used, evenly over the scan."""
        return slice(0, count, max(1, (count - 1) // max(1, self.max_beams - 1)))

    def likelihood(self, poses: Array, points: Array, field: Field, range_max: float) -> Array:
        """Return how likely each pose is.

        Args:
            poses: x, y and the heading of each.
            points: Where the beams end, x and y in the frame of the robot.
            field: The map.
            range_max: The longest range of the laser.
        """
        cosine, sine = np.cos(poses[:, 2:]), np.sin(poses[:, 2:])
        x = poses[:, :1] + cosine * points[:, 0] - sine * points[:, 1]
        y = poses[:, 1:2] + sine * points[:, 0] + cosine * points[:, 1]
        distances = field.at(x, y)
        each = self.z_hit * np.exp(-(distances**2) / (2.0 * self.sigma**2))
        each += self.z_rand / range_max
        if self.multiplies:
            logarithm = np.log(np.maximum(each, 1e-300)).sum(axis=1)
            # Only ratios count, and products of many beams would be too small for numbers.
            result: Array = np.exp(logarithm - logarithm.max(initial=-math.inf))
            return result
        return np.asarray(1.0 + (each**3).sum(axis=1))
