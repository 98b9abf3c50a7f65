"""The simulator: wheels, odometry, lidar and camera of a rover in a room of its own.

Run it with ``python -m aionode.examples.rover.simulator``. With ``--ros-args -p use_sim_time:=true
-p rate:=5.0`` it publishes /clock, which runs five times as fast as wall time.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta

import aionode
from aionode import Node, Time
from aionode.clock import SteadyClock
from aionode.examples.rover.world import World
from aionode.image import from_numpy
from aionode.interfaces.geometry_msgs.msg import Quaternion, TransformStamped, Twist
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.sensor_msgs.msg import Image, JointState, LaserScan
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.tf import TransformBroadcaster

__all__ = ["Simulator"]

STEP_SEC = 0.02
STEPS_PER_SCAN = 5
STEPS_PER_PICTURE = 10
SILENCE_SEC = 0.5
MAX_SPEED = 0.8
MAX_TURN = 2.0
WHEEL_RADIUS = 0.06
WHEEL_TRACK = 0.30
RANGE_MAX = 8.0
ANGLES = np.linspace(0.0, 2 * math.pi, 180, endpoint=False)
CAMERA_AHEAD = 0.12


class Settings(msgspec.Struct):
    """The parameters of the simulator; other frame names make it the base of another robot."""

    rate: Annotated[
        float, Meta(gt=0.0, le=100.0, description="simulated seconds a second, on /clock")
    ] = 1.0
    base_frame: Annotated[str, Meta(description="the frame that moves in odom")] = "base_link"
    lidar_frame: Annotated[str, Meta(description="the frame of /scan")] = "lidar"
    left_wheel: Annotated[str, Meta(description="its joint")] = "left_wheel_joint"
    right_wheel: Annotated[str, Meta(description="its joint")] = "right_wheel_joint"
    scan_from: Annotated[
        float, Meta(ge=-math.pi, le=0.0, description="angle of the first ray, in rad; 0 is ahead")
    ] = -math.pi


class Simulator(Node):
    """Moves the rover according to /cmd_vel, and publishes the measurements of its sensors."""

    def __init__(self, **options: Any) -> None:
        super().__init__("simulator", **options)
        self.settings = self.declare_struct(Settings)
        self.makes_time = bool(self.get_parameter("use_sim_time").value)
        self.angles = ANGLES + self.settings.scan_from
        self.world = World()
        self.speed = self.turn = 0.0
        self.wheels = [0.0, 0.0]
        self.steps = 0

        self.odometry = self.create_publisher(Odometry, "/odom", 10)
        self.joints = self.create_publisher(JointState, "/joint_states", 10)
        self.scans = self.create_publisher(LaserScan, "/scan", 5)
        self.pictures = self.create_publisher(Image, "/camera/image", 1)
        self.transforms = TransformBroadcaster(self)
        self.create_subscription(
            Twist,
            "/cmd_vel",
            self.obey,
            1,
            on_silence=self.stop,
            silence_sec=SILENCE_SEC,
            clock=self.get_clock(),
        )
        self.create_service(Trigger, "~/reset", self.reset)
        if self.makes_time:
            self.clock = self.create_publisher(Clock, "/clock", 1)
            # By the steady clock: the node's own one waits for what these steps publish.
            self.create_timer(STEP_SEC / self.settings.rate, self.step, clock=SteadyClock())
        else:
            self.create_timer(STEP_SEC, self.step)

    # Wheels

    def obey(self, command: Twist) -> None:
        """Drive as commanded, limited to what the motors can do; a NaN or infinity stops them."""
        if not (math.isfinite(command.linear.x) and math.isfinite(command.angular.z)):
            self.get_logger().warning(f"stopped: a command is not a finite number: {command}")
            self.stop()
            return
        self.speed = min(MAX_SPEED, max(-MAX_SPEED, command.linear.x))
        self.turn = min(MAX_TURN, max(-MAX_TURN, command.angular.z))

    def stop(self) -> None:
        """Stop: the publisher of the commands is silent or gone."""
        self.speed = self.turn = 0.0

    def reset(self, _request: Trigger.Request) -> Trigger.Response:
        """Move the rover and the ball back to their start."""
        self.stop()
        self.world.reset()
        return Trigger.Response(success=True, message="the rover is back where it began")

    # One step

    def step(self) -> None:
        """Advance the world, and publish what the sensors see."""
        self.steps += 1
        if self.makes_time:
            self.clock.publish(Clock(clock=self.now().to_msg()))
        self.publish_motion(self.world.drive(self.speed, self.turn, STEP_SEC))
        if self.steps % STEPS_PER_SCAN == 0:
            self.publish_scan()
        if self.steps % STEPS_PER_PICTURE == 0 and self.pictures.get_subscription_count():
            self.publish_picture()

    def now(self) -> Time:
        """Return the time of this step."""
        if self.makes_time:
            return Time(nanoseconds=round(self.steps * STEP_SEC * 1e9))
        return self.get_clock().now()

    def header(self, frame_id: str) -> Header:
        """Return a header for what is measured in this step."""
        return Header(stamp=self.now().to_msg(), frame_id=frame_id)

    def publish_motion(self, distance: float) -> None:
        """Publish the pose of the rover, and the angles of its wheels.

        Args:
            distance: The distance driven in this step, in metres.
        """
        place, header = self.world.rover, self.header("odom")
        rotation = Quaternion(z=math.sin(place.heading / 2), w=math.cos(place.heading / 2))

        odometry = Odometry(header=header, child_frame_id=self.settings.base_frame)
        odometry.pose.pose.position.x = place.x
        odometry.pose.pose.position.y = place.y
        odometry.pose.pose.orientation = rotation
        odometry.twist.twist.linear.x = distance / STEP_SEC
        odometry.twist.twist.angular.z = self.turn
        self.odometry.publish(odometry)

        transform = TransformStamped(header=header, child_frame_id=self.settings.base_frame)
        transform.transform.translation.x = place.x
        transform.transform.translation.y = place.y
        transform.transform.rotation = rotation
        self.transforms.sendTransform(transform)

        for number, side in enumerate((-1, 1)):
            speed = self.speed + side * self.turn * WHEEL_TRACK / 2
            self.wheels[number] += speed / WHEEL_RADIUS * STEP_SEC
        names = [self.settings.left_wheel, self.settings.right_wheel]
        self.joints.publish(JointState(header=header, name=names, position=self.wheels))

    def publish_scan(self) -> None:
        """Publish the distances all around; the lidar is at the centre of the rover."""
        ranges = self.world.scan(self.world.rover, self.angles)
        self.scans.publish(
            LaserScan(
                header=self.header(self.settings.lidar_frame),
                angle_min=float(self.angles[0]),
                angle_max=float(self.angles[-1]),
                angle_increment=float(ANGLES[1] - ANGLES[0]),
                scan_time=STEPS_PER_SCAN * STEP_SEC,
                range_min=0.05,
                range_max=RANGE_MAX,
                ranges=np.where(ranges <= RANGE_MAX, ranges, np.inf).astype(np.float32),
            )
        )

    def publish_picture(self) -> None:
        """Publish the camera image, which is rendered only while somebody subscribes."""
        eye = self.world.rover.moved(CAMERA_AHEAD, 0.0)
        picture = self.world.picture(eye)
        self.pictures.publish(from_numpy(picture, "rgb8", header=self.header("camera")))


if __name__ == "__main__":
    aionode.run(Simulator)
