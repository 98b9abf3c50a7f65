"""``diff_drive_controller``: drives a base with two driven sides, and publishes its odometry."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, Final

from aionode import Time
from aionode.errors import CommandError
from aionode.interfaces.control_msgs.srv import SetOdometry
from aionode.interfaces.geometry_msgs.msg import (
    Point,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    TwistStamped,
    Vector3,
)
from aionode.interfaces.nav_msgs.msg import Odometry as OdometryMessage
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.lifecycle import State, TransitionCallbackReturn
from aionode.programs._ros2_control.controller import Controller
from aionode.programs._ros2_control.hardware import Hardware
from aionode.programs._ros2_control.odometry import Odometry
from aionode.programs._ros2_control.speed_limiter import SpeedLimiter
from aionode.programs._stamps import nanoseconds

__all__ = ["DiffDriveController"]

DEFAULTS: Final[dict[str, Any]] = {
    "left_wheel_names": [""],
    "right_wheel_names": [""],
    "wheel_separation": 0.0,
    "wheel_radius": 0.0,
    "wheel_separation_multiplier": 1.0,
    "left_wheel_radius_multiplier": 1.0,
    "right_wheel_radius_multiplier": 1.0,
    "tf_frame_prefix_enable": True,
    "tf_frame_prefix": "",
    "odom_frame_id": "odom",
    "base_frame_id": "base_link",
    "pose_covariance_diagonal": [0.0] * 6,
    "twist_covariance_diagonal": [0.0] * 6,
    "open_loop": False,
    "position_feedback": True,
    "enable_odom_tf": True,
    "cmd_vel_timeout": 0.5,
    "publish_limited_velocity": False,
    "velocity_rolling_window_size": 10,
    "publish_rate": 50.0,
}

LIMITS: Final = {
    "has_velocity_limits": ("min_velocity", "max_velocity"),
    "has_acceleration_limits": (
        *("max_acceleration", "max_deceleration"),
        *("max_acceleration_reverse", "max_deceleration_reverse"),
    ),
    "has_jerk_limits": ("min_jerk", "max_jerk"),
}


class DiffDriveController(Controller):
    """Turns the wheels as `~/cmd_vel` says, and stops them when no command has come in time."""

    def __init__(self, name: str, hardware: Hardware, **options: Any) -> None:
        super().__init__(name, hardware, **options)
        self.given = {
            key: self.declare_parameter(key, each).value for key, each in DEFAULTS.items()
        }
        self.is_humble = self.context.ros_distro == "humble"
        self.has_switches = self.context.ros_distro in ("humble", "jazzy")
        # Humble takes Twist as well; later versions ignore the parameter.
        self.is_stamped = (
            not self.is_humble or self.declare_parameter("use_stamped_vel", True).value
        )
        for direction in ("linear.x", "angular.z"):
            for switch, names in LIMITS.items():
                if self.has_switches:
                    self.declare_parameter(f"{direction}.{switch}", not self.is_humble)
                for each in names:
                    self.declare_parameter(f"{direction}.{each}", math.nan)
            if self.is_humble:
                self.declare_parameter(f"{direction}.min_acceleration", math.nan)
        self.wheels: dict[str, list[str]] = {}
        self.command: tuple[float, float] | None = None
        self.heard_ns = 0
        self.create_endpoints()
        self.forget()

    def forget(self) -> None:
        """Forget the commands given so far."""
        self.command = None
        self.last = self.second_to_last = (0.0, 0.0)
        self.published_ns = 0

    def limit_of(self, direction: str, name: str) -> float:
        """Return a limit of a direction, NaN if there is none."""
        switch = next(each for each, names in LIMITS.items() if name in names)
        if self.has_switches and not self.get_parameter(f"{direction}.{switch}").value:
            return math.nan
        if self.is_humble and name in ("max_deceleration", "max_acceleration_reverse"):
            name = "min_acceleration"
        return float(self.get_parameter(f"{direction}.{name}").value)

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Check the parameters.

        Raises:
            CommandError: A parameter is invalid.
        """
        given = self.given
        self.wheels = {
            side: [each for each in given[f"{side}_wheel_names"] if each]
            for side in ("left", "right")
        }
        left, right = (len(names) for names in self.wheels.values())
        if left != right:
            raise CommandError(
                f"The number of left wheels [{left}] and the number of right wheels [{right}] are "
                "different"
            )
        for key, is_fine in (
            ("left_wheel_names", left > 0),
            ("wheel_separation", given["wheel_separation"] > 0),
            ("wheel_radius", given["wheel_radius"] > 0),
        ):
            if not is_fine:
                raise CommandError(f"parameter '{key}' is {given[key]!r}; give the base's own")
        try:
            self.limiters = [
                SpeedLimiter(partial(self.limit_of, each)) for each in ("linear.x", "angular.z")
            ]
        except ValueError as error:
            raise CommandError(f"Failed to configure speed limiter: {error}") from None
        self.feedback = "position" if given["position_feedback"] else "velocity"
        names = [each for side in self.wheels.values() for each in side]
        self.command_names = [f"{each}/velocity" for each in names]
        self.state_names = (
            [] if given["open_loop"] else [f"{each}/{self.feedback}" for each in names]
        )
        self.separation = given["wheel_separation"] * given["wheel_separation_multiplier"]
        self.radii = (
            given["wheel_radius"] * given["left_wheel_radius_multiplier"],
            given["wheel_radius"] * given["right_wheel_radius_multiplier"],
        )
        self.odometry = Odometry(self.separation, self.radii, given["velocity_rolling_window_size"])
        return super().on_configure(state)

    def create_endpoints(self) -> None:
        """Create topics and services."""
        if self.is_stamped:
            self.create_lifecycle_subscription(TwistStamped, "~/cmd_vel", self.on_stamped, 10)
        else:
            self.create_lifecycle_subscription(Twist, "~/cmd_vel_unstamped", self.on_twist, 10)
        self.odometry_publisher = self.create_publisher(OdometryMessage, "~/odom", 10)
        self.transforms = self.create_publisher(TFMessage, "/tf", 10)
        self.create_service(SetOdometry, "~/set_odometry", self.set_odometry)
        self.limited = self.create_publisher(
            Twist if self.is_humble else TwistStamped, "~/cmd_vel_out", 10
        )
        prefix = ""
        if self.given["tf_frame_prefix_enable"]:
            prefix = self.given["tf_frame_prefix"] or self.get_namespace()
            prefix = f"{prefix.strip('/')}/" if prefix.strip("/") else ""
        self.message = OdometryMessage(child_frame_id=prefix + self.given["base_frame_id"])
        self.message.header.frame_id = prefix + self.given["odom_frame_id"]
        for part in ("pose", "twist"):
            covariance = [0.0] * 36
            covariance[::7] = self.given[f"{part}_covariance_diagonal"]
            getattr(self.message, part).covariance = covariance

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Start at the wheels' present positions, without a command."""
        self.forget()
        if self.feedback == "position" and self.state_names:
            self.odometry.positions = self.feedback_mean()
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Forget the command; the wheels stop as their interfaces are taken back."""
        self.forget()
        return super().on_deactivate(state)

    def on_twist(self, twist: Twist) -> None:
        """Take a command without a time."""
        self.on_stamped(TwistStamped(twist=twist))

    def on_stamped(self, msg: TwistStamped) -> None:
        """Take a command, unless it is too old."""
        now = self.get_clock().now().nanoseconds
        sent = nanoseconds(msg.header.stamp)
        if not sent:
            sent = now
            if self.is_stamped:
                self.get_logger().warning(
                    "Received TwistStamped with zero timestamp, setting it to current time, this "
                    "message will only be shown once",
                    once=True,
                )
        timeout = self.given["cmd_vel_timeout"]
        if timeout and now - sent >= timeout * 1e9:
            self.get_logger().warning(
                f"Ignoring the received message (timestamp {sent / 1e9:.10f}) because it is older "
                f"than the current time by {(now - sent) / 1e9:.10f} seconds, which exceeds the "
                f"allowed timeout ({timeout:.4f})"
            )
            return
        command = (msg.twist.linear.x, msg.twist.angular.z)
        if all(map(math.isfinite, command)):
            # A clock that is ahead must not postpone the timeout.
            self.command, self.heard_ns = command, min(sent, now)
        else:
            self.get_logger().warning(
                "Command message contains NaNs. Not updating reference interfaces.",
                throttle_duration_sec=1.0,
            )

    def feedback_mean(self) -> tuple[float, float]:
        """Return what the wheels of the left and of the right side measure, on average."""
        left, right = (
            sum(self.hardware.states[f"{each}/{self.feedback}"] for each in side) / len(side)
            for side in self.wheels.values()
        )
        return left, right

    def update(self, now: Time, period_sec: float) -> None:
        """Turn the wheels as commanded, and publish the odometry."""
        timeout = self.given["cmd_vel_timeout"]
        self.heard_ns = min(self.heard_ns, now.nanoseconds)  # simulated time may be set back
        if self.command and timeout and now.nanoseconds - self.heard_ns > timeout * 1e9:
            if any(self.command):
                self.get_logger().warning("Velocity command timed out. Braking.")
            self.command = (0.0, 0.0)
        if self.command is not None:
            self.drive(self.command, now, period_sec)
        if self.given["open_loop"]:
            self.odometry.move(*self.last, period_sec)
        elif self.feedback == "position":
            self.odometry.turn_to(*self.feedback_mean(), period_sec)
        else:
            self.odometry.turn_at(*self.feedback_mean(), period_sec)
        if (now.nanoseconds - self.published_ns) * self.given["publish_rate"] >= 1e9:
            self.published_ns = now.nanoseconds
            self.publish(now)

    def drive(self, command: tuple[float, float], now: Time, period_sec: float) -> None:
        """Turn the wheels, within the limits."""
        linear, angular = (
            limiter.limit(wanted, last, before, period_sec)
            for limiter, wanted, last, before in zip(
                self.limiters, command, self.last, self.second_to_last, strict=True
            )
        )
        self.last, self.second_to_last = (linear, angular), self.last
        half = angular * self.separation / 2
        for side, speed, radius in zip(
            self.wheels.values(), (linear - half, linear + half), self.radii, strict=True
        ):
            self.hardware.commands |= dict.fromkeys(
                (f"{each}/velocity" for each in side), speed / radius
            )
        if self.given["publish_limited_velocity"]:
            twist = Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))
            stamped = TwistStamped(twist=twist)
            stamped.header.stamp = now.to_msg()
            self.limited.publish(twist if self.is_humble else stamped)

    def publish(self, now: Time) -> None:
        """Publish the odometry."""
        odometry, msg = self.odometry, self.message
        half = odometry.heading / 2
        rotation = Quaternion(z=math.sin(half), w=math.cos(half))
        msg.header.stamp = now.to_msg()
        msg.pose.pose.position = Point(x=odometry.x, y=odometry.y)
        msg.pose.pose.orientation = rotation
        msg.twist.twist.linear.x = odometry.linear
        msg.twist.twist.angular.z = odometry.angular
        self.odometry_publisher.publish(msg)
        if self.given["enable_odom_tf"]:
            transform = TransformStamped(
                header=msg.header,
                child_frame_id=msg.child_frame_id,
                transform=Transform(
                    translation=Vector3(x=odometry.x, y=odometry.y), rotation=rotation
                ),
            )
            self.transforms.publish(TFMessage(transforms=[transform]))

    def set_odometry(
        self, request: SetOdometry.Request, response: SetOdometry.Response
    ) -> SetOdometry.Response:
        """Set the pose of the base."""
        if self.lifecycle_state.label != "active":
            response.message = "Controller is not active"
            return response
        self.odometry.set(request.x, request.y, request.yaw)
        response.success, response.message = True, "Odometry set request accepted"
        return response
