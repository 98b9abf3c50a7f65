"""The filter: it integrates gyroscopes, and gravity and the magnetic field correct the drift.

It is the filter of Valenti, Dryanovski and Xiao, "Keeping a Good Attitude" (Sensors 2015, 15).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from aionode.programs._imu_tools.quaternions import (
    Quaternion,
    Vector,
    blended,
    inverse,
    product,
    rotated,
    tilt,
    unit,
)

__all__ = ["GRAVITY", "ComplementaryFilter"]

GRAVITY: Final = 9.81

# Limits for standing still: deviation from gravity, angular velocity and its change.
STILL_ACCELERATION: Final = 0.1
STILL_VELOCITY: Final = 0.2
STILL_CHANGE: Final = 0.01

# With the adaptive gain, gravity counts less from the first of these relative errors on, and not
# at all from the second: the robot accelerates.
FULL_ERROR: Final = 0.1
NO_ERROR: Final = 0.2

NO_TURN: Final = (1.0, 0.0, 0.0, 0.0)


@dataclass
class ComplementaryFilter:
    """Estimates the orientation of an IMU.

    Attributes:
        gain_acc: The share of the error that gravity corrects at each step, from 0 to 1.
        gain_mag: The same for the magnetic field.
        bias_alpha: The share by which the bias changes at each step, from 0 to 1.
        estimates_bias: Whether to estimate the bias of the gyroscopes while the IMU stands still.
        has_adaptive_gain: Whether gravity counts less while the IMU accelerates.
        bias: The bias of the gyroscopes.
        is_still: Whether the IMU stands still.
    """

    gain_acc: float = 0.01
    gain_mag: float = 0.01
    bias_alpha: float = 0.01
    estimates_bias: bool = True
    has_adaptive_gain: bool = False
    bias: Vector = (0.0, 0.0, 0.0)
    is_still: bool = False
    _world: Quaternion | None = None  # the world as the IMU sees it
    _last: Vector = (0.0, 0.0, 0.0)

    @property
    def orientation(self) -> Quaternion:
        """The orientation of the IMU in the world, whose axes point north and up."""
        return inverse(self._world or NO_TURN)

    def update(
        self, acceleration: Vector, turning: Vector, seconds: float, magnetic: Vector | None = None
    ) -> bool:
        """Update the orientation with a measurement.

        Args:
            acceleration: The acceleration, including gravity, in m/s².
            turning: The angular velocity.
            seconds: The time since the last call.
            magnetic: The magnetic field, in any unit; None if it is unknown.

        Returns:
            Whether it could be used: in free fall, a first measurement shows no way up.
        """
        if not all(map(math.isfinite, (*acceleration, *turning, seconds))):
            return False
        if magnetic is not None and not all(map(math.isfinite, magnetic)):
            magnetic = None
        if self._world is None:
            if not any(acceleration):
                return False
            world = tilt(acceleration)
            if magnetic is not None:
                world = product(world, self._to_north(world, magnetic))
        else:
            if self.estimates_bias:
                self._estimate_bias(acceleration, turning)
            world = self._predicted(self._world, turning, seconds)
            up = rotated(acceleration, inverse(world))
            if any(up):  # not in free fall
                world = product(world, blended(tilt(up), self._gain(acceleration)))
            if magnetic is not None:
                world = product(world, blended(self._to_north(world, magnetic), self.gain_mag))
            world = unit(world)
        if not all(map(math.isfinite, world)):  # products of huge numbers overflow
            return False
        self._world = world
        return True

    def _predicted(self, world: Quaternion, turning: Vector, seconds: float) -> Quaternion:
        """Return the world as the IMU sees it after a turn."""
        x, y, z = (now - bias for now, bias in zip(turning, self.bias, strict=True))
        change = product((0.0, -x, -y, -z), world)
        half = 0.5 * seconds
        return unit(
            (
                world[0] + half * change[0],
                world[1] + half * change[1],
                world[2] + half * change[2],
                world[3] + half * change[3],
            )
        )

    @staticmethod
    def _to_north(world: Quaternion, magnetic: Vector) -> Quaternion:
        """Return the turn about the vertical after which the magnetic field points north."""
        x, y, _ = rotated(magnetic, inverse(world))
        if not (x or y):  # at a magnetic pole
            return NO_TURN
        half = math.atan2(y, x) / 2.0
        return math.cos(half), 0.0, 0.0, math.sin(half)

    def _gain(self, acceleration: Vector) -> float:
        """Return the share of the error that gravity corrects."""
        if not self.has_adaptive_gain:
            return self.gain_acc
        error = abs(math.hypot(*acceleration) - GRAVITY) / GRAVITY
        factor = (NO_ERROR - error) / (NO_ERROR - FULL_ERROR)
        return self.gain_acc * min(1.0, max(0.0, factor))

    def _estimate_bias(self, acceleration: Vector, turning: Vector) -> None:
        """Move the bias towards the angular velocity while the IMU stands still."""
        self.is_still = (
            abs(math.hypot(*acceleration) - GRAVITY) <= STILL_ACCELERATION
            and all(
                abs(now - last) <= STILL_CHANGE
                for now, last in zip(turning, self._last, strict=True)
            )
            and all(
                abs(now - bias) <= STILL_VELOCITY
                for now, bias in zip(turning, self.bias, strict=True)
            )
        )
        if self.is_still:
            x, y, z = (
                bias + self.bias_alpha * (now - bias)
                for now, bias in zip(turning, self.bias, strict=True)
            )
            self.bias = x, y, z
        self._last = turning
