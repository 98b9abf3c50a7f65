"""A virtual trackball: dragging with the mouse rotates the view."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tf_transformations._arrays import (
    EPSILON,
    Array,
    floats,
    unit_vector,
    vector_norm,
)
from tf_transformations._rotations import (
    quaternion_from_matrix,
    quaternion_matrix,
    quaternion_multiply,
    quaternion_slerp,
)

__all__ = [
    "Arcball",
    "arcball_constrain_to_axis",
    "arcball_map_to_sphere",
    "arcball_nearest_axis",
]


class Arcball:
    """A rotation that is changed by dragging points of a ball.

    Args:
        initial: The initial rotation, as a quaternion or 4x4 matrix.

    Raises:
        ValueError: `initial` is neither.
    """

    def __init__(self, initial: npt.ArrayLike | None = None) -> None:
        values = floats((0.0, 0.0, 0.0, 1.0) if initial is None else initial)
        if values.shape == (4, 4):
            values = floats(quaternion_from_matrix(values))
        elif values.shape != (4,):
            raise ValueError(
                f"initial has the shape {values.shape}; use a quaternion or a 4x4 matrix"
            )
        self._now: Array = unit_vector(values)
        self._before = self._at_down = self._now
        self._down = np.array([0.0, 0.0, 1.0])
        self._center = (0.0, 0.0)
        self._radius = 1.0
        self._axes: list[Array] | None = None
        self._axis: Array | None = None
        self._constrains = False

    def place(self, center: Sequence[float], radius: float) -> None:
        """Set the centre and radius of the ball, in window coordinates."""
        self._center = (center[0], center[1])
        self._radius = float(radius)

    def setaxes(self, *axes: npt.ArrayLike) -> None:
        """Set the axes to which rotations are constrained while `setconstrain` is on."""
        self._axes = [unit_vector(axis) for axis in axes]

    def setconstrain(self, constrain: bool) -> None:
        """Set whether rotations are constrained to the axes."""
        self._constrains = constrain is True

    def getconstrain(self) -> bool:
        """Return whether rotations are constrained to the axes."""
        return self._constrains

    def down(self, point: Sequence[float]) -> None:
        """Start dragging at a point of the window."""
        self._down = arcball_map_to_sphere(point, self._center, self._radius)
        self._at_down = self._before = self._now
        self._axis = None
        if self._constrains and self._axes is not None:
            self._axis = arcball_nearest_axis(self._down, self._axes)
        if self._axis is not None:
            self._down = arcball_constrain_to_axis(self._down, self._axis)

    def drag(self, point: Sequence[float]) -> None:
        """Rotate to a point of the window."""
        here = arcball_map_to_sphere(point, self._center, self._radius)
        if self._axis is not None:
            here = arcball_constrain_to_axis(here, self._axis)
        self._before = self._now
        turn = np.cross(self._down, here)
        if np.dot(turn, turn) < EPSILON:
            self._now = self._at_down
        else:
            whole = [*turn, float(np.dot(self._down, here))]
            self._now = floats(quaternion_multiply(whole, self._at_down))

    def next(self, acceleration: float = 0.0) -> None:
        """Continue to rotate in the direction of the last drag."""
        turned = quaternion_slerp(self._before, self._now, 2.0 + acceleration, spin=0)
        self._before, self._now = self._now, turned

    def matrix(self) -> Array:
        """Return the rotation as a 4x4 matrix."""
        return quaternion_matrix(self._now)


def arcball_map_to_sphere(point: Sequence[float], center: Sequence[float], radius: float) -> Array:
    """Return the point of a ball of radius 1 that is seen at a point of the window."""
    x, y = (point[0] - center[0]) / radius, (center[1] - point[1]) / radius
    outside = x * x + y * y
    if outside > 1.0:
        return np.array([x, y, 0.0]) / math.sqrt(outside)
    return np.array([x, y, math.sqrt(1.0 - outside)])


def arcball_constrain_to_axis(point: npt.ArrayLike, axis: npt.ArrayLike) -> Array:
    """Return the point nearest to a given one on the ball's circle about an axis."""
    here, about = floats(point), floats(axis)
    on_plane: Array = here - about * np.dot(about, here)
    length = vector_norm(on_plane)
    if length > EPSILON:
        nearest: Array = on_plane / (length if on_plane[2] >= 0.0 else -length)
        return nearest
    if about[2] == 1.0:
        return np.array([1.0, 0.0, 0.0])
    result: Array = unit_vector([-about[1], about[0], 0.0])
    return result


def arcball_nearest_axis(point: npt.ArrayLike, axes: Sequence[npt.ArrayLike]) -> Array | None:
    """Return the axis whose circle is nearest to a point; None if there are no axes."""
    here = floats(point)
    return max(
        map(floats, axes),
        key=lambda axis: float(np.dot(arcball_constrain_to_axis(here, axis), here)),
        default=None,
    )
