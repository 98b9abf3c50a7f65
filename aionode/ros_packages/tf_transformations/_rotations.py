"""Conversions between quaternions (x, y, z, w), Euler angles and rotation matrices."""

from __future__ import annotations

import math
from itertools import permutations, product
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tf_transformations._arrays import EPSILON, Array, floats, unit_vector

__all__ = [
    "AXES_TO_TUPLE",
    "TUPLE_TO_AXES",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "homogeneous",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "random_rotation_matrix",
    "rotation_of",
]

Angles = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Axes = str | tuple[int, int, int, int]


def sequences() -> dict[str, tuple[int, int, int, int]]:
    """Return the code of each axis sequence: its first axis, parity, repetition and frame.

    ``sxyz`` rotates about the static axes x, y and z; ``rzyx`` about axes that rotate along, which
    is the same sequence backwards.
    """
    codes = {}
    orders = [*permutations("xyz"), *((a, b, a) for a, b in product("xyz", repeat=2) if a != b)]
    for order in orders:
        first, second = "xyz".index(order[0]), "xyz".index(order[1])
        parity = int((first + 1) % 3 != second)
        repetition = int(order[0] == order[2])
        codes["s" + "".join(order)] = (first, parity, repetition, 0)
        codes["r" + "".join(reversed(order))] = (first, parity, repetition, 1)
    return codes


AXES_TO_TUPLE: Final = sequences()
TUPLE_TO_AXES: Final = {code: axes for axes, code in AXES_TO_TUPLE.items()}


def static_sequence(axes: Axes) -> tuple[int, int, int, bool]:
    """Return the axes of a sequence in the order of static axes, and whether it is reversed.

    Raises:
        KeyError: There is no such sequence.
    """
    name = axes.lower() if isinstance(axes, str) else TUPLE_TO_AXES[axes]
    if name not in AXES_TO_TUPLE:
        raise KeyError(axes)
    turns_along = name[0] == "r"
    first, second, third = ("xyz".index(axis) for axis in name[1:][:: -1 if turns_along else 1])
    return first, second, third, turns_along


def homogeneous(rotation: Array, translation: npt.ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Return the 4x4 matrix of a 3x3 matrix and a translation."""
    matrix = np.identity(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = floats(translation)[:3]
    return matrix


# Euler angles


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Array:
    """Return the 4x4 rotation matrix of Euler angles.

    Args:
        ai: The angle about the first axis, in radians.
        aj: The angle about the second.
        ak: The angle about the third.
        axes: ``s`` for static or ``r`` for rotating axes, followed by three axes; or the four
            numbers of such a sequence.

    Raises:
        KeyError: There is no such sequence.
    """
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Quaternion:
    """Return the quaternion of Euler angles; the arguments are those of `euler_matrix`.

    Raises:
        KeyError: There is no such sequence.
    """
    *order, turns_along = static_sequence(axes)
    angles = (ak, aj, ai) if turns_along else (ai, aj, ak)
    whole: Quaternion = (0.0, 0.0, 0.0, 1.0)
    for axis, angle in zip(order, angles, strict=True):
        turn = [0.0, 0.0, 0.0, math.cos(angle / 2)]
        turn[axis] = math.sin(angle / 2)
        whole = quaternion_multiply(turn, whole)
    return whole


def euler_from_matrix(matrix: npt.ArrayLike, axes: Axes = "sxyz") -> Angles:
    """Return Euler angles of a rotation matrix, in radians; several angles match one matrix.

    Args:
        matrix: 3x3 or 4x4.
        axes: As for `euler_matrix`.

    Raises:
        KeyError: There is no such sequence.
    """
    rotation = floats(matrix)[:3, :3]
    i, j, third, turns_along = static_sequence(axes)
    k = 3 - i - j
    if third == i:
        sine = math.hypot(rotation[i, j], rotation[i, k])
        first, last = (rotation[i, j], rotation[i, k]), (rotation[j, i], -rotation[k, i])
        middle, is_free = math.atan2(sine, rotation[i, i]), sine <= EPSILON
    else:
        cosine = math.hypot(rotation[i, i], rotation[j, i])
        first, last = (rotation[k, j], rotation[k, k]), (rotation[j, i], rotation[i, i])
        middle, is_free = math.atan2(-rotation[k, i], cosine), cosine <= EPSILON
    if is_free:  # the first and last axis coincide: only the sum of their angles is known
        first, last = (-rotation[j, k], rotation[j, j]), (0.0, 1.0)
    # Axis orders such as x, z, y are left-handed, so the angles have the opposite sign.
    sign = 1.0 if (i + 1) % 3 == j else -1.0
    angles = (sign * math.atan2(*first), sign * middle, sign * math.atan2(*last))
    return (angles[2], angles[1], angles[0]) if turns_along else angles


def euler_from_quaternion(quaternion: npt.ArrayLike, axes: Axes = "sxyz") -> Angles:
    """Return Euler angles of a quaternion, in radians; see `euler_from_matrix`.

    Raises:
        KeyError: There is no such sequence.
    """
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


# Quaternions


def quaternion_about_axis(angle: float, axis: npt.ArrayLike) -> Quaternion:
    """Return the quaternion of a rotation by an angle in radians about an axis of any length."""
    x, y, z = (math.sin(angle / 2) * unit_vector(axis)).tolist()
    return x, y, z, math.cos(angle / 2)


def quaternion_matrix(quaternion: npt.ArrayLike) -> Array:
    """Return the 4x4 rotation matrix of a quaternion of any length; for zero, the identity."""
    values = floats(quaternion)
    length = float(np.dot(values, values))
    if length < np.finfo(float).eps:
        return np.identity(4)
    x, y, z, w = (values / math.sqrt(length)).tolist()
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    return homogeneous(rotation)


def rotation_of(matrix: Array) -> tuple[Array, Array]:
    """Split a 3x3 matrix into a rotation and an upper triangular matrix of scales and shears.

    Raises:
        ValueError: The matrix has no inverse.
    """
    rotation, upper = np.linalg.qr(matrix)
    if not np.all(np.abs(np.diag(upper)) > EPSILON):
        raise ValueError("the matrix has no inverse, so it has no rotation")
    signs = np.sign(np.diag(upper))
    if np.linalg.det(rotation * signs) < 0:
        signs[0] *= -1.0  # a mirror image is a rotation with a negative scale of x
    return rotation * signs, signs[:, np.newaxis] * upper


def quaternion_from_matrix(matrix: npt.ArrayLike) -> Quaternion:
    """Return the quaternion of a 4x4 matrix; its w is not negative.

    Scales and shears of the matrix are ignored.

    Raises:
        ValueError: The matrix has no inverse.
    """
    rotation, _ = rotation_of(floats(matrix)[:3, :3])
    trace = float(np.trace(rotation))
    squares = 1.0 + 2.0 * np.append(np.diag(rotation), trace) - trace
    squares[3] = 1.0 + trace
    largest = int(np.argmax(squares))  # the one whose square root is the most accurate
    values = np.empty(4)
    values[largest] = squares[largest]
    if largest == 3:
        values[:3] = antisymmetric(rotation)
    else:
        others = [axis for axis in range(3) if axis != largest]
        values[others] = rotation[largest, others] + rotation[others, largest]
        values[3] = antisymmetric(rotation)[largest]
    x, y, z, w = unit_vector(values if values[3] >= 0 else -values).tolist()
    return x, y, z, w


def antisymmetric(rotation: Array) -> Array:
    """Return the axis of a rotation, times twice the sine of its angle."""
    return np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )


def quaternion_multiply(quaternion1: Any, quaternion0: Any) -> Quaternion:
    """Return the product of two quaternions: the second rotation is applied first."""
    x1, y1, z1, w1 = quaternion1
    x0, y0, z0, w0 = quaternion0
    return (
        w1 * x0 + x1 * w0 + y1 * z0 - z1 * y0,
        w1 * y0 - x1 * z0 + y1 * w0 + z1 * x0,
        w1 * z0 + x1 * y0 - y1 * x0 + z1 * w0,
        w1 * w0 - x1 * x0 - y1 * y0 - z1 * z0,
    )


def quaternion_conjugate(quaternion: npt.ArrayLike) -> Array:
    """Return the quaternion with the opposite axis."""
    return floats(quaternion) * (-1.0, -1.0, -1.0, 1.0)


def quaternion_inverse(quaternion: npt.ArrayLike) -> Array:
    """Return the quaternion whose product with the given one is (0, 0, 0, 1)."""
    values = floats(quaternion)
    return quaternion_conjugate(values) / float(np.dot(values, values))


def quaternion_slerp(
    quat0: npt.ArrayLike,
    quat1: npt.ArrayLike,
    fraction: float,
    spin: float = 0,
    shortestpath: bool = True,
) -> Array:
    """Return the quaternion at a fraction of the rotation from one to another.

    Args:
        quat0: The quaternion at fraction 0.
        quat1: The quaternion at fraction 1.
        fraction: From 0 to 1; beyond that, the rotation continues.
        spin: The number of half turns added on the way.
        shortestpath: Use the shorter of the two ways.
    """
    start: Array = unit_vector(floats(quat0, 4))
    end: Array = unit_vector(floats(quat1, 4))
    if fraction == 0.0:
        return start
    if fraction == 1.0:
        return end
    cosine = float(np.dot(start, end))
    if abs(abs(cosine) - 1.0) < EPSILON:
        return start
    if shortestpath and cosine < 0.0:
        cosine, end = -cosine, -end
    angle = math.acos(cosine) + spin * math.pi
    if abs(angle) < EPSILON:
        return start
    shares = math.sin((1.0 - fraction) * angle), math.sin(fraction * angle)
    return (shares[0] * start + shares[1] * end) / math.sin(angle)


def random_quaternion(rand: npt.ArrayLike | None = None) -> Array:
    """Return a random rotation; all are equally likely.

    Args:
        rand: Three random numbers from 0 to 1 to use.
    """
    share, first, second = np.random.random(3) if rand is None else floats(rand)  # noqa: NPY002
    low, high = math.sqrt(1.0 - share), math.sqrt(share)
    angles = 2 * math.pi * np.array([first, second])
    (sine0, sine1), (cosine0, cosine1) = np.sin(angles), np.cos(angles)
    return np.array([sine0 * low, cosine0 * low, sine1 * high, cosine1 * high])


def random_rotation_matrix(rand: npt.ArrayLike | None = None) -> Array:
    """Return the 4x4 matrix of a random rotation; see `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))
