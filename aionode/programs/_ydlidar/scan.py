"""The points of a revolution as a message."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.programs._ydlidar.packets import Points

__all__ = ["Form", "joined", "scan_of"]

ROUNDING: Final = 1e-6
"""The part of a step by which the last angle may be missed."""


class Form(NamedTuple):
    """What a scan contains.

    Attributes:
        frame_id: The frame of the lidar.
        angles: The first and the last angle, in radians.
        ranges: The least and the greatest range, in metres.
        ignored: Pairs of angles between which no ranges are used, in radians.
        is_turned: Whether the zero of the lidar is at the back.
        is_mirrored: Whether angles are counted counterclockwise, unlike by the lidar.
        missing: The value for a range that was not measured.
    """

    frame_id: str
    angles: tuple[float, float]
    ranges: tuple[float, float]
    ignored: tuple[tuple[float, float], ...]
    is_turned: bool
    is_mirrored: bool
    missing: float

    def angles_of(self, points: Points, offset: float) -> npt.NDArray[np.float64]:
        """Return the angles of points, from -π to π."""
        angles = points.angles + offset + (math.pi if self.is_turned else 0.0)
        if self.is_mirrored:
            angles = -angles
        return math.pi - (math.pi - angles) % math.tau


def joined(parts: list[Points]) -> Points:
    """Return the points of several packets."""
    return Points(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def scan_of(points: Points, form: Form, count: int, offset: float) -> LaserScan:
    """Return a scan, without its time.

    Args:
        points: The points of a revolution.
        form: What the scan contains.
        count: The number of steps of a whole revolution, at least two.
        offset: The angle of the lidar's zero, in radians.
    """
    first, last = form.angles
    least, greatest = form.ranges
    angles = form.angles_of(points, offset)
    is_used = (points.ranges > 0.0) & (points.ranges >= least) & (points.ranges <= greatest)
    for begin, end in form.ignored:
        is_used &= (angles < begin) | (angles > end)
    increment = math.tau / (count - 1)
    size = int((last - first) / increment + ROUNDING) + 1
    ranges = np.full(size, form.missing, np.float32)
    intensities = np.zeros(size, np.float32)
    steps = np.ceil((angles - first) / increment - ROUNDING).astype(np.int64)
    is_inside = (angles >= first) & (angles <= last) & (steps < size)
    intensities[steps[is_inside]] = points.intensities[is_inside]
    is_used &= is_inside
    ranges[steps[is_used]] = points.ranges[is_used]
    intensities[steps[is_used]] = points.intensities[is_used]
    scan = LaserScan(
        angle_min=first, angle_max=last, angle_increment=increment, range_min=least,
        range_max=greatest, ranges=ranges, intensities=intensities,
    )  # fmt: skip
    scan.header.frame_id = form.frame_id
    return scan
