"""Rotations and matrices in `ros2_numpy`: the functions of `tf_transformations`."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from tf_transformations import *  # noqa: F403  # the same functions by another name

__all__ = [
    "angle_between_vectors",
    "is_same_quaternion",
    "quaternion_imag",
    "quaternion_real",
    "vector_product",
]


def quaternion_real(quaternion: npt.ArrayLike) -> float:
    """Return w of a quaternion."""
    return float(np.asarray(quaternion)[3])


def quaternion_imag(quaternion: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return x, y and z of a quaternion."""
    return np.array(quaternion, dtype=float)[:3]


def vector_product(v0: npt.ArrayLike, v1: npt.ArrayLike, axis: int = 0) -> npt.NDArray[Any]:
    """Return the vectors perpendicular to pairs of vectors, whose components are along an axis."""
    return np.cross(np.asarray(v0), np.asarray(v1), axis=axis)


def angle_between_vectors(
    v0: npt.ArrayLike, v1: npt.ArrayLike, directed: bool = True, axis: int = 0
) -> Any:
    """Return the angles between vectors, in radians.

    Args:
        v0: Vectors.
        v1: The same number of other vectors.
        directed: Whether opposite vectors are half a turn apart, rather than the same line.
        axis: The axis of their components.
    """
    first, second = np.asarray(v0, dtype=float), np.asarray(v1, dtype=float)
    lengths = np.linalg.norm(first, axis=axis) * np.linalg.norm(second, axis=axis)
    cosine = np.sum(first * second, axis=axis) / lengths
    return np.arccos(np.clip(cosine if directed else np.abs(cosine), -1.0, 1.0))


def is_same_quaternion(q0: npt.ArrayLike, q1: npt.ArrayLike) -> bool:
    """Return whether two quaternions are the same rotation: equal, or each other's negative."""
    first, second = np.asarray(q0, dtype=float), np.asarray(q1, dtype=float)
    return bool(np.allclose(first, second) or np.allclose(first, -second))
