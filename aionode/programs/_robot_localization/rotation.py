"""Rotations in space as matrices, and as roll, pitch and yaw."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from aionode.interfaces.geometry_msgs.msg import Quaternion

__all__ = ["Array", "angles_of", "matrix_of", "quaternion_of", "wrapped"]

Array = npt.NDArray[np.float64]


def wrapped(angle: Any) -> Any:
    """Return angles between -π and π."""
    return np.arctan2(np.sin(angle), np.cos(angle))


def matrix_of(roll: float, pitch: float, yaw: float) -> Array:
    """Return the matrix of a rotation."""
    sr, cr = math.sin(roll), math.cos(roll)
    sp, cp = math.sin(pitch), math.cos(pitch)
    sy, cy = math.sin(yaw), math.cos(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def angles_of(matrix: Array) -> tuple[float, float, float]:
    """Return roll, pitch and yaw; looking straight up or down, yaw is 0, as in tf2."""
    down = float(matrix[2, 0])
    roll = math.atan2(matrix[2, 1], matrix[2, 2])
    if abs(down) >= 1.0:
        return roll, math.copysign(math.pi / 2, -down), 0.0
    return roll, -math.asin(down), math.atan2(matrix[1, 0], matrix[0, 0])


def quaternion_of(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the quaternion of a rotation."""
    sr, cr = math.sin(roll / 2), math.cos(roll / 2)
    sp, cp = math.sin(pitch / 2), math.cos(pitch / 2)
    sy, cy = math.sin(yaw / 2), math.cos(yaw / 2)
    return Quaternion(
        x=sr * cp * cy - cr * sp * sy,
        y=cr * sp * cy + sr * cp * sy,
        z=cr * cp * sy - sr * sp * cy,
        w=cr * cp * cy + sr * sp * sy,
    )
