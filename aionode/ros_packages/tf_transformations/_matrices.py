"""4x4 matrices of translations, rotations, reflections, scales, shears and projections."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from tf_transformations._arrays import EPSILON, Array, floats, unit_vector
from tf_transformations._rotations import (
    antisymmetric,
    homogeneous,
    quaternion_about_axis,
    quaternion_matrix,
)

__all__ = [
    "clip_matrix",
    "identity_matrix",
    "projection_from_matrix",
    "projection_matrix",
    "reflection_from_matrix",
    "reflection_matrix",
    "rotation_from_matrix",
    "rotation_matrix",
    "scale_from_matrix",
    "scale_matrix",
    "shear_from_matrix",
    "shear_matrix",
    "translation_from_matrix",
    "translation_matrix",
]

CLOSE = 1e-8
"""Tolerance within which numbers are treated as equal, such as an eigenvalue and 1."""

Projection = tuple[Array, Array, Array | None, Array | None, bool]


def identity_matrix() -> Array:
    """Return the 4x4 identity matrix."""
    return np.identity(4)


def translation_matrix(direction: npt.ArrayLike) -> Array:
    """Return the matrix that moves points by a vector."""
    return homogeneous(np.identity(3), direction)


def translation_from_matrix(matrix: npt.ArrayLike) -> Array:
    """Return the vector by which a matrix moves points."""
    return floats(matrix)[:3, 3].copy()


def fixed_point(matrix: Array) -> Array:
    """Return the fixed point of an affine matrix nearest to the origin.

    Raises:
        ValueError: It moves every point.
    """
    moved = np.identity(3) - matrix[:3, :3]
    point: Array = np.linalg.lstsq(moved, matrix[:3, 3], rcond=CLOSE)[0]
    if not np.allclose(moved @ point, matrix[:3, 3], atol=1e-6):
        raise ValueError("the matrix moves every point; it has to leave a point where it is")
    return point


# Reflections, rotations


def reflection_matrix(point: npt.ArrayLike, normal: npt.ArrayLike) -> Array:
    """Return the matrix of a reflection, given by a point on its plane and the normal."""
    axis: Array = unit_vector(floats(normal, 3))
    mirror = np.identity(3) - 2.0 * np.outer(axis, axis)
    return homogeneous(mirror, 2.0 * np.dot(floats(point, 3), axis) * axis)


def reflection_from_matrix(matrix: npt.ArrayLike) -> tuple[Array, Array]:
    """Return a point on the plane of a reflection, and the normal.

    Raises:
        ValueError: The matrix is not a reflection.
    """
    values = floats(matrix)
    mirror = values[:3, :3]
    twice = np.identity(3) - mirror  # 2 n nᵀ
    if not np.allclose(mirror @ mirror, np.identity(3)) or abs(np.trace(twice) - 2.0) > CLOSE:
        raise ValueError("the matrix is not a reflection: it has to mirror exactly one axis")
    normal: Array = unit_vector(twice[:, np.argmax(np.diag(twice))])
    return fixed_point(values), normal


def rotation_matrix(
    angle: float, direction: npt.ArrayLike, point: npt.ArrayLike | None = None
) -> Array:
    """Return the matrix of a rotation.

    Args:
        angle: The angle, in radians.
        direction: The direction of the axis.
        point: A point on the axis; the origin by default.
    """
    turn = quaternion_matrix(quaternion_about_axis(angle, floats(direction, 3)))
    if point is not None:
        centre = floats(point, 3)
        turn[:3, 3] = centre - turn[:3, :3] @ centre
    return turn


def rotation_from_matrix(matrix: npt.ArrayLike) -> tuple[float, Array, Array]:
    """Return the angle of a rotation in radians, the direction of its axis, and a point on it.

    The point has four components, of which the last is 1.

    Raises:
        ValueError: The matrix is not a rotation, or moves every point.
    """
    values = floats(matrix)
    rotation = values[:3, :3]
    lengths, axes = np.linalg.eigh((rotation + rotation.T) / 2)
    if abs(lengths[-1] - 1.0) > 1e-5:
        raise ValueError("the matrix is not a rotation: it has no axis")
    direction: Array = axes[:, -1]
    angle = math.atan2(
        float(np.dot(direction, antisymmetric(rotation))), float(np.trace(rotation)) - 1.0
    )
    return angle, direction, np.append(fixed_point(values), 1.0)


# Scales, shears


def scale_matrix(
    factor: float, origin: npt.ArrayLike | None = None, direction: npt.ArrayLike | None = None
) -> Array:
    """Return the matrix that scales by a factor; -1 reflects each point at the origin.

    Args:
        factor: The factor.
        origin: The point that stays fixed.
        direction: The only direction to scale; by default all are scaled.
    """
    if direction is None:
        grown = np.identity(3) * (factor - 1.0)
    else:
        axis: Array = unit_vector(floats(direction, 3))
        grown = np.outer(axis, axis) * (factor - 1.0)
    centre = np.zeros(3) if origin is None else floats(origin, 3)
    return homogeneous(np.identity(3) + grown, -grown @ centre)


def scale_from_matrix(matrix: npt.ArrayLike) -> tuple[float, Array, Array | None]:
    """Return the factor of a scale, its origin, and its direction, None for all directions.

    Raises:
        ValueError: The matrix moves every point.
    """
    values = floats(matrix)
    factor = float(np.trace(values[:3, :3])) - 2.0
    lengths, axes = np.linalg.eigh((values[:3, :3] + values[:3, :3].T) / 2)
    (near,) = np.nonzero(np.abs(lengths - factor) < CLOSE)
    if near.size == 0:
        return (factor + 2.0) / 3.0, fixed_point(values), None
    return factor, fixed_point(values), axes[:, near[0]]


def shear_matrix(
    angle: float, direction: npt.ArrayLike, point: npt.ArrayLike, normal: npt.ArrayLike
) -> Array:
    """Return the matrix of a shear: points move in proportion to their distance from a plane.

    Args:
        angle: The angle in radians, whose tangent is the displacement at distance 1.
        direction: The direction of the displacement, in the plane.
        point: A point on the plane.
        normal: The normal of the plane.
    """
    axis: Array = unit_vector(floats(normal, 3))
    way: Array = math.tan(angle) * unit_vector(floats(direction, 3))
    return homogeneous(np.identity(3) + np.outer(way, axis), -np.dot(floats(point, 3), axis) * way)


def shear_from_matrix(matrix: npt.ArrayLike) -> tuple[float, Array, Array, Array]:
    """Return the angle of a shear in radians, its direction, a point of its plane, and the normal.

    Raises:
        ValueError: The matrix moves every point.
    """
    values = floats(matrix)
    left, tangents, right = np.linalg.svd(values[:3, :3] - np.identity(3))
    return math.atan(tangents[0]), left[:, 0], fixed_point(values), right[0]


# Projections


def projection_matrix(
    point: npt.ArrayLike,
    normal: npt.ArrayLike,
    direction: npt.ArrayLike | None = None,
    perspective: npt.ArrayLike | None = None,
    pseudo: bool = False,
) -> Array:
    """Return the matrix of a projection onto a plane, by default along its normal.

    Args:
        point: A point on the plane.
        normal: The normal of the plane.
        direction: The direction of a parallel projection.
        perspective: The centre of a perspective projection.
        pseudo: Keep the depth that a perspective projection would remove.
    """
    on_plane, axis = floats(point, 3), unit_vector(floats(normal, 3))
    distance = float(np.dot(on_plane, axis))
    if perspective is None:
        along = axis if direction is None else floats(direction, 3)
        share = along / np.dot(along, axis)
        return homogeneous(np.identity(3) - np.outer(share, axis), distance * share)
    eye = floats(perspective, 3)
    target = eye + axis if pseudo else eye
    matrix = np.empty((4, 4))
    matrix[:3, :3] = (np.dot(eye, axis) - distance) * np.identity(3) - np.outer(target, axis)
    matrix[:3, 3] = distance * target
    matrix[3, :3] = -axis
    matrix[3, 3] = np.dot(eye, axis)
    return matrix


def projection_from_matrix(matrix: npt.ArrayLike, pseudo: bool = False) -> Projection:
    """Return the arguments of `projection_matrix` for a matrix.

    Args:
        matrix: The matrix of a projection.
        pseudo: Whether a perspective keeps the depth, which cannot be seen from the matrix.

    Raises:
        ValueError: The matrix is not a projection.
    """
    values = floats(matrix)
    length = float(np.linalg.norm(values[3, :3]))
    if length > CLOSE * abs(values[3, 3]):
        return (*of_perspective(values / length, pseudo=pseudo), pseudo)
    values = values / values[3, 3]
    left, lengths, right = np.linalg.svd(values[:3, :3])
    if lengths[-1] > CLOSE:
        raise ValueError("the matrix is not a projection: it removes no direction")
    point, direction, normal = np.append(fixed_point(values), 1.0), right[-1], left[:, -1]
    if abs(abs(np.dot(direction, normal)) - 1.0) < CLOSE:
        return point, normal, None, None, False
    return point, normal, direction, None, False


def of_perspective(values: Array, *, pseudo: bool) -> tuple[Array, Array, None, Array]:
    """Return a point and normal of the plane, no direction, and the centre of the perspective."""
    normal = -values[3, :3]
    # Points of the plane are scaled by the distance of the perspective's centre from the plane.
    scale = (float(np.trace(values)) + float(pseudo)) / 3.0
    target = (scale * np.identity(3) - values[:3, :3]) @ normal
    point = (values[3, 3] - scale) * normal
    return np.append(point, 1.0), normal, None, target - normal if pseudo else target


def clip_matrix(
    left: float,
    right: float,
    bottom: float,
    top: float,
    near: float,
    far: float,
    perspective: bool = False,
) -> Array:
    """Return the matrix that maps a box, or a truncated pyramid, to coordinates from -1 to 1.

    Args:
        left: The smallest x; of a pyramid, at its near end.
        right: The largest x.
        bottom: The smallest y.
        top: The largest y.
        near: The smallest z.
        far: The largest z.
        perspective: A pyramid with its apex at the origin, along z; divide results by their fourth
            component.

    Raises:
        ValueError: A side ends before it begins, or a pyramid begins at its apex.
    """
    low, high = np.array([left, bottom, near], float), np.array([right, top, far], float)
    if np.any(low >= high):
        raise ValueError(
            "the box ends before it begins; use left < right, bottom < top and near < far"
        )
    size, middle = high - low, high + low
    if not perspective:
        return homogeneous(np.diag(2.0 / size), -middle / size)
    if near <= EPSILON:
        raise ValueError(f"near is {near}; it has to be above 0 for a perspective")
    matrix = np.diag([-2.0 * near / size[0], -2.0 * near / size[1], -middle[2] / size[2], 0.0])
    matrix[:2, 2] = middle[:2] / size[:2]
    matrix[2, 3] = 2.0 * near * far / size[2]
    matrix[3, 2] = -1.0
    return matrix
