"""Limits of a speed, its acceleration and its jerk, as in control_toolbox's ``RateLimiter``."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

__all__ = ["SpeedLimiter"]


@dataclass(frozen=True)
class Range:
    """The values between a minimum and a maximum; all values if there is no maximum."""

    least: float
    greatest: float

    @classmethod
    def of(cls, least: float, greatest: float, what: str) -> Range:
        """Return a range; the minimum is the negated maximum if it is NaN.

        Raises:
            ValueError: The minimum is above the maximum.
        """
        if math.isnan(greatest):
            return cls(-math.inf, math.inf)
        if math.isnan(least):
            least = -greatest
        if least > greatest:
            raise ValueError(f"Invalid {what} limits: {least:g} is above {greatest:g}")
        return cls(least, greatest)

    def clamp(self, value: float) -> float:
        """Return the value in the range that is nearest to `value`."""
        return min(max(value, self.least), self.greatest)


class SpeedLimiter:
    """The limits of one direction, such as ``linear.x``.

    Args:
        given: Returns the value of a parameter below the name of the direction, by its last part;
            NaN if it is not set.

    Raises:
        ValueError: Limits contradict each other.
    """

    def __init__(self, given: Callable[[str], Any]) -> None:
        self.speed = Range.of(given("min_velocity"), given("max_velocity"), "velocity")
        speeding, braking = given("max_acceleration"), given("max_deceleration")
        speeding_back, braking_back = (
            given(f"max_{name}_reverse") for name in ("acceleration", "deceleration")
        )
        self.at_rest = Range.of(speeding_back, speeding, "acceleration")
        if not math.isnan(speeding):
            braking = self.at_rest.least if math.isnan(braking) else braking
            braking_back = speeding if math.isnan(braking_back) else braking_back
        self.forward = Range.of(braking, speeding, "acceleration")
        self.backward = Range.of(
            self.at_rest.least,
            braking_back if math.isfinite(speeding) else math.nan,
            "deceleration",
        )
        self.jerk = Range.of(given("min_jerk"), given("max_jerk"), "jerk")

    def limit(self, speed: float, last: float, second_to_last: float, period_sec: float) -> float:
        """Return the allowed speed that is nearest to `speed`, after two earlier ones."""
        change, change_before = speed - last, last - second_to_last
        if (change - change_before) * change > 0:  # speeding up
            square = period_sec * period_sec
            jerk = self.jerk.clamp((change - change_before) / square) * square if square else 0.0
            speed = last + change_before + jerk
        allowed = self.forward if last > 0 else self.backward if last < 0 else self.at_rest
        least, greatest = allowed.least * period_sec, allowed.greatest * period_sec
        speed = last + min(max(speed - last, least), greatest)
        return self.speed.clamp(speed)
