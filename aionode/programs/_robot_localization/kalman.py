"""The Kalman filters: the state of a robot in space, its prediction and its correction."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from aionode.programs._poses import Array, matrix_of, wrapped

__all__ = [
    "ACCELERATION",
    "ANGULAR",
    "LINEAR",
    "NAMES",
    "ORIENTATION",
    "POSE",
    "POSITION",
    "SIZE",
    "START_VARIANCE",
    "TWIST",
    "Control",
    "Ekf",
    "Filter",
    "Mask",
    "Measurement",
    "Ukf",
]

NAMES: Final = (
    *("X", "Y", "Z", "ROLL", "PITCH", "YAW"),
    *("X_VELOCITY", "Y_VELOCITY", "Z_VELOCITY"),
    *("ROLL_VELOCITY", "PITCH_VELOCITY", "YAW_VELOCITY"),
    *("X_ACCELERATION", "Y_ACCELERATION", "Z_ACCELERATION"),
)
"""The parts of the state: the pose in the world, the rest in the frame of the robot."""

SIZE: Final = len(NAMES)
POSITION: Final = slice(0, 3)
ORIENTATION: Final = slice(3, 6)
LINEAR: Final = slice(6, 9)
ANGULAR: Final = slice(9, 12)
ACCELERATION: Final = slice(12, 15)
POSE: Final = slice(0, 6)
TWIST: Final = slice(6, 12)

ANGLES: Final = np.array([3 <= index < 6 for index in range(SIZE)])

PROCESS_NOISE: Final = (
    *(0.05, 0.05, 0.06, 0.03, 0.03, 0.06),
    *(0.025, 0.025, 0.04, 0.01, 0.01, 0.02, 0.01, 0.01, 0.015),
)
"""How fast the variances grow without measurements, per second."""

START_VARIANCE: Final = 1e-9
MIN_VARIANCE: Final = 1e-9
"""The minimum variance of a measurement: none is exact, and the gain needs an inverse matrix."""

Mask = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.intp]

# The generators of rotations about an axis: the derivative is this matrix times the rotation.
ABOUT_X: Final = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
ABOUT_Z: Final = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])


@dataclass
class Control:
    """The command to the robot, and how fast the robot follows it.

    Attributes:
        mask: Which of the six velocities are commanded.
        timeout_ns: The maximum age of a command; an older one counts as zero.
        acceleration_limits: The maximum acceleration of each velocity.
        acceleration_gains: The acceleration of each velocity per unit of difference from the
            command.
        deceleration_limits: The limits for slowing down.
        deceleration_gains: The gains for slowing down.
        twist: The command.
        time_ns: When it arrived.
    """

    mask: Sequence[bool] = (False,) * 6
    timeout_ns: int = 0
    acceleration_limits: Sequence[float] = (1.0,) * 6
    acceleration_gains: Sequence[float] = (1.0,) * 6
    deceleration_limits: Sequence[float] = (1.0,) * 6
    deceleration_gains: Sequence[float] = (1.0,) * 6
    twist: Array = field(default_factory=lambda: np.zeros(6))
    time_ns: int = 0

    def acceleration(self, velocities: Array, now_ns: int) -> Array:
        """Return the accelerations at which the robot follows the command."""
        result = np.zeros(6)
        is_old = now_ns - self.time_ns >= self.timeout_ns
        for index in map(int, np.flatnonzero(self.mask)):
            wanted = 0.0 if is_old else float(self.twist[index])
            actual = float(velocities[index])
            error = wanted - actual
            # A command in the opposite direction is first a command to stop.
            aim = wanted if abs(error) <= abs(wanted) + 0.01 else 0.0
            gain, limit = self.acceleration_gains[index], self.acceleration_limits[index]
            if abs(aim) < abs(actual):
                gain, limit = self.deceleration_gains[index], self.deceleration_limits[index]
            result[index] = min(max(gain * error, -limit), limit)
        return result


@dataclass
class Measurement:
    """A measurement of parts of the state by a sensor.

    Attributes:
        source: The name of the sensor, for diagnostics.
        time_ns: When it was measured.
        values: A whole state, of which only the values in `mask` count.
        covariance: The covariance of the values.
        mask: The values that were measured.
        threshold: The number of standard deviations from the estimate at which it is rejected.
        command: The velocities that were commanded at that time.
        command_ns: When they were commanded.
    """

    source: str
    time_ns: int
    values: Array
    covariance: Array
    mask: Mask
    threshold: float = math.inf
    command: Array | None = None
    command_ns: int = 0

    def measured(self) -> tuple[Indices, Array]:
        """Return which values are measured, and their covariance, whose diagonal is above 0."""
        indices = np.flatnonzero(self.mask & np.isfinite(self.values))
        noise = self.covariance[np.ix_(indices, indices)].copy()
        np.fill_diagonal(noise, np.maximum(np.abs(noise.diagonal()), MIN_VARIANCE))
        return indices, noise


class Filter(ABC):
    """An estimate that measurements correct and time makes less certain.

    Attributes:
        state: The estimate.
        covariance: Its covariance.
        time_ns: The time of the estimate.
        is_initialized: Whether there was a measurement.
        process_noise: How fast `covariance` grows, per second.
        is_noise_dynamic: Whether the noise of the pose grows with the velocity.
        control: The command to the robot.
    """

    def __init__(self) -> None:
        self.process_noise: Array = np.diag(PROCESS_NOISE)
        self.is_noise_dynamic = False
        self.control = Control()
        self.is_initialized = False
        self.place(np.zeros(SIZE), np.eye(SIZE) * START_VARIANCE, 0)

    def place(self, state: Array, covariance: Array, time_ns: int) -> None:
        """Replace the estimate."""
        self.state, self.covariance, self.time_ns = state, covariance, time_ns

    def process(self, measurement: Measurement) -> bool:
        """Predict the state at the time of a measurement, and correct it.

        Returns:
            Whether the measurement was used: it may be too far from the estimate.
        """
        if not self.is_initialized:
            measured, noise = measurement.measured()
            self.state[measured] = measurement.values[measured]
            self.covariance[np.ix_(measured, measured)] = noise
            self.is_initialized = True
            self.time_ns = measurement.time_ns
            return True
        if measurement.time_ns > self.time_ns:
            self.predict(measurement.time_ns)
        return self.correct(measurement)

    def predict(self, time_ns: int) -> None:
        """Move the estimate to another time."""
        seconds = (time_ns - self.time_ns) / 1e9
        accelerations = self.control.acceleration(self.state[TWIST], time_ns)
        self._predict(seconds, accelerations)
        self.state[ORIENTATION] = wrapped(self.state[ORIENTATION])
        self.time_ns = time_ns

    def correct(self, measurement: Measurement) -> bool:
        """Correct the estimate; return whether the measurement was used."""
        measured, noise = measurement.measured()
        if not len(measured):
            return False
        before = self.state, self.covariance
        self.state, self.covariance = self.state.copy(), self.covariance.copy()
        try:
            is_used = self._correct(measured, measurement.values[measured], noise, measurement)
        except np.linalg.LinAlgError:  # a covariance is not positive definite
            is_used = False
        if is_used and np.isfinite(self.state).all() and np.isfinite(self.covariance).all():
            self.state[ORIENTATION] = wrapped(self.state[ORIENTATION])
            return True
        self.state, self.covariance = before
        return False

    def _noise(self) -> Array:
        """Return the process noise; if dynamic, the pose of a robot at rest stays as certain."""
        if not self.is_noise_dynamic:
            return self.process_noise
        noise = self.process_noise.copy()
        noise[POSE, POSE] *= float(self.state[TWIST] @ self.state[TWIST])
        return noise

    def _controlled(self, state: Array, accelerations: Array, seconds: float) -> Array:
        """Return a state with the accelerations due to the command."""
        result = state.copy()
        result[ANGULAR] += accelerations[3:] * seconds
        mask = np.array(self.control.mask[:3], dtype=bool)
        result[ACCELERATION] = np.where(mask, accelerations[:3], result[ACCELERATION])
        return result

    @abstractmethod
    def _predict(self, seconds: float, accelerations: Array) -> None:
        """Move state and covariance by a time."""

    @abstractmethod
    def _correct(
        self, measured: Indices, values: Array, noise: Array, measurement: Measurement
    ) -> bool:
        """Correct state and covariance, unless the measurement is too far from the estimate."""


def is_near(innovation: Array, inverse: Any, threshold: float) -> bool:
    """Return whether a measurement is within a number of standard deviations of the estimate."""
    return float(innovation @ inverse @ innovation) < threshold * threshold


def transfer(state: Array, seconds: float) -> Array:
    """Return the matrix that moves a state by a time."""
    roll, pitch, yaw = state[ORIENTATION]
    rotation = matrix_of(roll, pitch, yaw)
    result = np.eye(SIZE)
    result[POSITION, LINEAR] = rotation * seconds
    result[POSITION, ACCELERATION] = rotation * (0.5 * seconds * seconds)
    result[ORIENTATION, ANGULAR] = angle_rates(roll, pitch) * seconds
    result[LINEAR, ACCELERATION] = np.eye(3) * seconds
    return result


def angle_rates(roll: float, pitch: float) -> Array:
    """Return the matrix that turns angular velocities into the rates of roll, pitch and yaw."""
    sr, cr = math.sin(roll), math.cos(roll)
    tp, cpi = math.tan(pitch), 1.0 / math.cos(pitch)
    return np.array([[1.0, sr * tp, cr * tp], [0.0, cr, -sr], [0.0, sr * cpi, cr * cpi]])


def jacobian(state: Array, seconds: float) -> Array:
    """Return the derivative of the moved state with respect to the state."""
    roll, pitch, yaw = state[ORIENTATION]
    result = transfer(state, seconds)
    rotation = matrix_of(roll, pitch, yaw)
    path = state[LINEAR] * seconds + state[ACCELERATION] * (0.5 * seconds * seconds)
    about_y = np.array(
        [[0.0, 0.0, math.cos(yaw)], [0.0, 0.0, math.sin(yaw)], [-math.cos(yaw), -math.sin(yaw), 0]]
    )
    result[POSITION, 3] = rotation @ ABOUT_X @ path
    result[POSITION, 4] = about_y @ rotation @ path
    result[POSITION, 5] = ABOUT_Z @ rotation @ path

    sr, cr = math.sin(roll), math.cos(roll)
    tp, cpi = math.tan(pitch), 1.0 / math.cos(pitch)
    _, about_pitch, about_yaw = state[ANGULAR] * seconds
    by_roll = cr * about_pitch - sr * about_yaw
    by_pitch = sr * about_pitch + cr * about_yaw
    result[ORIENTATION, 3] += (tp * by_roll, -by_pitch, cpi * by_roll)
    result[ORIENTATION, 4] += (cpi * cpi * by_pitch, 0.0, tp * cpi * by_pitch)
    return result


class Ekf(Filter):
    """The extended filter: the motion is linear near the estimate."""

    def _predict(self, seconds: float, accelerations: Array) -> None:
        derivative = jacobian(self.state, seconds)
        noise = self._noise()
        matrix = transfer(self.state, seconds)
        self.state = matrix @ self._controlled(self.state, accelerations, seconds)
        self.covariance = derivative @ self.covariance @ derivative.T + seconds * noise

    def _correct(
        self, measured: Indices, values: Array, noise: Array, measurement: Measurement
    ) -> bool:
        cross = self.covariance[:, measured]
        inverse = np.linalg.inv(cross[measured] + noise)
        gain = cross @ inverse
        innovation = values - self.state[measured]
        innovation = np.where(ANGLES[measured], wrapped(innovation), innovation)
        if not is_near(innovation, inverse, measurement.threshold):
            return False
        self.state = self.state + gain @ innovation
        left = np.eye(SIZE)
        left[:, measured] -= gain
        # Joseph's form, which stays symmetric and positive.
        self.covariance = left @ self.covariance @ left.T + gain @ noise @ gain.T
        return True


class Ukf(Filter):
    """The unscented filter: points around the estimate move, and their mean is the next one.

    Args:
        alpha: The spread of the points around the estimate.
        kappa: A secondary spread, which is added to the number of variables.
        beta: Prior knowledge of the distribution; 2 is optimal for a normal one.

    Raises:
        ValueError: There are no points around the estimate.
    """

    def __init__(self, alpha: float = 0.001, kappa: float = 0.0, beta: float = 2.0) -> None:
        self.scale = alpha * alpha * (SIZE + kappa)
        if not 0.0 < self.scale < math.inf:
            problem = f"alpha² ({SIZE} + kappa) is {self.scale:g}; it has to be above 0"
            raise ValueError(problem)
        first = (self.scale - SIZE) / self.scale
        self.weights = np.full(2 * SIZE + 1, 0.5 / self.scale)
        self.weights[0] = first
        self.covariance_weights = self.weights.copy()
        self.covariance_weights[0] = first + 1.0 - alpha * alpha + beta
        super().__init__()

    def around(self) -> Array:
        """Return the points around the estimate, one per row."""
        scaled = self.scale * (self.covariance + self.covariance.T) / 2
        if not np.isfinite(scaled).all():  # it has no root, and the node says that it is lost
            return np.full((2 * SIZE + 1, SIZE), math.nan)
        try:
            root = np.linalg.cholesky(scaled)
        except np.linalg.LinAlgError:  # rounded down below 0
            values, vectors = np.linalg.eigh(scaled)
            root = vectors * np.sqrt(np.maximum(values, 0.0))
        return np.vstack([self.state, self.state + root.T, self.state - root.T])

    def mean(self, points: Array, is_angle: Mask) -> Array:
        """Return the weighted mean of points."""
        straight = self.weights @ points
        around = np.arctan2(self.weights @ np.sin(points), self.weights @ np.cos(points))
        return np.where(is_angle, around, straight)

    def _predict(self, seconds: float, accelerations: Array) -> None:
        points = np.array(
            [
                transfer(point, seconds) @ self._controlled(point, accelerations, seconds)
                for point in self.around()
            ]
        )
        self.state = self.mean(points, ANGLES)
        off = points - self.state
        off[:, ANGLES] = wrapped(off[:, ANGLES])
        self.covariance = (self.covariance_weights * off.T) @ off + seconds * self._noise()

    def _correct(
        self, measured: Indices, values: Array, noise: Array, measurement: Measurement
    ) -> bool:
        points = self.around()
        is_angle = ANGLES[measured]
        predicted = self.mean(points[:, measured], is_angle)
        off = points[:, measured] - predicted
        off[:, is_angle] = wrapped(off[:, is_angle])
        state_off = points - self.state
        state_off[:, ANGLES] = wrapped(state_off[:, ANGLES])
        spread = (self.covariance_weights * off.T) @ off + noise
        cross = (self.covariance_weights * state_off.T) @ off
        inverse = np.linalg.inv(spread)
        innovation = values - predicted
        innovation = np.where(is_angle, wrapped(innovation), innovation)
        if not is_near(innovation, inverse, measurement.threshold):
            return False
        gain = cross @ inverse
        self.state = self.state + gain @ innovation
        self.covariance = self.covariance - gain @ spread @ gain.T
        return True
