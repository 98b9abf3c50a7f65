"""The sensors of robot_localization's filters: topics, and the measurements that they bring."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable
from itertools import count
from typing import Any, Final

import numpy as np

from aionode import Node, Parameter, QoSProfile, ReliabilityPolicy, Time
from aionode.errors import CommandError, TransformException
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.interfaces.geometry_msgs.msg import (
    PoseWithCovarianceStamped,
    Twist,
    TwistWithCovarianceStamped,
)
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.programs._poses import Array, pose_matrix
from aionode.programs._robot_localization.kalman import (
    ACCELERATION,
    ANGULAR,
    NAMES,
    ORIENTATION,
    POSE,
    POSITION,
    SIZE,
    TWIST,
    Filter,
    Measurement,
)
from aionode.programs._robot_localization.measurements import (
    Measuring,
    Sensor,
    is_unknown,
)
from aionode.programs._robot_localization.settings import SettingsNode
from aionode.programs._stamps import nanoseconds
from aionode.tf import Buffer

__all__ = ["MAX_QUEUED", "SensingNode"]

MAX_QUEUED: Final = 2000
"""Measurements that wait for their time, or are kept for later corrections: 4 MB."""


class SensingNode(SettingsNode):
    """Subscribes to the sensors, and queues their measurements for the next update."""

    def __init__(self, name: str, make_filter: Callable[[Node], Filter]) -> None:
        super().__init__(name, make_filter)
        self.buffer = Buffer(self)
        self.measuring = Measuring(self.frames, self.filter, self.transform, self.tell)
        self.queue: list[tuple[int, int, Measurement]] = []
        self.numbers = count()
        self.set_ns = 0  # messages that are not newer than the last `set_pose` are ignored
        self.measured: dict[str, int] = dict.fromkeys(NAMES, 0)
        self.subscribe()

    def reset(self) -> None:
        """Forget everything."""
        raise NotImplementedError

    def subscribe(self) -> None:
        """Subscribe to the topics of the sensors."""
        for kind, make in (
            ("odom", self.add_odometry),
            ("pose", self.add_pose),
            ("twist", self.add_twist),
            ("imu", self.add_imu),
        ):
            for number in count():
                name = f"{kind}{number}"
                topic = self.optional(name, Parameter.Type.STRING)
                if topic is None:
                    break
                make(name, topic)
        mask = np.array(self.filter.control.mask)
        if mask.any():
            self.create_subscription(Twist, "cmd_vel", self.on_command, 1)
        if self.has_diagnostics:
            self.check_measured()

    def sensor(self, name: str, *, has_pose: bool = True, **more: Any) -> Sensor:
        """Read the parameters that the sensors have in common."""
        mask = np.array(self.given(f"{name}_config", [False] * SIZE), dtype=bool)
        if len(mask) != SIZE:
            raise CommandError(
                f"{name}_config has {len(mask)} values; use {SIZE}, one for each of "
                f"{', '.join(NAMES)}"
            )
        if not has_pose:
            return Sensor(name, mask, **more)
        is_differential = self.given(f"{name}_differential", value=False)
        is_relative = self.given(f"{name}_relative", value=False)
        if is_relative and is_differential:
            self.get_logger().error(
                f"Both {name}_differential and {name}_relative were set to true. Using "
                "differential mode."
            )
            is_relative = False
        return Sensor(name, mask, is_differential, is_relative, **more)

    def threshold(self, name: str) -> float:
        """Return the threshold for rejecting measurements, which a parameter sets."""
        value: float = self.given(f"{name}_rejection_threshold", math.inf)
        return value

    def listen(
        self, kind: Any, name: str, topic: str, parts: list[Sensor], use: Callable[[Any], None]
    ) -> None:
        """Subscribe, if a sensor measures anything."""
        depth = self.given(f"{name}_queue_size", 10)
        if not any(part.mask.any() for part in parts):
            text = f"{topic} is listed as an input topic, but all update variables are false"
            self.get_logger().error(f"Warning: {text}")
            self.tell_for_good(f"{topic}_configuration", text, DiagnosticStatus.WARN)
            return
        for part in parts:
            for index in np.flatnonzero(part.mask):
                self.measured[NAMES[index + 6 * part.is_differential * (index < 6)]] += 1
        qos = QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT)

        async def on_message(msg: Any) -> None:
            if self.tf_timeout_sec > 0.0:
                await self.wait_for_frames(msg, parts)
            use(msg)

        self.create_subscription(kind, topic, on_message, qos)

    def add_odometry(self, name: str, topic: str) -> None:
        """Use the poses and the twists of odometry."""
        sensor = self.sensor(name, has_own_frame=self.given(f"{name}_pose_use_child_frame", False))
        pose = sensor.part("_pose", POSE, self.threshold(f"{name}_pose"))
        twist = sensor.part("_twist", TWIST, self.threshold(f"{name}_twist"))

        def use(msg: Odometry) -> None:
            source = msg.child_frame_id if pose.has_own_frame else self.frames.base
            self.use(pose, msg, lambda: self.measuring.pose(pose, msg.header, msg.pose, source))
            frame = msg.child_frame_id or self.frames.base
            self.use(twist, msg, lambda: self.measuring.twist(twist, msg.header, msg.twist, frame))

        self.listen(Odometry, name, topic, [pose, twist], use)

    def add_pose(self, name: str, topic: str) -> None:
        """Use poses."""
        sensor = self.sensor(name).part("", POSE, self.threshold(name))
        base = self.frames.base

        def use(msg: PoseWithCovarianceStamped) -> None:
            self.use(sensor, msg, lambda: self.measuring.pose(sensor, msg.header, msg.pose, base))

        self.listen(PoseWithCovarianceStamped, name, topic, [sensor], use)

    def add_twist(self, name: str, topic: str) -> None:
        """Use twists."""
        sensor = self.sensor(name, has_pose=False).part("", TWIST, self.threshold(name))

        def use(msg: TwistWithCovarianceStamped) -> None:
            frame = msg.header.frame_id or self.frames.base
            self.use(
                sensor, msg, lambda: self.measuring.twist(sensor, msg.header, msg.twist, frame)
            )

        self.listen(TwistWithCovarianceStamped, name, topic, [sensor], use)

    def add_imu(self, name: str, topic: str) -> None:
        """Use the orientations, angular velocities and accelerations of an IMU."""
        has_gravity = self.given(f"{name}_remove_gravitational_acceleration", value=False)
        sensor = self.sensor(name, removes_gravity=has_gravity)
        for part, what in ((POSITION, "positional data"), (slice(6, 9), "linear velocity data")):
            if sensor.mask[part].any():
                self.get_logger().warning(
                    f"Warning: Some position entries in parameter {name}_config are set to true, "
                    f"but the sensor_msgs/Imu message contains no {what}"
                )
        pose = sensor.part("_pose", ORIENTATION, self.threshold(f"{name}_pose"))
        twist = sensor.part("_twist", ANGULAR, self.threshold(f"{name}_twist"))
        push = sensor.part(
            "_acceleration", ACCELERATION, self.threshold(f"{name}_linear_acceleration")
        )
        self.leave_to_imu(push)

        def use(msg: Imu) -> None:
            frame = msg.header.frame_id or self.frames.base
            if not is_unknown(msg.orientation_covariance):
                self.use(pose, msg, lambda: self.measuring.orientation(pose, msg))
            if not is_unknown(msg.angular_velocity_covariance):
                whole = TwistWithCovarianceStamped()
                whole.twist.twist.angular = msg.angular_velocity
                covariance = np.zeros((6, 6))
                covariance[3:, 3:] = np.reshape(msg.angular_velocity_covariance, (3, 3))
                whole.twist.covariance = covariance.reshape(-1)
                self.use(
                    twist,
                    msg,
                    lambda: self.measuring.twist(twist, msg.header, whole.twist, frame),
                )
            if not is_unknown(msg.linear_acceleration_covariance):
                self.use(push, msg, lambda: self.measuring.acceleration(push, msg))

        self.listen(Imu, name, topic, [pose, twist, push], use)

    def leave_to_imu(self, sensor: Sensor) -> None:
        """Stop using commands for accelerations that are measured."""
        mask = list(self.filter.control.mask)
        for index, axis in enumerate("XYZ"):
            if mask[index] and sensor.mask[12 + index]:
                self.get_logger().error(
                    f"{axis} acceleration is being measured from IMU; {axis} velocity control "
                    "input is disabled"
                )
                mask[index] = False
        self.filter.control.mask = mask

    def check_measured(self) -> None:
        """Report values that several sensors measure, or none."""
        for index, name in enumerate(NAMES[:6]):
            if self.measured[name] > 1:
                self.tell_for_good(
                    f"{name}_configuration",
                    f"{self.measured[name]} absolute pose inputs detected for {name}. This may "
                    "result in oscillations. Please ensure that your variances for each measured "
                    "variable are set appropriately.",
                    DiagnosticStatus.WARN,
                )
            is_flat = self.frames.is_flat and 2 <= index <= 4
            if not (self.measured[name] or self.measured[NAMES[index + 6]] or is_flat):
                self.tell_for_good(
                    f"{name}_configuration",
                    f"Neither {name} nor its velocity is being measured. This will result in "
                    "unbounded error growth and erratic filter behavior.",
                    DiagnosticStatus.ERROR,
                )

    def use(self, sensor: Sensor, msg: Any, measure: Callable[[], Measurement | None]) -> None:
        """Queue a part of a message for the next update, unless it is too old."""
        if not sensor.mask.any():
            return
        stamp_ns = nanoseconds(msg.header.stamp)
        if stamp_ns <= self.set_ns:
            self.tell(
                f"{sensor.name}_timestamp",
                f"The {sensor.name} message has a timestamp equal to or before the last filter "
                "reset, this message will be ignored. This may indicate an empty or bad timestamp. "
                f"(message time: {stamp_ns / 1e9:f})",
            )
            return
        if stamp_ns < self.measuring.last_ns.get(sensor.name, stamp_ns):
            if self.resets_on_jump and self.get_parameter("use_sim_time").value:
                self.reset()
            self.tell(
                f"{sensor.name}_timestamp",
                f"The {sensor.name} message has a timestamp before that of the previous message "
                "received, this message will be ignored. This may indicate a bad timestamp. "
                f"(message time: {stamp_ns / 1e9:f})",
            )
            return
        measurement = measure()
        self.measuring.last_ns[sensor.name] = stamp_ns
        if measurement is None:
            return
        measurement.command = self.filter.control.twist
        measurement.command_ns = self.filter.control.time_ns
        self.put(measurement)
        if len(self.queue) > MAX_QUEUED:
            # The latest has the longest to wait, and mostly comes from a sensor whose clock is
            # ahead.
            latest = max(self.queue)
            self.queue.remove(latest)
            heapq.heapify(self.queue)
            self.tell(
                f"{latest[2].source}_timestamp",
                f"More than {MAX_QUEUED} measurements wait for their time, so the latest, of "
                f"{latest[2].source}, is ignored. Are the clocks of all computers synchronized?",
            )

    def put(self, measurement: Measurement) -> None:
        """Queue a measurement for the next update."""
        heapq.heappush(self.queue, (measurement.time_ns, next(self.numbers), measurement))

    def on_command(self, msg: Twist) -> None:
        """Keep the command to the robot."""
        linear, angular = msg.linear, msg.angular
        twist = np.array([linear.x, linear.y, linear.z, angular.x, angular.y, angular.z])
        if np.isfinite(twist).all():
            self.filter.control.twist, self.filter.control.time_ns = twist, self.now_ns()

    def transform(self, target: str, source: str, time_ns: int) -> Array | None:
        """Return the matrix from one frame to another: at a time, or else the latest."""
        if target == source:
            return np.eye(4)
        for time in (Time(nanoseconds=max(0, time_ns)), Time()):
            try:
                found = self.buffer.lookup_transform_core(target, source, time)
            except TransformException:
                continue
            return pose_matrix(found.transform.translation, found.transform.rotation)
        return None

    async def wait_for_frames(self, msg: Any, parts: list[Sensor]) -> None:
        """Wait until the frame of a message is known, or `transform_timeout` has passed."""
        frames, wanted = self.frames, {}
        if any(part.mask[TWIST.start :].any() for part in parts) or isinstance(msg, Imu):
            wanted[frames.base] = getattr(msg, "child_frame_id", msg.header.frame_id)
        if not isinstance(msg, Imu) and any(
            part.mask[POSE].any() and not part.is_differential for part in parts
        ):
            wanted[frames.world] = msg.header.frame_id
        stamp = Time(nanoseconds=max(0, nanoseconds(msg.header.stamp)))
        for target, source in wanted.items():
            if source and source != target:
                try:
                    await self.buffer.wait_for_transform(
                        target, source, stamp, timeout_sec=self.tf_timeout_sec
                    )
                except TransformException:
                    continue  # the latest one is used
