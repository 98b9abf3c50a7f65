"""``turtlesim draw_square``: makes the first turtle draw squares."""

from __future__ import annotations

import math
from collections.abc import Generator
from typing import Final

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.std_srvs.srv import Empty
from aionode.interfaces.turtlesim.msg import Pose
from aionode.programs._turtlesim.node import STEP_SEC, TOPIC_QOS, normalized
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["DrawSquare", "main"]

SIDE: Final = 2.0
STILL: Final = 0.0001


class DrawSquare(Node):
    """Resets the turtles, and alternately moves `turtle1` ahead and turns it."""

    def __init__(self) -> None:
        super().__init__("draw_square")
        self.pose: Pose | None = None
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", TOPIC_QOS)
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, TOPIC_QOS)
        self.steps = self.squares()
        self.reset = self.create_client(Empty, "reset")
        self.is_reset = False
        create_wall_timer(self, STEP_SEC, self.go_on)

    def on_pose(self, pose: Pose) -> None:
        """Record the place of the turtle."""
        self.pose = pose

    async def go_on(self) -> None:
        """Reset the turtles, then command the first one, as soon as its place is known."""
        if not self.is_reset:
            await self.reset.wait_for_service()
            await self.reset.call(Empty.Request())
            self.is_reset, self.pose = True, None
        elif self.pose is not None:
            forward, turning = next(self.steps)
            self.publisher.publish(Twist(linear=Vector3(x=forward), angular=Vector3(z=turning)))

    def squares(self) -> Generator[tuple[float, float], None, None]:
        """Yield the commands one after another."""
        while True:
            assert self.pose is not None  # noqa: S101  # the first is asked for when it is there
            x = self.pose.x + math.cos(self.pose.theta) * SIDE
            y = self.pose.y + math.sin(self.pose.theta) * SIDE
            yield from self.until_at(Pose(x=x, y=y, theta=self.pose.theta), 1.0, 0.0)
            theta = normalized(self.pose.theta + math.pi / 2)
            yield from self.until_at(Pose(x=self.pose.x, y=self.pose.y, theta=theta), 0.0, 0.4)

    def until_at(
        self, goal: Pose, forward: float, turning: float
    ) -> Generator[tuple[float, float], None, None]:
        """Yield a command until the turtle has reached a place, and stops until it stands still."""
        log = self.get_logger()
        log.info(f"New goal [{goal.x:f} {goal.y:f}, {goal.theta:f}]")
        while not self.is_at(goal):
            yield forward, turning
        yield 0.0, 0.0
        while self.is_moving():
            yield 0.0, 0.0
        log.info("Reached goal")

    def is_at(self, goal: Pose) -> bool:
        """Return whether the turtle is at a place, and faces the same direction."""
        pose = self.pose
        return (
            pose is not None
            and abs(pose.x - goal.x) < 0.1
            and abs(pose.y - goal.y) < 0.1
            and abs(pose.theta - goal.theta) < 0.01
        )

    def is_moving(self) -> bool:
        """Return whether the turtle is still moving."""
        pose = self.pose
        return pose is not None and (
            pose.angular_velocity >= STILL or pose.linear_velocity >= STILL
        )


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(DrawSquare)
