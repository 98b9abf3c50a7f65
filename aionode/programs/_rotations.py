"""Rotations as URDF and tf2 give them."""

from __future__ import annotations

from math import cos, sin

__all__ = ["quaternion_of_angles"]


def quaternion_of_angles(
    roll: float, pitch: float, yaw: float
) -> tuple[float, float, float, float]:
    """Return x, y, z and w of the rotation about the fixed axes x, then y, then z."""
    sr, cr = sin(roll / 2), cos(roll / 2)
    sp, cp = sin(pitch / 2), cos(pitch / 2)
    sy, cy = sin(yaw / 2), cos(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
