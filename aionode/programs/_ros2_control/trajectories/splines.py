"""Trajectories of joints: the commands at any time, by splines through the given points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

__all__ = ["Point", "Trajectory", "shortest_way"]

Values = Sequence[float]


@dataclass(frozen=True)
class Point:
    """Where the joints are at a time.

    Attributes:
        time_sec: The time since the start of the trajectory.
        positions: The position of each joint.
        velocities: The velocity of each joint; empty if unknown.
        accelerations: The acceleration of each joint; empty if unknown.
        efforts: The effort of each joint; empty if unknown.
    """

    time_sec: float
    positions: Values
    velocities: Values = field(default=())
    accelerations: Values = field(default=())
    efforts: Values = field(default=())

    def complete(self) -> Point:
        """Return the point with zeros for what is unknown."""
        zeros = [0.0] * len(self.positions)
        return replace(
            self,
            velocities=self.velocities or zeros,
            accelerations=self.accelerations or zeros,
            efforts=self.efforts or zeros,
        )


class Trajectory:
    """A path through points, which begins where the joints are.

    Args:
        points: The points, in the order of their times.
        splines: Whether the joints move between points, rather than jump to the next one.

    Attributes:
        points: The points, with the one before the first once it has begun.
    """

    def __init__(self, points: Sequence[Point], *, splines: bool = True) -> None:
        self.points = list(points)
        self.splines = splines
        self.has_begun = False
        self.start: Point | None = None

    @property
    def end_sec(self) -> float:
        """The time of the last point."""
        return self.points[-1].time_sec

    def begin(self, point: Point, wraps: Sequence[bool]) -> None:
        """Begin at a point.

        Args:
            point: Where the joints are.
            wraps: Whether each joint turns without end, so that it takes the shortest way.
        """
        first = self.points[0]
        positions = [
            there - shortest_way(here, there) if is_endless else here
            for here, there, is_endless in zip(point.positions, first.positions, wraps, strict=True)
        ]
        zeros = [0.0] * len(positions)
        start = replace(
            point,
            positions=positions,
            velocities=(point.velocities or zeros) if first.velocities else point.velocities,
            accelerations=(
                (point.accelerations or zeros) if first.accelerations else point.accelerations
            ),
        )
        self.has_begun = True
        if start.time_sec < first.time_sec:
            self.start = start
            self.points.insert(0, start)

    def sample(self, time_sec: float) -> Point:
        """Return the desired point at a time."""
        if time_sec >= self.end_sec:
            return self.points[-1].complete()
        if time_sec <= self.points[0].time_sec:
            return self.points[0].complete()
        index = next(i for i, each in enumerate(self.points) if each.time_sec > time_sec)
        before, after = self.points[index - 1], self.points[index]
        if not self.splines:
            return (before if before is self.start else after).complete()
        return between(before, after, time_sec)


def between(a: Point, b: Point, time_sec: float) -> Point:
    """Interpolate between two points, by a polynomial through all values that both specify."""
    whole, passed = b.time_sec - a.time_sec, time_sec - a.time_sec
    has_velocity = bool(a.velocities and b.velocities)
    has_acceleration = has_velocity and bool(a.accelerations and b.accelerations)
    rows: list[tuple[float, float, float]] = []
    for joint, (start, end) in enumerate(zip(a.positions, b.positions, strict=True)):
        if has_acceleration:
            factors = quintic(
                (start, a.velocities[joint], a.accelerations[joint]),
                (end, b.velocities[joint], b.accelerations[joint]),
                whole,
            )
        elif has_velocity:
            factors = cubic((start, a.velocities[joint]), (end, b.velocities[joint]), whole)
        else:
            factors = [start, (end - start) / whole]
        rows.append(polynomial(factors, passed))
    positions, velocities, accelerations = (list(column) for column in zip(*rows, strict=True))
    share = passed / whole
    efforts = [x + share * (y - x) for x, y in zip(a.efforts, b.efforts, strict=False)]
    return Point(time_sec, positions, velocities, accelerations, efforts).complete()


def cubic(a: tuple[float, float], b: tuple[float, float], t: float) -> list[float]:
    """Return the coefficients of a cubic polynomial between two positions and velocities."""
    (start, start_speed), (end, end_speed) = a, b
    way = end - start
    return [
        start,
        start_speed,
        (3 * way - (2 * start_speed + end_speed) * t) / t**2,
        (-2 * way + (start_speed + end_speed) * t) / t**3,
    ]


def quintic(a: tuple[float, float, float], b: tuple[float, float, float], t: float) -> list[float]:
    """Return the coefficients of a quintic polynomial between positions and two derivatives."""
    (start, v0, a0), (end, v1, a1) = a, b
    way = end - start
    return [
        start,
        v0,
        a0 / 2,
        (20 * way - (12 * v0 + 8 * v1) * t - (3 * a0 - a1) * t**2) / (2 * t**3),
        (-30 * way + (16 * v0 + 14 * v1) * t + (3 * a0 - 2 * a1) * t**2) / (2 * t**4),
        (12 * way - 6 * (v0 + v1) * t - (a0 - a1) * t**2) / (2 * t**5),
    ]


def polynomial(factors: Sequence[float], t: float) -> tuple[float, float, float]:
    """Return the value of a polynomial, and its first and second derivative."""
    value = first = second = 0.0
    for factor in reversed(factors):
        second = second * t + 2 * first
        first = first * t + value
        value = value * t + factor
    return value, first, second


def shortest_way(start: float, end: float) -> float:
    """Return the shortest turn from an angle to another; half a turn keeps its direction."""
    way = math.remainder(end - start, 2 * math.pi)
    if abs(abs(way) - math.pi) < 1e-9:
        return math.copysign(math.pi, end - start)
    return way
