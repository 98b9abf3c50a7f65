"""The velocity of a frame, computed from its poses at two times, with tf2's formulas."""

from __future__ import annotations

from math import acos, floor, sqrt
from typing import TYPE_CHECKING

from aionode.clock import S_TO_NS
from aionode.tf._arithmetic import Pose, composed, unit
from aionode.tf.frame_listing import to_seconds

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Vector", "Velocity", "velocity"]

Vector = tuple[float, float, float]
Velocity = tuple[Vector, Vector]
"""Linear in m/s, and angular in rad/s."""

SMALL = 10.0 * 2.220446049250313e-16
"""Below this squared sine of half the angle, a rotation has no axis."""


def velocity(
    look_up: Callable[[str, str, int], Pose],
    latest_ns: int,
    frames: tuple[str, str, str, str],
    point: Vector,
    time_ns: int,
    interval_ns: int,
) -> Velocity:
    """Return the velocity of a point that moves with a frame.

    Args:
        look_up: Returns the pose of a frame in another at a time: (target, source, time_ns).
        latest_ns: The newest time at which the frame is known.
        frames: The moving frame, the observing frame, the frame of the axes, and the frame of the
            point.
        point: The point.
        time_ns: The middle of the interval.
        interval_ns: The averaging interval.
    """
    tracking, observation, reference, point_frame = frames
    time_sec, interval_sec = to_seconds(time_ns), to_seconds(interval_ns)
    end_sec = min(time_sec + interval_sec * 0.5, to_seconds(latest_ns))
    start_sec = max(0.00001 + interval_sec, end_sec) - interval_sec
    start = look_up(observation, tracking, from_seconds(start_sec))
    end = look_up(observation, tracking, from_seconds(end_sec))
    elapsed_sec = end_sec - start_sec  # differs from the interval if that started before time 0
    axis, angle = axis_and_angle(start, end)
    turn = scaled(rotated(start, axis), angle / elapsed_sec)
    shift = scaled((end[0] - start[0], end[1] - start[1], end[2] - start[2]), 1 / elapsed_sec)
    at = from_seconds(time_sec)
    seen = look_up(reference, tracking, at)
    angular = rotated(seen, turn)
    linear = added(rotated(seen, shift), cross(seen[:3], angular))
    moved = composed(look_up(reference, point_frame, at), (*point, 0.0, 0.0, 0.0, 1.0))
    # Component by component instead of a cross product, as in tf2.
    offset = (moved[0] - seen[0], moved[1] - seen[1], moved[2] - seen[2])
    linear = added(linear, (angular[0] * offset[0], angular[1] * offset[1], angular[2] * offset[2]))
    return linear, angular


def from_seconds(time_sec: float) -> int:
    """Convert seconds to nanoseconds, rounded like tf2."""
    whole = floor(time_sec)
    return whole * S_TO_NS + floor((time_sec - whole) * 1e9 + 0.5)


def axis_and_angle(start: Pose, end: Pose) -> tuple[Vector, float]:
    """Return the rotation from one pose to another, in the axes of the first."""
    back = (0.0, 0.0, 0.0, -start[3], -start[4], -start[5], start[6])
    _, _, _, i, j, k, w = unit(composed(back, (0.0, 0.0, 0.0, *end[3:])))
    square = 1.0 - w * w
    angle = 2.0 * acos(max(-1.0, min(1.0, w)))
    if square < SMALL:
        return (1.0, 0.0, 0.0), angle
    sine = sqrt(square)
    return (i / sine, j / sine, k / sine), angle


def rotated(pose: Pose, vector: Vector) -> Vector:
    """Rotate a vector by the rotation of a pose."""
    turned = composed((0.0, 0.0, 0.0, *pose[3:]), (*vector, 0.0, 0.0, 0.0, 1.0))
    return turned[:3]


def scaled(vector: Vector, factor: float) -> Vector:
    """Return a vector times a number."""
    return vector[0] * factor, vector[1] * factor, vector[2] * factor


def added(a: Vector, b: Vector) -> Vector:
    """Return the sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return the cross product of two vectors."""
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
