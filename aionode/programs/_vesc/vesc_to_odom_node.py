"""``vesc_ackermann vesc_to_odom_node``: the odometry of a car, from what its VESC measures."""

from __future__ import annotations

import math
from typing import Final

import aionode
from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.std_msgs.msg import Float64
from aionode.interfaces.vesc_msgs.msg import VescStateStamped
from aionode.programs._stamps import nanoseconds
from aionode.programs._vesc.numbers import FIXED, Line, number
from aionode.tf import TransformBroadcaster

__all__ = ["VescToOdom", "main"]

STILL: Final = 0.05
"""A speed below this is noise, in m/s."""


class VescToOdom(Node):
    """Publishes `odom`, and with ``publish_tf`` its transform.

    Raises:
        CommandError: A parameter is missing or invalid.
    """

    steering_to_servo: Line | None = None
    broadcaster: TransformBroadcaster | None = None

    def __init__(self) -> None:
        super().__init__("vesc_to_odom_node")
        self.odom_frame = self.declare_parameter("odom_frame", "odom", FIXED).value
        self.base_frame = self.declare_parameter("base_frame", "base_link", FIXED).value
        uses_servo = self.declare_parameter(
            "use_servo_cmd_to_calc_angular_velocity", True, FIXED
        ).value
        self.speed_to_erpm = Line.declared(self, "speed_to_erpm")
        divisors = {"speed_to_erpm_gain": self.speed_to_erpm.gain}
        if uses_servo:
            self.steering_to_servo = Line.declared(self, "steering_angle_to_servo")
            self.wheelbase = number(self, "wheelbase")
            divisors["steering_angle_to_servo_gain"] = self.steering_to_servo.gain
            divisors["wheelbase"] = self.wheelbase
        for name, value in divisors.items():
            if value == 0.0:
                raise CommandError(f"parameter '{name}' is 0; the odometry is divided by it")
        if self.declare_parameter("publish_tf", False, FIXED).value:
            self.broadcaster = TransformBroadcaster(self)
        self.angle: float | None = None
        self.last_ns: int | None = None
        self.pose = (0.0, 0.0, 0.0)
        self.output = self.create_publisher(Odometry, "odom", 10)
        self.create_subscription(VescStateStamped, "sensors/core", self.on_state, 10)
        if uses_servo:
            self.create_subscription(Float64, "sensors/servo_position_command", self.on_servo, 10)

    def on_servo(self, servo: Float64) -> None:
        """Keep the steering angle."""
        if self.steering_to_servo is None:
            return
        angle = self.steering_to_servo.invert(servo.data)
        if math.isfinite(angle):
            self.angle = angle

    def on_state(self, msg: VescStateStamped) -> None:
        """Move by the measured speed, since the last message, and publish."""
        angular = 0.0
        speed = self.speed_to_erpm.invert(msg.state.speed)
        if abs(speed) < STILL:
            speed = 0.0
        if self.steering_to_servo is not None:
            if self.angle is None:  # nobody has steered yet
                return
            angular = speed * math.tan(self.angle) / self.wheelbase
        now_ns = nanoseconds(msg.header.stamp)
        # A clock that was set back says nothing about the time between two messages.
        elapsed = max(0, now_ns - (now_ns if self.last_ns is None else self.last_ns)) / 1e9
        x, y, yaw = self.pose
        pose = (
            x + speed * math.cos(yaw) * elapsed,
            y + speed * math.sin(yaw) * elapsed,
            yaw + angular * elapsed,
        )
        if not all(map(math.isfinite, (*pose, speed, angular))):
            self.get_logger().warning(
                f"ignored a state, because a car cannot have the speed {msg.state.speed}",
                throttle_duration_sec=5.0,
            )
            return
        self.pose, self.last_ns = pose, now_ns
        self.publish(msg, speed, angular)

    def publish(self, msg: VescStateStamped, speed: float, angular: float) -> None:
        """Publish the pose and the speeds."""
        x, y, yaw = self.pose
        rotation = Quaternion(z=math.sin(yaw / 2.0), w=math.cos(yaw / 2.0))
        odom = Odometry(child_frame_id=self.base_frame)
        odom.header.frame_id = self.odom_frame
        odom.header.stamp = msg.header.stamp
        odom.pose.pose.position.x, odom.pose.pose.position.y = x, y
        odom.pose.pose.orientation = rotation
        # The variances of x, y and yaw.
        odom.pose.covariance[[0, 7, 35]] = 0.2, 0.2, 0.4
        odom.twist.twist.linear.x = speed
        odom.twist.twist.angular.z = angular
        if self.broadcaster is not None:
            transform = TransformStamped(child_frame_id=self.base_frame)
            transform.header.frame_id = self.odom_frame
            transform.header.stamp = self.get_clock().now().to_msg()
            transform.transform.translation = Vector3(x=x, y=y)
            transform.transform.rotation = rotation
            self.broadcaster.sendTransform(transform)
        self.output.publish(odom)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(VescToOdom)
