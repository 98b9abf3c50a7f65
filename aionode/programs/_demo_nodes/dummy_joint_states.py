"""``dummy_sensors dummy_joint_states``: two joints that swing."""

from __future__ import annotations

import math

import aionode
from aionode import Node
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["DummyJointStates", "main"]


class DummyJointStates(Node):
    """Publishes `joint_states` fifty times a second."""

    def __init__(self) -> None:
        super().__init__("dummy_joint_states")
        self.publisher = self.create_publisher(JointState, "joint_states", 10)
        self.count = 0.0
        create_wall_timer(self, 0.02, self.publish)

    def publish(self) -> None:
        """Publish where the joints are."""
        self.count += 0.1
        msg = JointState(
            name=["single_rrbot_joint1", "single_rrbot_joint2"],
            position=[math.sin(self.count)] * 2,
        )
        msg.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(msg)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(DummyJointStates)
