"""``imu_complementary_filter complementary_filter_node``: the orientation of an IMU."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Quaternion, TransformStamped, Vector3Stamped
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.interfaces.sensor_msgs.msg import Imu, MagneticField
from aionode.interfaces.std_msgs.msg import Bool
from aionode.message_filters import ApproximateTimeSynchronizer, Subscriber
from aionode.parameter import QoSOverridingOptions
from aionode.programs._imu_tools.complementary_filter import ComplementaryFilter
from aionode.programs._imu_tools.quaternions import inverse
from aionode.programs._stamps import nanoseconds
from aionode.qos import QoSPolicyKind
from aionode.tf import TransformBroadcaster, rotation_matrix
from aionode.tf.apply import angles_of

__all__ = ["ComplementaryFilterNode", "main"]

QUEUE: Final = 5
SLOP_SEC: Final = 0.1
"""The maximum difference between the stamps of an IMU's and a magnetometer's message."""

OVERRIDES: Final = QoSOverridingOptions(
    (
        *(QoSPolicyKind.DEPTH, QoSPolicyKind.DURABILITY),
        *(QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY),
    )
)


class ComplementaryFilterNode(Node):
    """Publishes the messages of `imu/data_raw` with an orientation, on `imu/data`."""

    def __init__(self) -> None:
        super().__init__("ComplementaryFilterROS")
        self.get_logger().info("Starting ComplementaryFilterROS")
        self.fixed_frame = self.fixed("fixed_frame", "odom")
        self.publishes_tf = self.fixed("publish_tf", value=False)
        self.reverses_tf = self.fixed("reverse_tf", value=False)
        self.is_debugging = self.fixed("publish_debug_topics", value=False)
        self.constant_sec = self.fixed("constant_dt", 0.0)
        has_magnetometer = self.fixed("use_mag", value=False)
        self.filter = ComplementaryFilter(
            gain_acc=self.share("gain_acc"),
            gain_mag=self.share("gain_mag", is_used=has_magnetometer),
            estimates_bias=self.fixed("do_bias_estimation", value=True),
            has_adaptive_gain=self.fixed("do_adaptive_gain", value=True),
        )
        self.filter.bias_alpha = self.share("bias_alpha", is_used=self.filter.estimates_bias)
        self.variance = self.declare_parameter("orientation_stddev", 0.0).value ** 2
        if self.constant_sec < 0.0:
            self.get_logger().warning(
                f"constant_dt parameter is {self.constant_sec:f}, must be >= 0.0. Setting to 0.0"
            )
            self.constant_sec = 0.0
        self.last_ns: int | None = None
        self.broadcaster = TransformBroadcaster(self)
        self.output = self.create_publisher(Imu, "imu/data", QUEUE)
        if self.is_debugging:
            self.angles = self.create_publisher(Vector3Stamped, "imu/rpy/filtered", QUEUE)
            self.still = self.create_publisher(Bool, "imu/steady_state", QUEUE)
        imu = Subscriber(self, Imu, "imu/data_raw", qos_overriding_options=OVERRIDES)
        if has_magnetometer:
            magnetometer = Subscriber(
                self, MagneticField, "imu/mag", qos_overriding_options=OVERRIDES
            )
            both = ApproximateTimeSynchronizer([imu, magnetometer], QUEUE, SLOP_SEC)
            both.registerCallback(self.measure)
        else:
            imu.registerCallback(self.measure)

    def fixed(self, name: str, value: Any) -> Any:
        """Declare a parameter that cannot be changed, and return its value."""
        return self.declare_parameter(name, value, ParameterDescriptor(read_only=True)).value

    def share(self, name: str, *, is_used: bool = True) -> float:
        """Declare a parameter between 0 and 1, and return its value, or the default."""
        value: float = self.fixed(name, 0.01)
        if 0.0 <= value <= 1.0:
            return value
        if is_used:
            self.get_logger().warning(f"Invalid {name} passed to ComplementaryFilter.")
        return 0.01

    def measure(self, msg: Imu, magnetometer: MagneticField | None = None) -> None:
        """Publish a message with an orientation; the first message only sets the time."""
        stamp_ns = nanoseconds(msg.header.stamp)
        last_ns, self.last_ns = self.last_ns, stamp_ns
        if last_ns is None:
            return
        seconds = (stamp_ns - last_ns) / 1e9
        if self.constant_sec and magnetometer is None:
            seconds = self.constant_sec
        given, turning = msg.linear_acceleration, msg.angular_velocity
        field = None if magnetometer is None else magnetometer.magnetic_field
        is_used = self.filter.update(
            (given.x, given.y, given.z),
            (turning.x, turning.y, turning.z),
            seconds,
            None if field is None else (field.x, field.y, field.z),
        )
        if not is_used:
            self.get_logger().warning(
                "imu/data_raw: a message without gravity, or with numbers that are not finite, is "
                "ignored",
                throttle_duration_sec=5.0,
            )
            return
        self.publish(msg)

    def publish(self, msg: Imu) -> None:
        """Publish the orientation, with a message of the IMU."""
        w, x, y, z = self.filter.orientation
        turn = Quaternion(x=x, y=y, z=z, w=w)
        result = Imu(
            header=msg.header,
            orientation=turn,
            orientation_covariance=np.diag([self.variance] * 3).reshape(-1),
            angular_velocity_covariance=msg.angular_velocity_covariance,
            linear_acceleration=msg.linear_acceleration,
            linear_acceleration_covariance=msg.linear_acceleration_covariance,
        )
        bias = self.filter.bias
        result.angular_velocity.x = msg.angular_velocity.x - bias[0]
        result.angular_velocity.y = msg.angular_velocity.y - bias[1]
        result.angular_velocity.z = msg.angular_velocity.z - bias[2]
        self.output.publish(result)
        if self.is_debugging:
            angles = Vector3Stamped(header=msg.header)
            angles.vector.x, angles.vector.y, angles.vector.z = angles_of(rotation_matrix(turn))
            self.angles.publish(angles)
            if self.filter.estimates_bias:
                self.still.publish(Bool(data=self.filter.is_still))
        if self.publishes_tf:
            self.broadcast(msg)

    def broadcast(self, msg: Imu) -> None:
        """Broadcast the orientation as a transform."""
        turn = self.filter.orientation
        frames = self.fixed_frame, msg.header.frame_id
        if self.reverses_tf:
            turn, frames = inverse(turn), (frames[1], frames[0])
        transform = TransformStamped(child_frame_id=frames[1])
        transform.header.stamp, transform.header.frame_id = msg.header.stamp, frames[0]
        w, x, y, z = turn
        transform.transform.rotation = Quaternion(x=x, y=y, z=z, w=w)
        self.broadcaster.sendTransform(transform)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(ComplementaryFilterNode)
