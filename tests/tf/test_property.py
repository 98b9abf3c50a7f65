"""Compares random trees with a computation that uses neither quaternions nor trees."""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.clock import Time
from aionode.tf import BufferCore
from tests.support.transforms import parts, transform

Matrix = npt.NDArray[np.float64]

coordinates = st.floats(-10, 10, width=32)
# Microradians: where two rotations differ by less than some 1e-8, tf2's slerp stays at the older.
angles = st.integers(-3_125_000, 3_125_000).map(lambda count: count / 1e6)
turns = st.tuples(angles, angles, angles)
places = st.tuples(coordinates, coordinates, coordinates)


def quaternion(turn: tuple[float, float, float]) -> tuple[float, float, float, float]:
    """Return the quaternion of a rotation by roll, pitch and yaw."""
    (sr, cr), (sp, cp), (sy, cy) = ((sin(a / 2), cos(a / 2)) for a in turn)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def rotation(turn: tuple[float, float, float]) -> Matrix:
    """Return the matrix of a rotation by roll, pitch and yaw."""
    (sr, cr), (sp, cp), (sy, cy) = ((sin(a), cos(a)) for a in turn)
    x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return np.asarray(z @ y @ x)


def partly(turned: Matrix, ratio: float) -> Matrix:
    """Return a rotation by a part of the angle of another, by Rodrigues' formula."""
    skew = (turned - turned.T) / 2
    axis = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    sine = float(np.linalg.norm(axis))
    angle = float(np.arctan2(sine, (np.trace(turned) - 1) / 2))
    if sine == 0:
        return np.eye(3)
    k = skew / sine
    return np.asarray(np.eye(3) + sin(angle * ratio) * k + (1 - cos(angle * ratio)) * k @ k)


def pose_matrix(place: tuple[float, float, float], turned: Matrix) -> Matrix:
    """Return a homogeneous matrix."""
    whole = np.eye(4)
    whole[:3, :3] = turned
    whole[:3, 3] = place
    return whole


def matrix_of(pose: tuple[float, ...]) -> Matrix:
    """Return the homogeneous matrix of a pose with a quaternion."""
    x, y, z, i, j, k, w = pose
    assert sqrt(i * i + j * j + k * k + w * w) == pytest.approx(1, abs=1e-15)
    turned = np.array(
        [
            [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
            [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
            [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)],
        ]
    )
    return pose_matrix((x, y, z), turned)


@settings(deadline=None)
@given(st.data())
def test_any_two_frames_of_a_random_tree_agree_with_matrices(data: Any) -> None:
    """Lookups at one time, and between two, agree to 1e-12 for coordinates up to 10."""
    size = data.draw(st.integers(2, 7))
    parents = [data.draw(st.integers(0, child - 1)) for child in range(1, size)]
    samples = [[(data.draw(places), data.draw(turns)) for _ in range(2)] for _ in parents]
    core = BufferCore()
    for child, (parent, poses) in enumerate(zip(parents, samples, strict=True), 1):
        for stamp, (place, turn) in enumerate(poses, 1):
            core.set_transform(
                transform(f"f{parent}", f"f{child}", stamp, place, quaternion(turn)), "me"
            )

    def in_root(frame: int, ratio: float) -> Matrix:
        whole = np.eye(4)
        while frame:
            (place, turn), (next_place, next_turn) = samples[frame - 1]
            begin, end = rotation(turn), rotation(next_turn)
            between = begin @ partly(begin.T @ end, ratio)
            at = tuple((1 - ratio) * a + ratio * b for a, b in zip(place, next_place, strict=True))
            whole = pose_matrix(at, between) @ whole
            frame = parents[frame - 1]
        return whole

    target, source = data.draw(st.integers(0, size - 1)), data.draw(st.integers(0, size - 1))
    after_ns = [data.draw(st.integers(0, 10**9)) for _ in range(2)]
    ratio, other = (ns / 10**9 for ns in after_ns)
    if any(nearly_half_a_turn(poses) for poses in samples):
        return  # both ways round are equally short
    time, other_time = (Time(nanoseconds=10**9 + ns) for ns in after_ns)
    found = core.lookup_transform_core(f"f{target}", f"f{source}", time)
    expected = np.linalg.inv(in_root(target, ratio)) @ in_root(source, ratio)
    np.testing.assert_allclose(matrix_of(parts(found)), expected, rtol=0, atol=1e-12)
    full = core.lookup_transform_full_core(f"f{target}", other_time, f"f{source}", time, "f0")
    expected = np.linalg.inv(in_root(target, other)) @ in_root(source, ratio)
    np.testing.assert_allclose(matrix_of(parts(full)), expected, rtol=0, atol=1e-12)


def nearly_half_a_turn(poses: list[tuple[Any, Any]]) -> bool:
    """Return whether two rotations differ by about 180 degrees, which has no shorter arc."""
    (_, one), (_, other) = poses
    dot = sum(a * b for a, b in zip(quaternion(one), quaternion(other), strict=True))
    return abs(dot) < 1e-2
