"""A plain rclpy program for tests that sends transforms and prints those it receives.

It uses the topics and profiles of tf2_ros. ``peer_base`` in ``peer_map`` is sent on ``/tf``
repeatedly; ``peer_camera`` and ``peer_arm`` in ``peer_base`` on ``/tf_static`` once.
"""

from __future__ import annotations

import sys
import threading
from contextlib import suppress
from functools import partial
from typing import Any

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

import rclpy  # it plays the other process
from rclpy.executors import ExternalShutdownException  # the same
from rclpy.node import Node  # the same
from rclpy.qos import DurabilityPolicy, QoSProfile  # the same
from tests.support.ros_peer import shut_down_at_end

TRANSIENT = DurabilityPolicy.TRANSIENT_LOCAL


class Peer(Node):
    """The node ``/tf_peer``."""

    def __init__(self) -> None:
        super().__init__("tf_peer")
        static_profile = QoSProfile(depth=100, durability=TRANSIENT)
        self.create_subscription(TFMessage, "/tf", partial(self.tell, "/tf"), 100)
        self.create_subscription(
            TFMessage, "/tf_static", partial(self.tell, "/tf_static"), static_profile
        )
        self.moving = self.create_publisher(TFMessage, "/tf", 100)
        self.static = self.create_publisher(
            TFMessage, "/tf_static", QoSProfile(depth=1, durability=TRANSIENT)
        )
        self.static.publish(
            TFMessage(
                transforms=[
                    self.placed("peer_base", "peer_camera", 2.0),
                    self.placed("peer_base", "peer_arm", 3.0),
                ]
            )
        )
        self.create_timer(0.02, self.move)

    def placed(self, parent: str, child: str, x: float) -> Any:
        """Return a transform with the current time."""
        stamped = TransformStamped(child_frame_id=child)
        stamped.header.frame_id = parent
        stamped.header.stamp = self.get_clock().now().to_msg()
        stamped.transform.translation.x = x
        return stamped

    def move(self) -> None:
        """Send the transform of the base."""
        self.moving.publish(TFMessage(transforms=[self.placed("peer_map", "peer_base", 1.0)]))

    def tell(self, topic: str, msg: Any) -> None:
        """Print the transforms of the test's node."""
        for one in msg.transforms:
            if not one.child_frame_id.startswith("peer_"):
                x = one.transform.translation.x
                say(f"{topic} {one.header.frame_id} {one.child_frame_id} {x}")


def say(line: str) -> None:
    """Print a line, and flush it."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main() -> None:
    """Spin until stdin is closed."""
    rclpy.init()
    peer = Peer()
    say("ready")
    threading.Thread(target=shut_down_at_end, daemon=True).start()
    with suppress(ExternalShutdownException):
        rclpy.spin(peer)
    peer.destroy_node()


if __name__ == "__main__":
    main()
