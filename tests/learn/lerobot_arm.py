"""The robot and the leader of `lerobot_loops.py` as one node of rclpy, over DDS."""

from __future__ import annotations

import contextlib
import math

import numpy as np
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Float64MultiArray

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

HEIGHT, WIDTH, FPS = 96, 128, 30


class Arm(Node):
    """Goes where it is told, and shows where it is."""

    def __init__(self) -> None:
        super().__init__("arm")
        self.angle = 0.0
        self.commands = 0
        self.camera = self.create_publisher(Image, "/camera", 1)
        self.joints = self.create_publisher(JointState, "/joint_states", 1)
        self.leader = self.create_publisher(Float64MultiArray, "/leader/arm/command", 1)
        self.create_subscription(Float64MultiArray, "/arm/command", self.take, 10)
        self.create_timer(1 / FPS, self.show)

    def take(self, command: Float64MultiArray) -> None:
        """Go where it is told."""
        self.angle = float(command.data[0])
        self.commands += 1

    def show(self) -> None:
        """Publish picture, joint and the leader's command."""
        now = self.get_clock().now()
        state = JointState(name=["shoulder"], position=[self.angle])
        state.header.stamp = now.to_msg()
        pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        column = round((self.angle + 1) / 2 * (WIDTH - 8))
        pixels[:, column : column + 8] = 255
        picture = Image(height=HEIGHT, width=WIDTH, encoding="rgb8", step=WIDTH * 3)
        picture.header = state.header
        picture.data.frombytes(pixels.tobytes())
        self.joints.publish(state)
        self.camera.publish(picture)
        self.leader.publish(Float64MultiArray(data=[0.8 * math.sin(now.nanoseconds / 1e9)]))


def main() -> None:
    """Run until SIGTERM, and print what came."""
    rclpy.init()
    arm = Arm()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(arm)
    print(f"{arm.commands} {arm.angle}")  # noqa: T201


if __name__ == "__main__":
    main()
