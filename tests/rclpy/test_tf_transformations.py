"""`tf_transformations`, as programs use it; the numbers are those of the original package."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import tf_transformations as tf

AXES = sorted(tf._AXES2TUPLE)
ANGLES = 0.4, -1.1, 2.3
POINT = np.array([0.3, -1.2, 0.7])
NORMAL = np.array([0.5, 0.1, -0.9])
OTHER = np.array([-0.4, 0.8, 0.2])


def same(first: Any, second: Any) -> bool:
    """Return whether numbers are the same apart from rounding."""
    return np.allclose(first, second)


@pytest.mark.parametrize(
    ("axes", "quaternion", "angles"),
    [
        (
            "sxyz",
            (0.53676573, -0.054659897, 0.805060498, 0.246520673),
            (-0.289503672, -1.052545273, 0.886501535),
        ),
        (
            "rzyx",
            (0.805060498, -0.054659897, 0.53676573, 0.246520673),
            (0.886501535, -1.052545273, -0.289503672),
        ),
        (
            "szxz",
            (-0.304038322, -0.425161896, 0.831828089, 0.186708571),
            (1.732171437, 1.076119238, -1.014630097),
        ),
        (
            (1, 1, 1, 1),
            (-0.304038322, 0.831828089, -0.425161896, 0.186708571),
            (1.333947566, -0.646860594, -2.451146197),
        ),
    ],
)
def test_euler_angles_are_quaternions_and_back(axes: Any, quaternion: Any, angles: Any) -> None:
    """x, y, z and w in this order, as messages have them."""
    assert same(tf.quaternion_from_euler(*ANGLES, axes), quaternion)
    assert same(tf.euler_from_quaternion((0.1, -0.5, 0.3, 0.8), axes), angles)
    assert isinstance(tf.quaternion_from_euler(*ANGLES), tuple)
    assert all(isinstance(part, float) for part in tf.euler_from_quaternion((0, 0, 0, 1)))


@pytest.mark.parametrize("middle", [-1.1, 0.0, math.pi / 2, -math.pi / 2, math.pi])
def test_euler_angles_of_every_sequence_make_their_matrix(middle: float) -> None:
    """The first and last axis may coincide."""
    for axes in AXES:
        matrix = tf.euler_matrix(0.4, middle, 2.3, axes)

        assert same(tf.euler_matrix(*tf.euler_from_matrix(matrix, axes), axes), matrix)


def test_an_unknown_sequence_of_axes_is_refused() -> None:
    """As in the package."""
    with pytest.raises(KeyError):
        tf.euler_matrix(0, 0, 0, "sxxy")


def test_three_turns_are_one() -> None:
    """By matrices, Euler angles and quaternions."""
    axes = np.identity(3)
    turns = [tf.rotation_matrix(angle, axis) for angle, axis in zip(ANGLES, axes, strict=True)]
    whole = tf.concatenate_matrices(*turns)
    quaternion: Any = (0.0, 0.0, 0.0, 1.0)
    for angle, axis in zip(ANGLES, axes, strict=True):
        turn = tf.quaternion_about_axis(angle, axis)
        quaternion = tf.quaternion_multiply(quaternion, turn)

    assert same(tf.euler_from_matrix(whole, "rxyz"), ANGLES)
    assert tf.is_same_transform(tf.quaternion_matrix(quaternion), whole)
    assert not tf.is_same_transform(tf.identity_matrix(), whole)


def test_quaternions_multiply_as_turns() -> None:
    """The numbers of the package's own documentation."""
    assert tf.quaternion_multiply([1, -2, 3, 4], [-5, 6, 7, 8]) == (-44, -14, 48, 28)
    assert same(tf.quaternion_conjugate([1, 2, 3, 4]), [-1, -2, -3, 4])
    product = tf.quaternion_multiply([1, 2, 3, 4], tf.quaternion_inverse([1, 2, 3, 4]))
    assert same(product, [0, 0, 0, 1])


def test_a_matrix_is_a_quaternion_whatever_its_scale() -> None:
    """Every rotation has two quaternions; the one with positive w is returned."""
    for quaternion in (tf.random_quaternion() for _ in range(50)):
        positive = quaternion if quaternion[3] > 0 else -quaternion
        matrix = tf.quaternion_matrix(quaternion) @ tf.scale_matrix(3.0)

        assert same(tf.quaternion_from_matrix(matrix), positive)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, -2, 3)])
def test_a_half_turn_is_a_quaternion(axis: Any) -> None:
    """There its w is zero, and must not be divided by."""
    matrix = tf.rotation_matrix(math.pi, axis)

    assert same(tf.quaternion_matrix(tf.quaternion_from_matrix(matrix)), matrix)


def test_a_quaternion_need_not_be_of_length_one() -> None:
    """Messages contain rounded numbers; zero is treated as no rotation."""
    assert same(tf.quaternion_matrix([0, 0, 0, 5]), np.identity(4))
    assert same(tf.quaternion_matrix([0, 0, 0, 0]), np.identity(4))


def test_the_way_between_two_turns() -> None:
    """The shorter one, unless the other is requested, and with half turns added."""
    start, end = (0, 0, 0, 1), (0.5, -0.5, 0.5, -0.5)

    assert same(
        tf.quaternion_slerp(start, end, 0.25),
        [-0.149429245, 0.149429245, -0.149429245, 0.965925826],
    )
    assert same(
        tf.quaternion_slerp(start, end, 0.25, 1, False),
        [-0.557677536, 0.557677536, -0.557677536, 1.374174117],
    )
    assert same(tf.quaternion_slerp(start, end, 0.0), start)
    assert same(tf.quaternion_slerp(start, end, 1.0), end)
    assert same(tf.quaternion_slerp(start, start, 0.5), start)


def test_chance_is_that_of_numpy() -> None:
    """A program that seeds it gets the same rotations in every run."""
    np.random.seed(7)  # noqa: NPY002  # what programs call
    first = tf.random_quaternion()
    np.random.seed(7)  # noqa: NPY002

    assert same(tf.random_quaternion(), first)
    assert same(tf.vector_norm(first), 1.0)
    assert tf.random_rotation_matrix([0.1, 0.2, 0.3]).shape == (4, 4)
    assert tf.random_vector(5).shape == (5,)


@pytest.mark.parametrize(
    ("matrix", "again"),
    [
        (
            tf.rotation_matrix(0.7, NORMAL, POINT),
            lambda m: tf.rotation_matrix(*tf.rotation_from_matrix(m)),
        ),
        (
            tf.rotation_matrix(math.pi, NORMAL),
            lambda m: tf.rotation_matrix(*tf.rotation_from_matrix(m)),
        ),
        (tf.identity_matrix(), lambda m: tf.rotation_matrix(*tf.rotation_from_matrix(m))),
        (
            tf.reflection_matrix(POINT, NORMAL),
            lambda m: tf.reflection_matrix(*tf.reflection_from_matrix(m)),
        ),
        (tf.scale_matrix(-1.2, POINT), lambda m: tf.scale_matrix(*tf.scale_from_matrix(m))),
        (tf.scale_matrix(2.5, POINT, NORMAL), lambda m: tf.scale_matrix(*tf.scale_from_matrix(m))),
        (
            tf.shear_matrix(0.7, np.cross(NORMAL, OTHER), POINT, NORMAL),
            lambda m: tf.shear_matrix(*tf.shear_from_matrix(m)),
        ),
        (
            tf.projection_matrix(POINT, NORMAL),
            lambda m: tf.projection_matrix(*tf.projection_from_matrix(m)),
        ),
        (
            tf.projection_matrix(POINT, NORMAL, OTHER),
            lambda m: tf.projection_matrix(*tf.projection_from_matrix(m)),
        ),
        (
            tf.projection_matrix(POINT, NORMAL, perspective=OTHER),
            lambda m: tf.projection_matrix(*tf.projection_from_matrix(m)),
        ),
        (
            tf.projection_matrix(POINT, NORMAL, perspective=OTHER, pseudo=True),
            lambda m: tf.projection_matrix(*tf.projection_from_matrix(m, pseudo=True)),
        ),
        (
            tf.compose_matrix((2, -3, 4), (0.1, 0.2, 0.3), ANGLES, POINT),
            lambda m: tf.compose_matrix(*tf.decompose_matrix(m)),
        ),
        (
            tf.translation_matrix(POINT),
            lambda m: tf.translation_matrix(tf.translation_from_matrix(m)),
        ),
    ],
)
def test_a_matrix_tells_what_it_is_made_of(matrix: Any, again: Any) -> None:
    """The parts give the same matrix again."""
    assert tf.is_same_transform(matrix, again(matrix))


@pytest.mark.parametrize(
    ("made", "numbers"),
    [
        (
            tf.projection_matrix((1, 2, 3), (0, 3, 4), perspective=(5, -1, 2), pseudo=True),
            [
                [-2.6, -3, -4, 18],
                [0, -2.36, 0.32, -1.44],
                [0, -1.68, -4.84, 10.08],
                [0, -0.6, -0.8, 1],
            ],
        ),
        (
            tf.clip_matrix(-1, 2, -3, 4, 0.5, 8, True),
            [
                [-1 / 3, 0, 1 / 3, 0],
                [0, -1 / 7, 1 / 7, 0],
                [0, 0, -17 / 15, 16 / 15],
                [0, 0, -1, 0],
            ],
        ),
        (
            tf.shear_matrix(0.7, (1, 0, 0), (0, 0, 2), (0, 0, 1)),
            [[1, 0, 0.84228838, -1.684576761], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        ),
        (
            tf.reflection_matrix((1, 2, 3), (0, 3, 4)),
            [[1, 0, 0, 0], [0, 0.28, -0.96, 4.32], [0, -0.96, -0.28, 5.76], [0, 0, 0, 1]],
        ),
    ],
)
def test_matrices_have_the_numbers_of_the_package(made: Any, numbers: Any) -> None:
    """Their signs and scales are conventions."""
    assert same(made, numbers)


def test_a_matrix_is_taken_apart_as_the_package_does() -> None:
    """A mirror image is a negative scale of x, whichever axis was mirrored."""
    whole = tf.compose_matrix((2, -3, 4), (0.1, 0.2, 0.3), (0.4, 0.5, 0.6), (7, 8, 9))

    scales, shears, angles, translation, perspective = tf.decompose_matrix(whole)

    assert same(scales, [-2, 3, 4])
    assert same(shears, [0.1, 0.2, 0.3])
    assert same(angles, [-0.4, -0.5, -2.541592654])
    assert same(translation, [7, 8, 9])
    assert perspective is None


@pytest.mark.parametrize(
    ("function", "matrix"),
    [
        (tf.rotation_from_matrix, tf.scale_matrix(2.0)),
        (tf.rotation_from_matrix, tf.translation_matrix(POINT)),
        (tf.reflection_from_matrix, tf.identity_matrix()),
        (tf.projection_from_matrix, tf.identity_matrix()),
        (tf.decompose_matrix, np.zeros((4, 4))),
    ],
)
def test_a_matrix_of_another_kind_is_refused(function: Any, matrix: Any) -> None:
    """Returning arbitrary numbers would be worse."""
    with pytest.raises(ValueError, match="the matrix"):
        function(matrix)


def test_a_box_is_taken_to_the_corners_of_the_screen() -> None:
    """Both ends of each side; an empty box is refused."""
    matrix = tf.clip_matrix(-1, 2, -3, 4, 0.5, 8)

    assert same(matrix @ [-1, -3, 0.5, 1], [-1, -1, -1, 1])
    assert same(matrix @ [2, 4, 8, 1], [1, 1, 1, 1])
    for box in ((1, 1, 0, 1, 1, 2), (0, 1, 0, 1, 0, 2, True)):
        with pytest.raises(ValueError, match=r"the box|near is 0"):
            tf.clip_matrix(*box)


@pytest.mark.parametrize("usesvd", [True, False])
def test_points_are_taken_to_where_they_were_moved(usesvd: bool) -> None:
    """By a rotation, a scale and a translation, or by a rotation if two are mirrored."""
    rng = np.random.default_rng(0)
    start = np.vstack([rng.normal(size=(3, 20)), np.ones(20)])
    moved = tf.concatenate_matrices(
        tf.translation_matrix(POINT), tf.random_rotation_matrix(), tf.scale_matrix(0.3)
    )

    found = tf.superimposition_matrix(start, moved @ start, scaling=True, usesvd=usesvd)
    mirrored = tf.superimposition_matrix(start, start * [[1], [1], [-1], [1]], usesvd=usesvd)

    assert same(found, moved)
    assert np.linalg.det(mirrored[:3, :3]) == pytest.approx(1.0)
    with pytest.raises(ValueError, match="columns"):
        tf.superimposition_matrix(start[:, :2], start[:, :2])


def test_the_cell_of_a_crystal_is_made_orthogonal() -> None:
    """The numbers of the package's own documentation; angles are in degrees here."""
    assert same(tf.orthogonalization_matrix((10, 10, 10), (90, 90, 90))[:3, :3], np.eye(3) * 10)
    cell = tf.orthogonalization_matrix([9.8, 12.0, 15.5], [87.2, 80.7, 69.7])
    assert np.sum(cell) == pytest.approx(43.063229)


def test_lengths_are_of_vectors_along_an_axis() -> None:
    """A result can be written into an existing array."""
    vectors = np.random.default_rng(0).normal(size=(5, 4, 3))
    lengths = np.empty((5, 3))
    units = vectors.copy()

    assert tf.vector_norm(vectors, axis=1, out=lengths) is None
    assert tf.unit_vector(units, axis=1, out=units) is None

    assert same(lengths, np.linalg.norm(vectors, axis=1))
    assert same(tf.vector_norm(vectors, axis=1), lengths)
    assert same(units * lengths[:, np.newaxis], vectors)
    assert same(tf.unit_vector(vectors, axis=1), units)
    assert (tf.vector_norm([]), tf.vector_norm([1.0]), list(tf.unit_vector([]))) == (0.0, 1.0, [])


def test_a_matrix_has_its_inverse() -> None:
    """It may have any size."""
    matrix = np.random.default_rng(0).normal(size=(5, 5))

    assert same(tf.inverse_matrix(matrix) @ matrix, np.identity(5))


def test_a_ball_turns_with_the_mouse() -> None:
    """The numbers of the package's own documentation."""
    ball = tf.Arcball(np.identity(4))
    ball.place([320, 320], 320)
    ball.down([500, 250])
    ball.drag([475, 275])
    assert np.sum(ball.matrix()) == pytest.approx(3.90583455)

    ball = tf.Arcball([0, 0, 0, 1])
    ball.place([320, 320], 320)
    ball.setaxes([1, 1, 0], [-1, 1, 0])
    ball.setconstrain(True)
    ball.down([400, 200])
    ball.drag([200, 400])
    assert ball.getconstrain()
    assert np.sum(ball.matrix()) == pytest.approx(0.2055924)
    ball.next()
    assert np.sum(ball.matrix()) == pytest.approx(-1.5792777)

    with pytest.raises(ValueError, match="shape"):
        tf.Arcball([1, 2, 3])


def test_a_point_beside_the_ball_is_on_its_edge() -> None:
    """The mouse leaves the ball while dragging."""
    assert same(tf.arcball_map_to_sphere([30, 10], [10, 10], 5), [1, 0, 0])
    assert same(tf.arcball_constrain_to_axis([0, 0, 1], [0, 0, 1]), [1, 0, 0])
    assert same(tf.arcball_constrain_to_axis([1, 0, 0], [1, 0, 0]), [0, 1, 0])
    assert same(tf.arcball_nearest_axis([1, 0, 0], [[1, 0, 0], [0, 0, 1]]), [0, 0, 1])
