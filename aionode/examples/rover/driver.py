"""The driver: an action that drives the rover to a place.

Run it with ``python -m aionode.examples.rover.driver``.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta

import aionode
from aionode import CancelResponse, GoalRejected, GoalResponse, Node, ServerGoalHandle, Time
from aionode.examples.rover.interfaces import DriveTo
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.qos import qos_profile_sensor_data
from aionode.tf import Buffer

__all__ = ["Driver"]

RATE_HZ = 20.0
TTL_SEC = 0.3
FARTHEST = 10.0
AHEAD = math.radians(25.0)

Handle = ServerGoalHandle[DriveTo.Goal, DriveTo.Result, DriveTo.Feedback]


class Settings(msgspec.Struct):
    """The parameters of the driver; a change takes effect with the next command."""

    speed: Annotated[float, Meta(gt=0.0, le=0.8, description="at most, in m/s")] = 0.4
    tolerance: Annotated[float, Meta(ge=0.02, le=1.0, description="how near is there, in m")] = 0.05
    margin: Annotated[float, Meta(ge=0.2, le=2.0, description="kept to what is ahead, in m")] = 0.3


class Driver(Node):
    """Serves /drive_to: one goal at a time; the rover stops however a goal ends."""

    def __init__(self, **options: Any) -> None:
        super().__init__("driver", **options)
        self.settings = self.declare_struct(Settings)
        self.ahead = math.inf
        self.is_driving = False
        self.buffer = Buffer(self)
        self.cmd_vel = self.create_publisher(Twist, "/cmd_vel", 1)
        self.create_subscription(LaserScan, "/scan", self.look_ahead, qos_profile_sensor_data)
        self.create_action_server(
            DriveTo,
            "/drive_to",
            self.drive,
            goal_callback=self.judge,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
            on_client_lost="cancel",
        )

    def look_ahead(self, scan: LaserScan) -> None:
        """Remember the distance to the next obstacle ahead."""
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        self.ahead = float(np.min(scan.ranges[np.abs(angles) <= AHEAD], initial=math.inf))

    def judge(self, goal: DriveTo.Goal) -> GoalResponse:
        """Reject a goal that is too far away, and a second goal while one is executed."""
        if self.is_driving:
            raise GoalRejected("a goal is under way")
        distance = math.hypot(goal.x, goal.y)
        if not distance <= FARTHEST:
            raise GoalRejected(f"too far: {distance:.1f} m of at most {FARTHEST:g}")
        self.is_driving = True
        return GoalResponse.ACCEPT

    async def drive(self, handle: Handle) -> DriveTo.Result:
        """Drive until the rover is there, something is in the way, or somebody cancels.

        However it ends, the block of the lease sends the stop; if this program hangs or dies, the
        wheels stop by themselves.
        """
        driven, goal, before = 0.0, handle.request, None
        try:
            await self.buffer.wait_for_transform("odom", "base_link", timeout_sec=5.0)
            async with self.cmd_vel.lease(stop=Twist(), ttl_sec=TTL_SEC) as lease:
                async for _ in self.create_rate(RATE_HZ):
                    x, y, heading = self.place()
                    driven += math.dist(before or (x, y), (x, y))
                    before = (x, y)
                    left = math.hypot(goal.x - x, goal.y - y)
                    if left <= self.settings.tolerance:
                        handle.succeed()
                        break
                    off = math.remainder(math.atan2(goal.y - y, goal.x - x) - heading, math.tau)
                    if abs(off) < AHEAD and self.ahead < min(self.settings.margin, left):
                        handle.abort(error_text=f"something is {self.ahead:.2f} m ahead")
                        break
                    handle.publish_feedback(DriveTo.Feedback(distance_left=left))
                    lease.publish(self.command(left, off))
        finally:
            self.is_driving = False
        return DriveTo.Result(driven=driven, distance_left=left)

    def place(self) -> tuple[float, float, float]:
        """Return the pose of the rover, from the newest transform."""
        transform = self.buffer.lookup_transform("odom", "base_link", Time()).transform
        heading = 2 * math.atan2(transform.rotation.z, transform.rotation.w)
        return transform.translation.x, transform.translation.y, heading

    def command(self, left: float, off: float) -> Twist:
        """Return the velocity for the rest of the way: turn first, then drive."""
        twist = Twist()
        twist.angular.z = min(1.5, max(-1.5, 2.0 * off))
        if abs(off) < AHEAD:
            twist.linear.x = min(self.settings.speed, left) * math.cos(off)
        return twist


if __name__ == "__main__":
    aionode.run(Driver)
