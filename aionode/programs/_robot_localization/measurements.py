"""Turns messages of sensors into measurements of the state, in the frames of the filter."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np

from aionode.errors import escaped
from aionode.programs._poses import Array, matrix_of, wrapped
from aionode.programs._robot_localization.kalman import (
    ACCELERATION,
    ANGULAR,
    LINEAR,
    NAMES,
    ORIENTATION,
    POSE,
    POSITION,
    SIZE,
    TWIST,
    Filter,
    Mask,
    Measurement,
)
from aionode.programs._stamps import nanoseconds
from aionode.tf import rotation_matrix
from aionode.tf.apply import angles_of

__all__ = ["Frames", "Measuring", "Sensor", "is_unknown"]

Lookup = Callable[[str, str, int], Array | None]
"""Returns the matrix from a frame (the second one) to another at a time, if there is one."""

Complain = Callable[[str, str], object]
"""Takes a key and a text for the diagnostics."""

FLAT: Final = [2, 3, 4, 8, 9, 10, 14]
"""The values that are zero for a robot on a plane: height, roll, pitch, and their changes."""

FLAT_VARIANCE: Final = 1e-6
LARGE: Final = 1e3
VISIBLE: Final = 1e-6


@dataclass(frozen=True)
class Sensor:
    """How a part of a topic is used: its pose, its twist or its acceleration.

    Attributes:
        name: The topic's parameter and the part, such as ``odom0_pose``.
        mask: Which values of the state it measures.
        is_differential: Whether the change of a pose counts as a velocity.
        is_relative: Whether poses are relative to the first one.
        has_own_frame: Whether the pose is that of the message's child frame.
        threshold: The number of standard deviations from the estimate at which it is rejected.
        removes_gravity: Whether an acceleration includes gravity.
    """

    name: str
    mask: Mask
    is_differential: bool = False
    is_relative: bool = False
    has_own_frame: bool = False
    threshold: float = math.inf
    removes_gravity: bool = False

    def part(self, name: str, kept: slice, threshold: float) -> Sensor:
        """Return the sensor of a part of its messages, which measures these values only."""
        mask = np.zeros(SIZE, dtype=bool)
        mask[kept] = self.mask[kept]
        return replace(self, name=f"{self.name}{name}", mask=mask, threshold=threshold)


@dataclass(frozen=True)
class Frames:
    """The frames of the filter, and the motion in them.

    Attributes:
        world: The frame of poses.
        base: The frame of the robot, of its velocities and of its accelerations.
        is_flat: Whether the robot moves on a plane.
        gravity: The acceleration of gravity, in m/s².
    """

    world: str
    base: str
    is_flat: bool = False
    gravity: float = 9.80665


@dataclass
class Measuring:
    """Turns messages into measurements.

    Attributes:
        frames: The frames of the filter.
        filter: The filter, whose estimate says how a sensor moves.
        lookup: Finds transforms.
        complain: Reports messages that look wrong.
        angular_acceleration: The angular acceleration of the robot, in its frame.
        last_ns: The stamp of the last message of each sensor.
        first: The first pose of each relative sensor.
        previous: The last pose and covariance of each differential sensor.
    """

    frames: Frames
    filter: Filter
    lookup: Lookup
    complain: Complain
    angular_acceleration: Array = field(default_factory=lambda: np.zeros(3))
    last_ns: dict[str, int] = field(default_factory=dict)
    first: dict[str, Array] = field(default_factory=dict)
    previous: dict[str, tuple[Array, Array]] = field(default_factory=dict)

    def forget(self) -> None:
        """Forget the poses of sensors, since the robot was put elsewhere."""
        self.first.clear()
        self.previous.clear()

    def _moved(self, sensor: Sensor, target: str, source: str, stamp_ns: int) -> Array | None:
        """Return the matrix between two frames; None, and the message is ignored, without one."""
        found = self.lookup(target, source, stamp_ns)
        if found is None:
            self.complain(
                f"{sensor.name}_transform",
                f"There is no transform from '{escaped(source, one_line=True)}' to '{target}'; the "
                f"{sensor.name} message is ignored.",
            )
        return found

    def pose(self, sensor: Sensor, header: Any, given: Any, source: str) -> Measurement | None:
        """Return the measurement of a pose with covariance, that of the frame `source`."""
        target = self.frames.world
        frame = target if sensor.is_differential else header.frame_id
        stamp_ns = nanoseconds(header.stamp)
        to_target = self._moved(sensor, target, frame, stamp_ns)
        to_base = np.eye(4)
        if source != self.frames.base:
            found = self.lookup(source, self.frames.base, stamp_ns)
            to_base = to_base if found is None else found
        if to_target is None:
            return None
        covariance = self._covariance(sensor, given.covariance, POSE)
        covariance = turned(to_base[:3, :3].T, covariance)
        return self._posed(
            sensor, stamp_ns, self._matrix(sensor, given.pose), covariance, to_target, to_base
        )

    def orientation(self, sensor: Sensor, imu: Any) -> Measurement | None:
        """Return an IMU's measurement of its orientation, which it reports in the world.

        Its frame only says how it is mounted: these angles are subtracted, and roll and pitch are
        turned by the angle about the vertical.
        """
        stamp_ns = nanoseconds(imu.header.stamp)
        mounted = self._moved(sensor, self.frames.base, imu.header.frame_id, stamp_ns)
        if mounted is None:
            return None
        covariance = np.zeros((6, 6))
        covariance[3:, 3:] = np.asarray(imu.orientation_covariance).reshape(3, 3)
        covariance = self._covariance(sensor, covariance, POSE)
        offsets = np.array(angles_of(mounted[:3, :3]))
        matrix = self._matrix(sensor, imu)
        angles = wrapped(np.array(angles_of(matrix[:3, :3])) - offsets)
        turn = np.eye(4)
        turn[:3, :3] = matrix_of(0.0, 0.0, offsets[2])
        matrix[:3, :3] = matrix_of(*(turn[:3, :3] @ angles))
        return self._posed(sensor, stamp_ns, matrix, covariance, turn, np.eye(4), is_turned=True)

    def _posed(
        self,
        sensor: Sensor,
        stamp_ns: int,
        matrix: Array,
        covariance: Array,
        to_target: Array,
        to_base: Array,
        *,
        is_turned: bool = False,
    ) -> Measurement | None:
        """Return a measurement by a pose; `is_turned` if the pose is in the target frame."""
        rotation = to_target[:3, :3]
        mask = sensor.mask.copy()
        mask[POSITION] = seen(rotation, mask[POSITION])
        mask[ORIENTATION] = seen(rotation, mask[ORIENTATION])
        turned_covariance = turned(rotation, covariance)
        move = np.eye(4) if is_turned else to_target
        if (sensor.is_differential or sensor.is_relative) and not np.isfinite(matrix).all():
            return None  # later poses are compared with this one
        if sensor.is_differential:
            before = self.previous.get(sensor.name)
            self.previous[sensor.name] = matrix, covariance
            seconds = (stamp_ns - self.last_ns.get(sensor.name, stamp_ns)) / 1e9
            if before is None or seconds <= 0.0:
                return None
            step = np.linalg.inv(before[0]) @ matrix
            way = move[:3, :3] @ step[:3, 3]
            angles = angles_of(move[:3, :3] @ step[:3, :3])
            mask[TWIST], mask[POSE] = mask[POSE].copy(), False
            both = (turned_covariance + turned(rotation, before[1])) * seconds
            velocities = np.array([*way, *angles]) / seconds
            return self._measured(sensor, stamp_ns, TWIST, velocities, both, mask)
        matrix = matrix @ to_base
        if sensor.is_relative:
            matrix = np.linalg.inv(self.first.setdefault(sensor.name, matrix)) @ matrix
        matrix = move @ matrix
        values = np.array([*matrix[:3, 3], *angles_of(matrix[:3, :3])])
        return self._measured(sensor, stamp_ns, POSE, values, turned_covariance, mask)

    def twist(self, sensor: Sensor, header: Any, given: Any, frame: str) -> Measurement | None:
        """Return the measurement of a twist with covariance in a frame."""
        stamp_ns = nanoseconds(header.stamp)
        mounted = self._moved(sensor, self.frames.base, frame, stamp_ns)
        if mounted is None:
            return None
        rotation, offset = mounted[:3, :3], mounted[:3, 3]
        linear, angular = given.twist.linear, given.twist.angular
        values = np.zeros(6)
        # A sensor away from the centre moves when the robot turns.
        values[:3] = rotation @ (linear.x, linear.y, linear.z)
        values[:3] += np.cross(offset, self.filter.state[ANGULAR])
        values[3:] = rotation @ (angular.x, angular.y, angular.z)
        mask = sensor.mask.copy()
        mask[LINEAR] = seen(rotation, mask[LINEAR])
        mask[ANGULAR] = seen(rotation, mask[ANGULAR])
        covariance = turned(rotation, self._covariance(sensor, given.covariance, TWIST))
        return self._measured(sensor, stamp_ns, TWIST, values, covariance, mask)

    def acceleration(self, sensor: Sensor, imu: Any) -> Measurement | None:
        """Return an IMU's measurement of the acceleration."""
        stamp_ns = nanoseconds(imu.header.stamp)
        frame = imu.header.frame_id or self.frames.base
        mounted = self._moved(sensor, self.frames.base, frame, stamp_ns)
        if mounted is None:
            return None
        rotation, offset = mounted[:3, :3], mounted[:3, 3]
        given = imu.linear_acceleration
        turning = self.filter.state[ANGULAR]
        values = rotation @ (given.x, given.y, given.z)
        values += np.cross(offset, self.angular_acceleration)
        values -= np.cross(np.cross(offset, turning), turning)
        if sensor.removes_gravity:
            values -= self._gravity(sensor, imu, rotation)
        mask = sensor.mask.copy()
        mask[ACCELERATION] = seen(rotation, mask[ACCELERATION])
        covariance = self._covariance(sensor, imu.linear_acceleration_covariance, ACCELERATION)
        covariance = rotation @ covariance @ rotation.T
        return self._measured(sensor, stamp_ns, ACCELERATION, values, covariance, mask)

    def _gravity(self, sensor: Sensor, imu: Any, mounted: Array) -> Array:
        """Return the acceleration that an IMU at rest measures."""
        up = np.array([0.0, 0.0, self.frames.gravity])
        if is_unknown(imu.orientation_covariance):
            attitude = matrix_of(*self.filter.state[ORIENTATION]) @ mounted
        else:
            attitude = self._matrix(sensor, imu)[:3, :3]
            if sensor.is_relative:
                attitude = attitude @ mounted
        weight: Array = attitude.T @ up
        return weight

    def _matrix(self, sensor: Sensor, pose: Any) -> Array:
        """Return a pose as a matrix; for an IMU, which has no position, the orientation."""
        turn = pose.orientation
        if sensor.mask[ORIENTATION].any() and not (turn.x or turn.y or turn.z or turn.w):
            self.complain(
                f"{sensor.name}_orientation",
                f"The {sensor.name} message contains an invalid orientation quaternion, but its "
                "configuration is such that orientation data is being used. Correcting...",
            )
        result = np.eye(4)
        result[:3, :3] = rotation_matrix(turn)
        if hasattr(pose, "position"):
            result[:3, 3] = pose.position.x, pose.position.y, pose.position.z
        return result

    def _covariance(self, sensor: Sensor, given: Any, part: slice) -> Array:
        """Return a covariance as a matrix, and report what is wrong with it."""
        size = part.stop - part.start
        covariance = np.array(given, dtype=float).reshape(size, size)
        for index in np.flatnonzero(sensor.mask[part]):
            variance = float(covariance[index, index])
            if 0.0 < variance <= LARGE:
                continue
            what = (
                f"was {variance:g}. This will be replaced with a small positive value to maintain "
                "filter stability, but should be corrected at the message origin node."
            )
            if variance > LARGE:
                what = (
                    f"is extremely large ({variance:g}), although the value is used. This may "
                    "produce undesirable results."
                )
            self.complain(
                f"{sensor.name}_covariance",
                f"The covariance at position ({index * (size + 1)}), which corresponds to "
                f"{NAMES[part.start + index]} variance, {what}",
            )
        return covariance

    def _measured(
        self,
        sensor: Sensor,
        stamp_ns: int,
        part: slice,
        values: Array,
        covariance: Array,
        mask: Mask,
    ) -> Measurement | None:
        """Return the measurement of a part of the state; None if its covariance is not a number."""
        state, whole = np.zeros(SIZE), np.zeros((SIZE, SIZE))
        state[part], whole[part, part] = values, covariance
        if self.frames.is_flat:
            state[FLAT], mask[FLAT] = 0.0, True
            whole[FLAT, FLAT] = FLAT_VARIANCE
        if not np.isfinite(whole).all():
            self.complain(
                f"{sensor.name}_covariance",
                f"The covariance of the {sensor.name} message has values that are not finite; the "
                "message is ignored.",
            )
            return None
        return Measurement(sensor.name, stamp_ns, state, whole, mask, sensor.threshold)


def is_unknown(covariance: Any) -> bool:
    """Return whether an IMU lacks the measurement of a covariance, which then begins with -1."""
    return abs(float(covariance[0]) + 1.0) < 1e-9


def seen(rotation: Array, mask: Mask) -> Mask:
    """Return which axes of a turned frame are measured, given those of the sensor's frame."""
    result: Mask = np.linalg.norm(rotation * mask, axis=1) >= VISIBLE
    return result


def turned(rotation: Array, covariance: Array) -> Array:
    """Rotate both halves of a covariance."""
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = rotation
    return both @ covariance @ both.T
