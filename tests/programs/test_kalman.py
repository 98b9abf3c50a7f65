"""The Kalman filters of robot_localization, against values computed by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from aionode.programs._poses import (
    matrix_of,
    quaternion_of,
    wrapped,
)
from aionode.programs._robot_localization.kalman import (
    NAMES,
    SIZE,
    Control,
    Ekf,
    Filter,
    Measurement,
    Ukf,
    jacobian,
    transfer,
)
from aionode.tf.apply import angles_of

BOTH = pytest.mark.parametrize("make", [Ekf, Ukf])

X, YAW, VX, VYAW, AX = (
    NAMES.index(name) for name in ("X", "YAW", "X_VELOCITY", "YAW_VELOCITY", "X_ACCELERATION")
)


def started(make: Any = Ekf, variance: float = 1.0, **values: float) -> Any:
    """Return a filter that has an estimate."""
    result: Filter = make()
    state = np.zeros(SIZE)
    for name, value in values.items():
        state[NAMES.index(name)] = value
    result.place(state, np.eye(SIZE) * variance, 0)
    result.is_initialized = True
    return result


def measurement(
    index: int, value: float, variance: float = 1.0, time_ns: int = 0, **more: Any
) -> Measurement:
    """Return a measurement of one value."""
    values, covariance, mask = np.zeros(SIZE), np.zeros((SIZE, SIZE)), np.zeros(SIZE, dtype=bool)
    values[index], covariance[index, index], mask[index] = value, variance, True
    return Measurement("a", time_ns, values, covariance, mask, **more)


@BOTH
def test_measurements_replace_an_estimate_that_is_much_less_certain(make: Any) -> None:
    """The values are those of upstream's test."""
    filter_: Filter = make()
    filter_.covariance = np.eye(SIZE) * 0.5
    values = np.linspace(0.0, 0.15 * (SIZE - 1), SIZE)
    certain, everything = np.eye(SIZE) * 1e-9, np.ones(SIZE, dtype=bool)

    filter_.process(Measurement("odom0", 1000, values, certain, everything))

    assert list(filter_.state) == list(values)
    assert np.array_equal(filter_.covariance, certain)
    assert filter_.time_ns == 1000
    filter_.place(filter_.state, np.eye(SIZE) * 0.5, 1000)
    filter_.process(Measurement("odom0", 1002, values * 2, certain, everything))
    off = filter_.state - values * 2
    off[3:6] = wrapped(off[3:6])
    assert np.abs(off).max() < 0.001


@BOTH
def test_an_estimate_and_a_measurement_of_equal_certainty_meet_in_the_middle(make: Any) -> None:
    """Other values stay as they are, since nothing connects them yet."""
    filter_ = started(make)

    assert filter_.correct(measurement(X, 1.0))

    assert filter_.state[X] == pytest.approx(0.5)
    assert np.abs(np.delete(filter_.state, X)).max() < 1e-6


@BOTH
def test_a_correction_makes_the_estimate_more_certain(make: Any) -> None:
    """1 and 1 make 1/2."""
    filter_ = started(make)
    filter_.correct(measurement(X, 1.0))

    assert filter_.covariance[X, X] == pytest.approx(0.5)


@BOTH
def test_what_time_made_uncertain_is_left_to_the_next_measurement(make: Any) -> None:
    """The variance grows by 0.05 a second, and that of the measurement, which says 1, is 0.1."""
    filter_ = started(make, 1e-12)

    filter_.process(measurement(X, 1.0, 0.1, 2_000_000_000))

    assert filter_.state[X] == pytest.approx(0.5, abs=1e-3)


@BOTH
@pytest.mark.parametrize(("threshold", "is_used"), [(1.0, False), (1.5, True)])
def test_a_measurement_far_from_the_estimate_is_rejected(
    make: Any, threshold: float, is_used: bool
) -> None:
    """It is 2 off, of which √2 is the standard deviation."""
    filter_ = started(make)

    assert filter_.correct(measurement(X, 2.0, threshold=threshold)) is is_used
    assert (filter_.state[X] > 0.0) == is_used


@BOTH
def test_angles_meet_on_the_short_way_round(make: Any) -> None:
    """Half a turn is between 3.0 and -3.0."""
    filter_ = started(make, 0.01, YAW=3.0)

    filter_.correct(measurement(YAW, -3.0, 0.01))

    assert abs(filter_.state[YAW]) == pytest.approx(math.pi, abs=1e-3)


@BOTH
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_value_that_is_no_number_does_not_count(make: Any, value: float) -> None:
    """The others of the message do."""
    filter_ = started(make)
    both = measurement(X, value)
    both.values[VX], both.covariance[VX, VX], both.mask[VX] = 1.0, 1.0, True

    assert filter_.correct(both)

    assert filter_.state[[X, VX]] == pytest.approx([0.0, 0.5], abs=1e-6)
    assert not filter_.correct(measurement(X, value))


def test_variances_below_zero_count_by_their_size_and_none_as_a_small_one() -> None:
    """As in the original."""
    filter_ = started()
    filter_.correct(measurement(X, 1.0, -1.0))
    assert filter_.state[X] == pytest.approx(0.5)

    filter_.correct(measurement(VX, 1.0, 0.0))
    assert filter_.state[VX] == pytest.approx(1.0)


@BOTH
def test_covariances_that_are_none_change_nothing(make: Any) -> None:
    """A message of somebody else must not end the estimate."""
    filter_ = started(make)
    wild = measurement(X, 1.0)
    wild.values[VX], wild.mask[VX] = 1.0, True
    wild.covariance[:] = 1e308

    filter_.correct(wild)

    assert np.isfinite(filter_.state).all()
    assert np.isfinite(filter_.covariance).all()


@BOTH
def test_the_robot_moves_where_it_looks(make: Any) -> None:
    """At 1 m/s to the left for two seconds, while it speeds up by 0.5 m/s²."""
    filter_ = started(
        make, 1e-9, YAW=math.pi / 2, X_VELOCITY=1.0, X_ACCELERATION=0.5, YAW_VELOCITY=0.0
    )

    filter_.predict(2_000_000_000)

    assert filter_.state[:3] == pytest.approx([0.0, 3.0, 0.0], abs=1e-3)
    assert filter_.state[VX] == pytest.approx(2.0)


@BOTH
def test_the_angles_follow_the_angular_velocity(make: Any) -> None:
    """Beyond half a turn they begin again."""
    filter_ = started(make, 1e-9, YAW=3.0, YAW_VELOCITY=1.0)

    filter_.predict(1_000_000_000)

    assert filter_.state[YAW] == pytest.approx(4.0 - 2 * math.pi, abs=1e-3)


@BOTH
def test_time_makes_the_estimate_less_certain(make: Any) -> None:
    """By the process noise, and by what follows from the other values."""
    filter_ = started(make, 1e-9)

    filter_.predict(2_000_000_000)

    assert filter_.covariance[AX, AX] == pytest.approx(0.02, rel=1e-4)
    assert filter_.covariance[X, X] == pytest.approx(0.1, rel=1e-4)


@BOTH
@pytest.mark.parametrize(("speed", "variance"), [(0.0, 0.0), (2.0, 4.0 * 0.05)])
def test_with_dynamic_noise_only_a_robot_that_moves_gets_lost(
    make: Any, speed: float, variance: float
) -> None:
    """The noise of the pose grows with the square of the velocity."""
    filter_ = started(make, 1e-9, X_VELOCITY=speed)
    filter_.is_noise_dynamic = True

    filter_.predict(1_000_000_000)

    assert filter_.covariance[X, X] == pytest.approx(variance, abs=1e-3)


def test_the_jacobian_is_the_derivative_of_the_motion() -> None:
    """Compared with differences, at random states."""
    random = np.random.default_rng(1)
    for _ in range(20):
        state = random.uniform(-1.0, 1.0, SIZE)
        step = 1e-6
        columns = [
            (transfer(state + by, 0.3) @ (state + by) - transfer(state - by, 0.3) @ (state - by))
            / (2 * step)
            for by in np.eye(SIZE) * step
        ]

        assert np.abs(jacobian(state, 0.3) - np.array(columns).T).max() < 1e-8


@pytest.mark.parametrize(
    ("command", "velocity", "acceleration"),
    [
        (1.0, 0.0, 0.8),  # by the gain
        (5.0, 0.0, 1.3),  # at the limit
        (0.0, 2.0, -2.0),  # slowing down, by the other gain
        (0.0, 9.0, -4.5),  # at the other limit
        (-1.0, 2.0, -3.0),  # turning back is first slowing down
    ],
)
def test_commands_tell_the_acceleration(
    command: float, velocity: float, acceleration: float
) -> None:
    """Computed by hand from the rules of the original."""
    control = Control(
        mask=[True] + [False] * 5,
        timeout_ns=10,
        acceleration_limits=[1.3] * 6,
        acceleration_gains=[0.8] * 6,
        deceleration_limits=[4.5] * 6,
        deceleration_gains=[1.0] * 6,
        twist=np.array([command] + [0.0] * 5),
        time_ns=5,
    )

    assert control.acceleration(np.array([velocity] * 6), 6)[0] == pytest.approx(acceleration)
    assert list(control.acceleration(np.array([velocity] * 6), 6)[1:]) == [0.0] * 5


def test_an_old_command_is_one_to_stop() -> None:
    """As for the base itself."""
    control = Control(mask=[True] + [False] * 5, timeout_ns=10, twist=np.ones(6))

    assert control.acceleration(np.zeros(6), 9)[0] == 1.0
    assert control.acceleration(np.zeros(6), 10)[0] == 0.0


@BOTH
def test_the_prediction_follows_the_commands(make: Any) -> None:
    """Turning is a change of velocity, driving an acceleration."""
    filter_ = started(make, 1e-9)
    filter_.control = Control([True] * 6, 10**10, twist=np.array([1.0, 0, 0, 0, 0, 0.5]))

    filter_.predict(1_000_000_000)

    assert filter_.state[AX] == pytest.approx(1.0)
    assert filter_.state[VYAW] == pytest.approx(0.5)


@pytest.mark.parametrize("angles", [(0.1, -0.4, 2.0), (-3.0, 1.5, -3.1), (0.0, 0.0, 0.0)])
def test_angles_matrices_and_quaternions_are_the_same_rotation(
    angles: tuple[float, float, float],
) -> None:
    """A quaternion turns the x-axis as the first column of the matrix says."""
    matrix, turn = matrix_of(*angles), quaternion_of(*angles)

    assert angles_of(matrix) == pytest.approx(angles)
    assert matrix[:, 0] == pytest.approx(
        [
            1 - 2 * (turn.y**2 + turn.z**2),
            2 * (turn.x * turn.y + turn.z * turn.w),
            2 * (turn.x * turn.z - turn.y * turn.w),
        ]
    )


def test_the_unscented_filter_needs_points_around_the_estimate() -> None:
    """The parameters may leave none."""
    with pytest.raises(ValueError, match="is 0; it has to be above 0"):
        Ukf(alpha=0.0)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@BOTH
@pytest.mark.parametrize(("value", "variance"), [(1.0, 1.7e308), (1e300, 1.0)])
def test_numbers_near_the_largest_end_no_filter(make: Any, value: float, variance: float) -> None:
    """Others send them; the node then says that it has no estimate, until it is reset."""
    filter_: Filter = make()
    for step in range(1, 60):
        filter_.process(
            Measurement(
                "a",
                step * 100_000_000,
                np.full(SIZE, value),
                np.eye(SIZE) * variance,
                np.ones(SIZE, dtype=bool),
            )
        )

    filter_.place(np.zeros(SIZE), np.eye(SIZE), 0)
    assert filter_.process(measurement(X, 1.0))


def test_the_unscented_filter_goes_on_where_rounding_leaves_no_root() -> None:
    """A variance may come out just below zero."""
    filter_ = started(Ukf)
    filter_.covariance[X, X] = -1e-12

    filter_.predict(1_000_000)

    assert np.isfinite(filter_.state).all()
