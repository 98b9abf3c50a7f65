"""``talker`` of demo_nodes_cpp and demo_nodes_py: publishes a greeting on `chatter`."""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import String

__all__ = ["Talker", "main"]


class Talker(Node):
    """Publishes once a second, and counts."""

    def __init__(self) -> None:
        super().__init__("talker")
        self.count = 1
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(1.0, self.say)

    def say(self) -> None:
        """Publish one greeting."""
        text = f"Hello World: {self.count}"
        self.count += 1
        self.get_logger().info(f"Publishing: '{text}'")
        self.publisher.publish(String(data=text))


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(Talker)
