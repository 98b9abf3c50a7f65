"""``robot_state_publisher``: turns the positions of joints into transforms."""

from __future__ import annotations

import sys

import aionode
from aionode import DurabilityPolicy, Node, Parameter, QoSProfile
from aionode._process.bounded_files import read_file
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.parameter import QoSOverridingOptions
from aionode.programs._stamps import nanoseconds
from aionode.programs._urdf import Joint, Robot
from aionode.qos import qos_profile_sensor_data
from aionode.tf import StaticTransformBroadcaster, TransformBroadcaster

__all__ = ["RobotStatePublisher", "main"]


class RobotStatePublisher(Node):
    """Publishes the poses of a robot's links, from its description and joint positions.

    Fixed joints go to /tf_static once, movable ones to /tf, and the description to
    `robot_description`, where late subscriptions get it too.

    Args:
        file: A file with the description, if the parameter `robot_description` is not set.

    Raises:
        CommandError: There is no description, or it is not a URDF.
    """

    def __init__(self, file: str | None = None) -> None:
        super().__init__("robot_state_publisher")
        text: str = self.declare_parameter("robot_description", "").value
        if not text:
            text = self._read(file)
        if not 0.0 <= self.declare_parameter("publish_frequency", 20.0).value <= 1000.0:
            raise CommandError("publish_frequency must be between 0 and 1000")
        self.declare_parameter("frame_prefix", "")
        self.declare_parameter("ignore_timestamp", False)
        self.broadcaster = TransformBroadcaster(self)
        self.static_broadcaster = StaticTransformBroadcaster(self)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.description = self.create_publisher(String, "robot_description", latched)
        self.published: dict[str, int] = {}  # when each joint was published, in ns
        self.called = 0  # when the last message came, in ns
        try:
            self.use(text)
        except ValueError as error:
            raise CommandError(f"robot_description is not a URDF: {error}") from None
        self.create_subscription(
            JointState,
            "joint_states",
            self.on_joints,
            qos_profile_sensor_data,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.update)

    def _read(self, file: str | None) -> str:
        """Read the description from a file, and set the parameter."""
        if file is None:
            raise CommandError("robot_description parameter must not be empty")
        self.get_logger().warning(
            "No robot_description parameter, but command-line argument available.  Assuming "
            "argument is name of URDF file.  This backwards compatibility fallback will be removed "
            "in the future."
        )
        try:
            text = read_file(file).decode()
        except (OSError, UnicodeDecodeError) as error:
            raise CommandError(f"Failed to open URDF file: {file}: {error}") from None
        self.set_parameters([Parameter("robot_description", value=text)])
        return text

    def use(self, text: str) -> None:
        """Use a description, and publish it and the fixed joints.

        Raises:
            ValueError: It is not a URDF.
        """
        self.robot = Robot.of(text)
        self.description.publish(String(data=text))
        self.get_logger().info("Robot initialized")
        now = self.get_clock().now().to_msg()
        for joint in self.robot.joints.values():
            if joint.kind == "floating":
                self.get_logger().debug(
                    "Floating joint is not supported; skipping segment from "
                    f"{joint.parent} to {joint.child}."
                )
            elif joint.kind == "planar":  # as kdl_parser has it
                self.get_logger().warning(
                    f"Converting unknown joint type of joint '{joint.name}' into a fixed joint"
                )
        fixed = [each for each in self.robot.joints.values() if each.kind in ("fixed", "planar")]
        self.static_broadcaster.sendTransform([self.transform(joint, 0.0, now) for joint in fixed])

    def transform(self, joint: Joint, position: float, stamp: Time) -> TransformStamped:
        """Return the transform from the parent of a joint to its child, at a position."""
        prefix = self.get_parameter("frame_prefix").value
        x, y, z, i, j, k, w = joint.pose(position)
        sign = -1.0 if w < 0 else 1.0  # of the two quaternions for the same rotation
        return TransformStamped(
            header=Header(stamp=stamp, frame_id=prefix + joint.parent),
            child_frame_id=prefix + joint.child,
            transform=Transform(
                translation=Vector3(x=x, y=y, z=z),
                rotation=Quaternion(x=sign * i, y=sign * j, z=sign * k, w=sign * w),
            ),
        )

    def on_joints(self, state: JointState) -> None:
        """Publish the poses of links, unless they were published less than a period ago."""
        if len(state.name) != len(state.position):
            if len(state.position):
                self.get_logger().error(
                    "Robot state publisher ignored an invalid JointState message"
                )
            else:
                self.get_logger().warning(
                    "Robot state publisher ignored a JointState message about joint(s) "
                    f'"{state.name[0]}"(,...) whose position member was empty.'
                )
            return
        now = self.get_clock().now().nanoseconds
        if self.called > now:
            self.get_logger().warning("Moved backwards in time, re-publishing joint transforms!")
            self.published.clear()
        self.called = now
        stamp = nanoseconds(state.header.stamp)
        known = [name for name in state.name if name in self.robot.joints]
        last = min([now, *(self.published.get(name, 0) for name in known)])
        frequency = self.get_parameter("publish_frequency").value
        period = int(1000.0 / frequency) * 10**6 if frequency else 0
        if not self.get_parameter("ignore_timestamp").value and stamp < last + period:
            return
        positions: dict[str, float] = {}
        for name, position in zip(state.name, state.position.tolist(), strict=True):
            positions.setdefault(name, position)  # the first counts, as in the original
        transforms = []
        for joint in self.robot.joints.values():
            position = self.robot.position(joint.name, positions) if joint.is_moved else None
            if position is not None:
                transforms.append(self.transform(joint, position, state.header.stamp))
        if transforms:
            self.broadcaster.sendTransform(transforms)
        self.published.update(dict.fromkeys(known, stamp))

    def check(self, parameters: list[Parameter]) -> SetParametersResult:
        """Reject invalid values."""
        for parameter in parameters:
            if parameter.name == "robot_description":
                if not parameter.value:
                    return SetParametersResult(successful=False, reason="Empty URDF is not allowed")
                try:
                    Robot.of(parameter.value)
                except ValueError as error:
                    self.get_logger().warning(str(error))
                    return SetParametersResult(successful=False, reason=str(error))
            elif parameter.name == "publish_frequency" and not 0.0 <= parameter.value <= 1000.0:
                return SetParametersResult(
                    successful=False, reason="publish_frequency must be between 0.0 and 1000.0"
                )
        return SetParametersResult(successful=True)

    def update(self, parameters: list[Parameter]) -> None:
        """Publish a new description and its fixed joints."""
        for parameter in parameters:
            if parameter.name == "robot_description":
                self.use(parameter.value)


def main() -> None:
    """Run the node until Ctrl-C."""
    file = next(iter(remove_ros_args(sys.argv)[1:]), None)
    aionode.run(lambda: RobotStatePublisher(file))
