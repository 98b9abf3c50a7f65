"""``turtlesim mimic``: makes one turtle move like another."""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.turtlesim.msg import Pose
from aionode.programs._turtlesim.node import TOPIC_QOS

__all__ = ["Mimic", "main"]


class Mimic(Node):
    """Publishes the speeds of `input/pose` on `output/cmd_vel`."""

    def __init__(self) -> None:
        super().__init__("turtle_mimic")
        self.publisher = self.create_publisher(Twist, "output/cmd_vel", TOPIC_QOS)
        self.create_subscription(Pose, "input/pose", self.on_pose, TOPIC_QOS)

    def on_pose(self, pose: Pose) -> None:
        """Publish the speeds of a turtle as a command."""
        linear, angular = Vector3(x=pose.linear_velocity), Vector3(z=pose.angular_velocity)
        self.publisher.publish(Twist(linear=linear, angular=angular))


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(Mimic)
