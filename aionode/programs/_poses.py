"""Poses and rotations in space as matrices, and angles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from aionode.interfaces.geometry_msgs.msg import Quaternion
from aionode.tf.apply import from_angles, rotation_matrix

__all__ = ["Array", "matrix_of", "pose_matrix", "quaternion_of", "wrapped"]

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


def pose_matrix(place: Any, rotation: Quaternion) -> Array:
    """Return a pose as a matrix; `place` is its point or translation."""
    result = np.eye(4)
    result[:3, :3] = rotation_matrix(rotation)
    result[:3, 3] = place.x, place.y, place.z
    return result


def quaternion_of(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the quaternion of a rotation."""
    x, y, z, w = from_angles(roll, pitch, yaw)
    return Quaternion(x=x, y=y, z=z, w=w)
