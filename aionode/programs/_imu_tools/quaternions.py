"""Quaternions as tuples, the scalar first."""

from __future__ import annotations

import math

__all__ = ["Quaternion", "Vector", "blended", "inverse", "product", "rotated", "tilt", "unit"]

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]


def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Return the product of two rotations; the right one is applied first."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


def inverse(q: Quaternion) -> Quaternion:
    """Return the inverse of a rotation."""
    return q[0], -q[1], -q[2], -q[3]


def rotated(vector: Vector, q: Quaternion) -> Vector:
    """Rotate a vector."""
    _, x, y, z = product(product(q, (0.0, *vector)), inverse(q))
    return x, y, z


def unit(q: Quaternion) -> Quaternion:
    """Return a quaternion of length 1."""
    norm = math.hypot(*q)
    return q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm


def blended(q: Quaternion, gain: float) -> Quaternion:
    """Return a fraction of a rotation: none of it for 0, all of it for 1."""
    if q[0] < 0.0:  # more than half a turn: along the arc, since the straight line may meet zero
        angle = math.acos(max(-1.0, q[0]))
        if (sine := math.sin(angle)) > 0.0:
            rest, part = math.sin(angle * (1.0 - gain)) / sine, math.sin(angle * gain) / sine
            return unit((rest + part * q[0], part * q[1], part * q[2], part * q[3]))
    return unit((1.0 - gain + gain * q[0], gain * q[1], gain * q[2], gain * q[3]))


def tilt(up: Vector) -> Quaternion:
    """Return the rotation, without a turn about the vertical, from up to a direction."""
    norm = math.hypot(*up)
    x, y, z = up[0] / norm, up[1] / norm, up[2] / norm
    if z >= 0.0:
        half = math.sqrt((z + 1.0) / 2.0)
        return half, -y / (2.0 * half), x / (2.0 * half), 0.0
    half = math.sqrt((1.0 - z) / 2.0)
    return -y / (2.0 * half), half, 0.0, x / (2.0 * half)
