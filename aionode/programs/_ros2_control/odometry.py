"""Computes the pose and speed of a base with two driven sides from its wheels."""

from __future__ import annotations

import math
from collections import deque
from statistics import fmean

__all__ = ["Odometry"]

MIN_SEC = 1e-6
"""The shortest time over which a speed is computed, in seconds."""


class Odometry:
    """The pose and speed of a base.

    Args:
        separation: The distance between the wheels.
        radii: The radius of the left and the right wheels.
        window: Over how many updates the speed is averaged.

    Attributes:
        x: Its position along the x axis.
        y: Its position along the y axis.
        heading: Its direction.
        linear: Its speed.
        angular: How fast it turns.
    """

    def __init__(self, separation: float, radii: tuple[float, float], window: int) -> None:
        self.separation = separation
        self.radii = radii
        self.speeds: deque[tuple[float, float]] = deque(maxlen=window)
        self.positions = (0.0, 0.0)
        self.set(0.0, 0.0, 0.0)

    def set(self, x: float, y: float, heading: float) -> None:
        """Set the pose of the base, standing still."""
        self.x, self.y, self.heading = x, y, heading
        self.linear = self.angular = 0.0
        self.speeds.clear()

    def turn_to(self, left: float, right: float, period_sec: float) -> bool:
        """Move as the wheels turned to these positions; return whether it did."""
        if period_sec < MIN_SEC:
            return False
        if not (math.isfinite(left) and math.isfinite(right)):  # not measured yet
            return False
        before_left, before_right = self.positions
        self.positions = (left, right)
        return self.turn_at(
            (left - before_left) / period_sec, (right - before_right) / period_sec, period_sec
        )

    def turn_at(self, left: float, right: float, period_sec: float) -> bool:
        """Move as the wheels turn at these speeds; return whether it did."""
        if period_sec < MIN_SEC or not (math.isfinite(left) and math.isfinite(right)):
            return False
        left, right = left * self.radii[0], right * self.radii[1]
        linear, angular = (left + right) / 2, (right - left) / self.separation
        self.move(linear, angular, period_sec)
        self.speeds.append((linear, angular))
        self.linear, self.angular = map(fmean, zip(*self.speeds, strict=True))
        return True

    def move(self, linear: float, angular: float, period_sec: float) -> None:
        """Move at a speed."""
        self.linear, self.angular = linear, angular
        way, turn = linear * period_sec, angular * period_sec
        if abs(turn) < MIN_SEC:
            direction = self.heading + turn / 2
            self.x += way * math.cos(direction)
            self.y += way * math.sin(direction)
            self.heading += turn
        else:
            before, radius = self.heading, way / turn
            self.heading += turn
            self.x += radius * (math.sin(self.heading) - math.sin(before))
            self.y -= radius * (math.cos(self.heading) - math.cos(before))
