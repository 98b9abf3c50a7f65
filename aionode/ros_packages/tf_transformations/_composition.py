"""Matrices of several transformations: decomposed, composed, and estimated from points."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from tf_transformations._arrays import Array, floats
from tf_transformations._rotations import (
    Angles,
    euler_from_matrix,
    euler_matrix,
    homogeneous,
    quaternion_matrix,
    rotation_of,
)

__all__ = [
    "compose_matrix",
    "decompose_matrix",
    "orthogonalization_matrix",
    "superimposition_matrix",
]


def decompose_matrix(matrix: npt.ArrayLike) -> tuple[Array, Array, Angles, Array, None]:
    """Decompose a 4x4 matrix into scales, shears, Euler angles and translation.

    The scales are those of x, y and z, the shears x-y, x-z and y-z, the angles in radians about the
    static axes x, y and z. The fifth value, for a perspective, is always None.

    Raises:
        ValueError: The matrix has no inverse.
    """
    values = floats(matrix)
    rotation, upper = rotation_of(values[:3, :3])
    scales = np.diag(upper).copy()
    shears = (upper / scales[:, np.newaxis])[np.triu_indices(3, 1)]
    return scales, shears, euler_from_matrix(rotation), values[:3, 3].copy(), None


def compose_matrix(
    scale: npt.ArrayLike | None = None,
    shear: npt.ArrayLike | None = None,
    angles: npt.ArrayLike | None = None,
    translate: npt.ArrayLike | None = None,
    perspective: npt.ArrayLike | None = None,
) -> Array:
    """Compose a matrix from the results of `decompose_matrix`.

    Args:
        scale: The scales of x, y and z.
        shear: The shears x-y, x-z and y-z.
        angles: Euler angles about the static axes x, y and z, in radians.
        translate: The translation.
        perspective: Ignored.
    """
    upper = np.identity(3)
    if shear is not None:
        upper[np.triu_indices(3, 1)] = floats(shear)
    if scale is not None:
        upper = np.diag(floats(scale)) @ upper
    rotation = np.identity(3) if angles is None else euler_matrix(*floats(angles))[:3, :3]
    return homogeneous(rotation @ upper, (0.0, 0.0, 0.0) if translate is None else translate)


def orthogonalization_matrix(lengths: npt.ArrayLike, angles: npt.ArrayLike) -> Array:
    """Return the matrix from the coordinates of a crystal's cell to orthogonal ones.

    Args:
        lengths: The lengths of the cell's sides.
        angles: The angles between the sides, in degrees.
    """
    a, b, c = floats(lengths)
    radians = np.radians(floats(angles))
    (sine_a, sine_b, _), (cosine_a, cosine_b, cosine_c) = np.sin(radians), np.cos(radians)
    tilt = (cosine_a * cosine_b - cosine_c) / (sine_a * sine_b)
    matrix = np.identity(4)
    matrix[:3, 0] = a * sine_b * math.sqrt(1.0 - tilt * tilt), -a * sine_b * tilt, a * cosine_b
    matrix[1:3, 1] = b * sine_a, b * cosine_a
    matrix[2, 2] = c
    return matrix


def superimposition_matrix(
    v0: npt.ArrayLike, v1: npt.ArrayLike, scaling: bool = False, usesvd: bool = True
) -> Array:
    """Return the matrix that maps points closest to others: a rotation, translation, and scale.

    Args:
        v0: Three or more points, as columns of 3 or 4 components.
        v1: The same number of target points.
        scaling: Scale as well.
        usesvd: Find the rotation by singular values, otherwise by the quaternion of the best
            rotation.

    Raises:
        ValueError: The arrays have different shapes, or fewer than three points.
    """
    start, end = floats(v0, 3), floats(v1, 3)
    if start.shape != end.shape or start.shape[1] < 3:
        raise ValueError(
            f"points of the shapes {start.shape} and {end.shape}; both need the same, with three "
            "columns or more"
        )
    centre0, centre1 = start.mean(axis=1), end.mean(axis=1)
    start, end = start - centre0[:, np.newaxis], end - centre1[:, np.newaxis]
    turn = best_turn(end @ start.T) if usesvd else best_quaternion_turn(start @ end.T)
    if scaling:
        turn = turn * math.sqrt(np.sum(end * end) / np.sum(start * start))
    return homogeneous(turn, centre1 - turn @ centre0)


def best_turn(covariance: Array) -> Array:
    """Return the rotation nearest to a matrix, by its singular values (Kabsch)."""
    left, _, right = np.linalg.svd(covariance)
    if np.linalg.det(left @ right) < 0.0:
        left[:, 2] *= -1.0
    turn: Array = left @ right
    return turn


def best_quaternion_turn(covariance: Array) -> Array:
    """Return the same from the quaternion that is the main axis of a quadratic form (Horn)."""
    trace = float(np.trace(covariance))
    form = np.empty((4, 4))
    form[:3, :3] = covariance + covariance.T - trace * np.identity(3)
    form[3, :3] = form[:3, 3] = [
        covariance[1, 2] - covariance[2, 1],
        covariance[2, 0] - covariance[0, 2],
        covariance[0, 1] - covariance[1, 0],
    ]
    form[3, 3] = trace
    return quaternion_matrix(np.linalg.eigh(form)[1][:, -1])[:3, :3]
