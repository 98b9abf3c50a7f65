"""Poses as plain floats: how they are chained, inverted and interpolated.

A pose is a tuple of seven floats: a translation (x, y, z) and the quaternion of a rotation
(x, y, z, w). The formulas are those of tf2's LinearMath, even for quaternions whose length is not
quite 1, so that results agree with tf2.
"""

from __future__ import annotations

from math import acos, asin, atan2, copysign, cos, pi, sin, sqrt
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

__all__ = ["IDENTITY", "Edge", "Pose", "chained", "composed"]
__all__ += ["angles_of", "from_angles", "given_transform", "interpolated", "inverted", "unit"]

Pose = tuple[float, float, float, float, float, float, float]
"""Translation x, y, z, and rotation x, y, z, w."""

Edge = tuple[Pose, Pose | None, float]
"""A pose; or an older and a newer one, and how far between them the requested time lies."""

IDENTITY: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def interpolated(older: Pose, newer: Pose, ratio: float) -> Pose:
    """Return the pose between two: linear in translation, slerp along the shorter arc in rotation.

    Args:
        older: The pose for the ratio 0.
        newer: The pose for the ratio 1.
        ratio: Between 0 and 1.
    """
    ax, ay, az, ai, aj, ak, aw = older
    bx, by, bz, bi, bj, bk, bw = newer
    rest = 1.0 - ratio
    x = rest * ax + ratio * bx
    y = rest * ay + ratio * by
    z = rest * az + ratio * bz
    dot = ai * bi + aj * bj + ak * bk + aw * bw
    sign = 1.0
    if dot < 0.0:
        dot, sign = -dot, -1.0
    cosine = dot / sqrt(
        (ai * ai + aj * aj + ak * ak + aw * aw) * (bi * bi + bj * bj + bk * bk + bw * bw)
    )
    if cosine >= 1.0:
        return x, y, z, ai, aj, ak, aw
    theta = acos(cosine)
    scale = 1.0 / sin(theta)
    of_older = sin(rest * theta) * scale
    of_newer = sin(ratio * theta) * scale * sign
    return (
        x,
        y,
        z,
        of_older * ai + of_newer * bi,
        of_older * aj + of_newer * bj,
        of_older * ak + of_newer * bk,
        of_older * aw + of_newer * bw,
    )


def composed(outer: Pose, inner: Pose) -> Pose:
    """Return the pose of `inner` seen from where `outer` is seen: first `inner`, then `outer`."""
    tx, ty, tz, i, j, k, w = outer
    x, y, z, bi, bj, bk, bw = inner
    # q v q* for a quaternion of any length, as tf2 rotates
    twice = 2.0 * (i * x + j * y + k * z)
    square = w * w - (i * i + j * j + k * k)
    w2 = 2.0 * w
    return (
        square * x + twice * i + w2 * (j * z - k * y) + tx,
        square * y + twice * j + w2 * (k * x - i * z) + ty,
        square * z + twice * k + w2 * (i * y - j * x) + tz,
        w * bi + i * bw + j * bk - k * bj,
        w * bj + j * bw + k * bi - i * bk,
        w * bk + k * bw + i * bj - j * bi,
        w * bw - i * bi - j * bj - k * bk,
    )


def inverted(pose: Pose) -> Pose:
    """Return the inverse of a pose."""
    x, y, z, i, j, k, w = pose
    return composed((0.0, 0.0, 0.0, -i, -j, -k, w), (-x, -y, -z, 0.0, 0.0, 0.0, 1.0))


def chained(edges: Iterable[Edge]) -> Pose:
    """Return the pose that a series of edges leads to; the innermost edge comes first."""
    total: Pose | None = None
    for older, newer, ratio in edges:
        pose = older if newer is None else interpolated(older, newer, ratio)
        total = pose if total is None else composed(pose, total)
    return IDENTITY if total is None else total


def unit(pose: Pose) -> Pose:
    """Return a pose whose quaternion has length 1, and the sign that tf2 gives it.

    tf2 keeps the rotation of a result as a matrix, and reads the quaternion back from there: w is
    positive if the trace of the matrix is, else the largest of the other components is.
    """
    x, y, z, i, j, k, w = pose
    square = i * i + j * j + k * k + w * w
    if w * w * 4.0 > square:
        leading = w
    else:
        largest = max(i * i, j * j, k * k)
        leading = i if i * i == largest else j if j * j == largest else k
    scale = 1.0 / sqrt(square)
    if leading < 0.0:
        scale = -scale
    return x, y, z, i * scale, j * scale, k * scale, w * scale


def from_angles(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Return the quaternion of a rotation around the fixed axes x, y and z."""
    (sr, cr), (sp, cp), (sy, cy) = ((sin(a / 2), cos(a / 2)) for a in (roll, pitch, yaw))
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def angles_of(matrix: Any) -> tuple[float, float, float]:
    """Return the angles of a rotation around the fixed axes x, y and z, in radians.

    Looking straight up or down, the one around z is 0, as in tf2. The matrix may be rows of numbers
    or an array of numpy.
    """
    down = matrix[2][0]
    roll = atan2(matrix[2][1], matrix[2][2])
    if abs(down) >= 1.0:
        return roll, copysign(pi / 2, -down), 0.0
    return roll, -asin(down), atan2(matrix[1][0], matrix[0][0])


def given_transform(
    numbers: Mapping[str, float],
) -> tuple[tuple[float, float, float], tuple[float, float, float, float]]:
    """Return the translation and the quaternion given by options of static_transform_publisher.

    Args:
        numbers: ``x``, ``y`` and ``z`` in metres; and ``qx``, ``qy``, ``qz`` and ``qw``, or
            ``roll``, ``pitch`` and ``yaw`` in radians. What is left out is 0, and ``qw`` is 1.

    Raises:
        ValueError: both a quaternion and angles are given.
    """
    angles = numbers.keys() & {"roll", "pitch", "yaw"}
    has_quaternion = bool(numbers.keys() & {"qx", "qy", "qz", "qw"})
    if has_quaternion and angles:
        raise ValueError("give either a quaternion or angles (roll, pitch, yaw), not both")
    x, y, z, qx, qy, qz = (numbers.get(name, 0.0) for name in ("x", "y", "z", "qx", "qy", "qz"))
    if has_quaternion:
        return (x, y, z), (qx, qy, qz, numbers.get("qw", 1.0))
    roll, pitch, yaw = (numbers.get(name, 0.0) for name in ("roll", "pitch", "yaw"))
    return (x, y, z), from_angles(roll, pitch, yaw)
