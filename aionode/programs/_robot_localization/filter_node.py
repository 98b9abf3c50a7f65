"""``robot_localization ekf_node`` and ``ukf_node``: one estimate from several sensors."""

from __future__ import annotations

import heapq
from collections import deque
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from aionode import Node, Time
from aionode._process.concurrency import checkpoint
from aionode.diagnostics import FrequencyStatusParam, HeaderlessTopicDiagnostic, Updater
from aionode.errors import escaped
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.interfaces.geometry_msgs.msg import (
    AccelWithCovarianceStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3,
)
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.robot_localization.srv import SetPose, ToggleFilterProcessing
from aionode.interfaces.std_srvs.srv import Empty
from aionode.parameter import QoSOverridingOptions
from aionode.programs._poses import Array, pose_matrix, quaternion_of
from aionode.programs._robot_localization.kalman import (
    ACCELERATION,
    ANGULAR,
    ORIENTATION,
    POSE,
    POSITION,
    SIZE,
    START_VARIANCE,
    TWIST,
    Filter,
    Measurement,
)
from aionode.programs._robot_localization.measurements import Sensor
from aionode.programs._robot_localization.sensors import MAX_QUEUED, SensingNode
from aionode.programs._robot_localization.settings import OK
from aionode.programs._stamps import nanoseconds
from aionode.tf import TransformBroadcaster
from aionode.tf.apply import angles_of

__all__ = ["FilterNode"]

SUMMARIES: Final = {
    OK: "The robot_localization state estimation node appears to be functioning properly.",
    DiagnosticStatus.WARN: "Potentially erroneous data or settings detected for a "
    "robot_localization state estimation node.",
    DiagnosticStatus.ERROR: "Erroneous data or settings detected for a robot_localization state "
    "estimation node.",
}

POSE_VARIANCE: Final = 1e-6
"""The variance of the parts of a pose that `set_pose` does not set."""


class FilterNode(SensingNode):
    """Publishes the pose and twist of the robot, on `odometry/filtered` and as a transform.

    The parameters ``odom0``, ``pose0``, ``twist0``, ``imu0`` and so on name the topics; parameters
    that begin with these names select the values of their messages to use.

    Args:
        name: The name of the node.
        make_filter: Returns the filter, with the parameters of the node.

    Raises:
        CommandError: A parameter is invalid.
    """

    def __init__(self, name: str, make_filter: Callable[[Node], Filter]) -> None:
        super().__init__(name, make_filter)
        self.broadcaster = TransformBroadcaster(self)
        self.due: deque[Measurement] = deque()
        self.used: deque[Measurement] = deque(maxlen=MAX_QUEUED)
        self.states: deque[tuple[int, Array, Array]] = deque(maxlen=MAX_QUEUED)
        self.published_ns = 0
        self.turning: Array = np.zeros(3)
        self.turning_covariance: Array = np.zeros((3, 3))
        self.turning_ns = 0
        self.is_on = True
        self.filter.time_ns = self.now_ns()
        self.offer()

    def offer(self) -> None:
        """Create the publishers and services of the node."""
        overrides = QoSOverridingOptions.with_default_policies()
        self.output = self.create_publisher(
            Odometry, "odometry/filtered", 10, qos_overriding_options=overrides
        )
        if self.publishes_acceleration:
            self.acceleration = self.create_publisher(
                AccelWithCovarianceStamped, "accel/filtered", 10, qos_overriding_options=overrides
            )
        if self.has_diagnostics:
            updater = Updater(self)
            updater.setHardwareID("none")
            updater.add("Filter diagnostic updater", self.diagnose)
            bounds = {"min": self.frequency - 2, "max": self.frequency + 2}
            self.rate = HeaderlessTopicDiagnostic(
                "odometry/filtered", updater, FrequencyStatusParam(bounds, 0.1, 10)
            )
        self.create_subscription(PoseWithCovarianceStamped, "set_pose", self.set_pose, 1)
        self.create_service(SetPose, "set_pose", self.on_set_pose)
        self.create_service(Empty, "enable", self.on_enable)
        self.create_service(Empty, "reset", self.on_reset)
        self.create_service(ToggleFilterProcessing, "toggle", self.on_toggle)
        self.create_timer(1.0 / self.frequency, self.update)

    def diagnose(self, status: Any) -> Any:
        """Fill the status of the filter."""
        level = max(self.fixed_level, DiagnosticStatus.WARN if self.passing else OK)
        status.summary(level, SUMMARIES[level])
        for key, text in (*sorted(self.fixed.items()), *sorted(self.passing.items())):
            status.add(key, text)
        self.passing.clear()
        return status

    def reset(self) -> None:
        """Forget everything."""
        self.forget()
        self.set_ns = self.published_ns = 0
        self.filter.control.time_ns = 0
        self.buffer.clear()
        self.measuring.last_ns.clear()
        covariance = self.first_covariance
        if covariance is None:
            covariance = np.eye(SIZE) * START_VARIANCE
        self.filter.place(np.zeros(SIZE), covariance.copy(), 0)
        self.filter.is_initialized = False

    def forget(self) -> None:
        """Forget all measurements."""
        self.measuring.forget()
        self.queue.clear()
        self.due.clear()
        self.used.clear()
        self.states.clear()

    def set_pose(self, msg: PoseWithCovarianceStamped) -> None:
        """Set the pose of the robot, standing still."""
        frame = escaped(msg.header.frame_id, one_line=True)
        at = msg.pose.pose.position
        self.get_logger().info(
            f"Received set_pose request with value {at.x:g}, {at.y:g}, {at.z:g} in '{frame}'"
        )
        mask = np.ones(SIZE, dtype=bool)
        base = self.frames.base
        sensor = Sensor("set_pose", mask)
        measurement = self.measuring.pose(sensor, msg.header, msg.pose, base)
        state, covariance = np.zeros(SIZE), np.eye(SIZE) * POSE_VARIANCE
        if measurement is None or not np.isfinite(measurement.values).all():
            self.get_logger().error(
                "set_pose: the pose cannot be used: its numbers are not finite, or there is no "
                f"transform from '{frame}' to '{self.frames.world}'"
            )
            return
        self.forget()
        self.set_ns = nanoseconds(msg.header.stamp)
        state[POSE] = measurement.values[POSE]
        covariance[POSE, POSE] = measurement.covariance[POSE, POSE]
        self.filter.place(state, covariance, self.now_ns())

    def on_set_pose(self, request: SetPose.Request, response: SetPose.Response) -> SetPose.Response:
        """Set the pose of the robot."""
        self.set_pose(request.pose)
        return response

    def on_enable(self, _request: Any, response: Empty.Response) -> Empty.Response:
        """Enable the filter, if the node was started with `disabled_at_startup`."""
        if self.is_enabled:
            self.get_logger().warning(
                "Asking for enabling filter service, but the filter was already enabled! Use param "
                "disabled_at_startup."
            )
        else:
            self.get_logger().info("Enabling filter...")
            self.is_enabled = True
        return response

    def on_reset(self, _request: Any, response: Empty.Response) -> Empty.Response:
        """Forget everything."""
        self.get_logger().info("Received a request to reset filter.")
        self.reset()
        return response

    def on_toggle(
        self,
        request: ToggleFilterProcessing.Request,
        response: ToggleFilterProcessing.Response,
    ) -> ToggleFilterProcessing.Response:
        """Set whether measurements are used or ignored."""
        response.status = request.on != self.is_on
        if response.status:
            self.get_logger().info(
                f"Toggling filter measurement filtering to {'On' if request.on else 'Off'}."
            )
            self.is_on = request.on
        else:
            self.get_logger().warning(
                "Service was called to toggle filter processing but state was already as requested."
            )
        return response

    async def update(self) -> None:
        """Use the measurements that are due, and publish the estimate."""
        if not self.is_enabled:
            self.get_logger().info(
                "Filter is disabled. To enable it call the "
                f"{self.resolve_service_name('enable')} service",
                once=True,
            )
            return
        now_ns = self.now_ns()
        if self.is_on:
            await self.integrate(now_ns)
            self.differentiate(now_ns)
        else:
            self.queue.clear()
            if self.filter.is_initialized:
                self.filter.time_ns = now_ns
        if self.filter.is_initialized:
            self.publish()
        if self.is_smoothing:
            oldest_ns = self.filter.time_ns - self.history_ns
            while self.used and self.used[0].time_ns < oldest_ns:
                self.used.popleft()
            while self.states and self.states[0][0] < oldest_ns:
                self.states.popleft()

    async def integrate(self, now_ns: int) -> None:
        """Use the measurements that are due, in the order of their times.

        Others have their turn between two of them: thousands may be due at once.
        """
        predicts = self.predicts_always
        if self.queue:
            restored = 0
            if self.is_smoothing and self.queue[0][0] < self.filter.time_ns:
                before = len(self.queue)
                self.revert(self.queue[0][0] - 1)
                restored = len(self.queue) - before
            while self.queue and self.queue[0][0] <= now_ns:
                self.due.append(heapq.heappop(self.queue)[2])
            while self.due:
                measurement = self.due.popleft()
                if restored > 0 and measurement.command is not None:
                    control = self.filter.control
                    control.twist, control.time_ns = measurement.command, measurement.command_ns
                    restored -= 1
                self.filter.process(measurement)
                if self.is_smoothing:
                    self.used.append(measurement)
                    if not self.due or self.due[0].time_ns != self.filter.time_ns:
                        self.states.append(
                            (
                                self.filter.time_ns,
                                self.filter.state.copy(),
                                self.filter.covariance.copy(),
                            )
                        )
                await checkpoint()
        elif self.filter.is_initialized:
            predicts |= now_ns - self.filter.time_ns >= self.sensor_timeout_ns
        if self.filter.is_initialized and predicts:
            self.filter.predict(max(now_ns, self.filter.time_ns))  # later after a `set_pose`

    def revert(self, time_ns: int) -> None:
        """Return to the estimate before a time, and queue the measurements since then again."""
        state = None
        while self.states and self.states[-1][0] > time_ns:
            state = self.states.pop()
        state = self.states[-1] if self.states else state
        if state is None:
            return
        self.filter.place(state[1].copy(), state[2].copy(), state[0])
        while self.used and self.used[-1].time_ns > time_ns:
            measurement = self.used.pop()
            if measurement.time_ns >= state[0]:
                self.put(measurement)

    def differentiate(self, now_ns: int) -> None:
        """Estimate the angular acceleration from two angular velocities."""
        seconds = (now_ns - self.turning_ns) / 1e9
        if self.filter.is_initialized and seconds > 0.0:
            turning = self.filter.state[ANGULAR].copy()
            self.measuring.angular_acceleration = (turning - self.turning) / seconds
            self.turning_covariance = self.filter.covariance[ANGULAR, ANGULAR] * 2 / seconds**2
            self.turning, self.turning_ns = turning, now_ns

    def publish(self) -> None:
        """Publish the estimate."""
        state, covariance = self.filter.state, self.filter.covariance
        if not (np.isfinite(state).all() and np.isfinite(covariance).all()):
            self.get_logger().error(
                "Critical Error, NaNs were detected in the output state of the filter. This was "
                "likely due to poorly coniditioned process, noise, or sensor covariances. Nothing "
                "is published until `reset` or `set_pose` is called.",
                throttle_duration_sec=5.0,
            )
            return
        msg = Odometry(child_frame_id=self.child)
        msg.header.frame_id = self.frames.world
        msg.header.stamp = Time(nanoseconds=self.filter.time_ns).to_msg()
        at, twist = msg.pose.pose.position, msg.twist.twist
        at.x, at.y, at.z = map(float, state[POSITION])
        msg.pose.pose.orientation = quaternion_of(*map(float, state[ORIENTATION]))
        twist.linear, twist.angular = vector(state[6:9]), vector(state[ANGULAR])
        msg.pose.covariance = covariance[POSE, POSE].reshape(-1)
        msg.twist.covariance = covariance[TWIST, TWIST].reshape(-1)
        is_news = self.publishes_corrections or self.filter.time_ns > self.published_ns
        self.published_ns = self.filter.time_ns
        if is_news:
            if self.publishes_tf:
                self.broadcast(msg)
            self.output.publish(msg)
            if self.publishes_acceleration:
                self.publish_acceleration(msg)
        if self.has_diagnostics:
            self.rate.tick()

    def broadcast(self, msg: Odometry) -> None:
        """Broadcast the pose of the robot, or the correction of its odometry."""
        frames = self.frames
        transform = TransformStamped(child_frame_id=msg.child_frame_id)
        transform.header.frame_id = msg.header.frame_id
        time_ns = max(0, self.filter.time_ns + self.tf_offset_ns)
        transform.header.stamp = Time(nanoseconds=time_ns).to_msg()
        at = msg.pose.pose.position
        transform.transform.translation = Vector3(x=at.x, y=at.y, z=at.z)
        transform.transform.rotation = msg.pose.pose.orientation
        if frames.world == self.map:
            # Another program publishes the robot's pose in `odom`, and a frame has only one parent.
            base_to_odom = self.transform(frames.base, self.odom, 0)
            if base_to_odom is None:
                self.get_logger().error(
                    f"Could not obtain transform from {self.odom}->{frames.base}",
                    throttle_duration_sec=5.0,
                    skip_first=True,
                )
                return
            pose = transform.transform
            matrix = pose_matrix(pose.translation, pose.rotation) @ base_to_odom
            transform.child_frame_id = self.odom
            transform.transform.translation = vector(matrix[:3, 3])
            transform.transform.rotation = quaternion_of(*angles_of(matrix[:3, :3]))
        elif frames.world != self.odom:
            self.get_logger().error(
                f"Odometry message frame_id was {frames.world}, expected {self.map} or {self.odom}",
                throttle_duration_sec=5.0,
            )
            return
        self.broadcaster.sendTransform(transform)

    def publish_acceleration(self, odometry: Odometry) -> None:
        """Publish the acceleration."""
        msg = AccelWithCovarianceStamped()
        msg.header.stamp, msg.header.frame_id = odometry.header.stamp, self.child
        msg.accel.accel.linear = vector(self.filter.state[ACCELERATION])
        msg.accel.accel.angular = vector(self.measuring.angular_acceleration)
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = self.filter.covariance[ACCELERATION, ACCELERATION]
        covariance[3:, 3:] = self.turning_covariance
        msg.accel.covariance = covariance.reshape(-1)
        self.acceleration.publish(msg)


def vector(numbers: Array) -> Vector3:
    """Return three numbers as a message."""
    x, y, z = map(float, numbers)
    return Vector3(x=x, y=y, z=z)
