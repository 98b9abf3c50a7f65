"""A robot with a web page: odometry, a camera, parameters, a service, and driving by hand.

Run it with ``python examples/web_page_robot.py`` and open http://127.0.0.1:8090. The robot stops
when the page is closed. It needs ``pip install 'aionode[gateway]'``.
"""

from __future__ import annotations

import asyncio
import math
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta

import aionode
from aionode import Context, Node
from aionode.gateway import Gateway, Policy
from aionode.image import from_numpy
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.std_srvs.srv import Trigger

PERIOD_SEC = 0.05

POLICY = Policy.parse("""
[[who]]
name = "operator"
loopback = true

[[allow]]
who = "operator"
see = "/**"
subscribe = "/**"
call = "/robot/reset"
parameter = "/robot:*"

[[allow]]
who = "operator"
publish = "/cmd_vel"
type = "geometry_msgs/msg/Twist"
lease = { ttl_sec = 0.3 }
[allow.fields]
"linear.x" = { min = -0.5, max = 0.5, outside = "clamp" }
"angular.z" = { min = -1.5, max = 1.5, outside = "clamp" }
""")


class Settings(msgspec.Struct):
    """The parameters of the robot."""

    floor: Annotated[float, Meta(gt=0.0, le=5.0, description="size of a tile, in m")] = 0.5
    camera: bool = True


class Robot(Node):
    """Drives over a floor of tiles, and shows them with a camera."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__("robot", context=context)
        self.settings = self.declare_struct(Settings)
        self.odometry = self.create_publisher(Odometry, "/odom", 10)
        self.images = self.create_publisher(Image, "/camera/image", 1)
        self.create_subscription(
            Twist, "/cmd_vel", self.drive, 1, on_silence=self.stop, silence_sec=0.5
        )
        self.create_service(Trigger, "~/reset", self.reset)
        self.create_timer(PERIOD_SEC, self.move)
        self.create_timer(0.2, self.look)
        self.x = self.y = self.heading = self.speed = self.turn = 0.0

    def drive(self, command: Twist) -> None:
        """Obey a command."""
        self.show(command.linear.x, command.angular.z)

    def stop(self) -> None:
        """Stop: nobody has commanded for 0.5 s."""
        self.show(0.0, 0.0)

    def show(self, speed: float, turn: float) -> None:
        """Drive at a speed in m/s and rad/s, and log when the robot starts and stops."""
        if (speed, turn) == (0.0, 0.0) != (self.speed, self.turn):
            self.get_logger().info(f"Stopped at {self.x:.2f}, {self.y:.2f}")
        elif (self.speed, self.turn) == (0.0, 0.0) != (speed, turn):
            self.get_logger().info("Driving")
        self.speed, self.turn = speed, turn

    def move(self) -> None:
        """Move for one period, and publish where the robot is."""
        self.heading += self.turn * PERIOD_SEC
        self.x += self.speed * math.cos(self.heading) * PERIOD_SEC
        self.y += self.speed * math.sin(self.heading) * PERIOD_SEC
        message = Odometry(header=self.header("odom"), child_frame_id="base_link")
        message.pose.pose.position.x = self.x
        message.pose.pose.position.y = self.y
        message.pose.pose.orientation.z = math.sin(self.heading / 2)
        message.pose.pose.orientation.w = math.cos(self.heading / 2)
        message.twist.twist.linear.x = self.speed
        message.twist.twist.angular.z = self.turn
        self.odometry.publish(message)

    def look(self) -> None:
        """Publish an image of the tiles ahead."""
        if not self.settings.camera:
            return
        row, column = np.mgrid[0:120, 0:160]
        depth = 40.0 / (row + 1.0)  # the horizon is above the picture
        side = depth * (80 - column) / 100
        x = self.x + depth * math.cos(self.heading) - side * math.sin(self.heading)
        y = self.y + depth * math.sin(self.heading) + side * math.cos(self.heading)
        size = self.settings.floor
        light = (np.floor(x / size) + np.floor(y / size)) % 2
        picture = np.stack([80 + 120 * light, 90 + 110 * light, 140 + 20 * light], axis=-1)
        self.images.publish(
            from_numpy(picture.astype(np.uint8), "rgb8", header=self.header("camera"))
        )

    def reset(self, _request: Trigger.Request) -> Trigger.Response:
        """Move the robot back to its start."""
        self.x = self.y = self.heading = 0.0
        self.get_logger().warn("The robot was put back")
        return Trigger.Response(success=True, message="back at 0, 0")

    def header(self, frame_id: str) -> Header:
        """Return a header with the time now."""
        return Header(stamp=self.get_clock().now().to_msg(), frame_id=frame_id)


async def main() -> None:
    """Run the robot and its page until Ctrl-C."""
    async with Robot() as robot, Gateway(robot, policy=POLICY, port=8090) as gateway:
        robot.get_logger().info(f"Open http://127.0.0.1:{gateway.port}")
        await asyncio.Event().wait()


if __name__ == "__main__":
    aionode.run(main)
