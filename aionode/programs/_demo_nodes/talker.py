"""``demo_nodes_cpp talker``: publishes a greeting on `chatter`."""

from __future__ import annotations

from typing import ClassVar

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import String
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["Talker", "main"]


class Talker(Node):
    """Publishes once a second, and counts."""

    first: ClassVar = 1
    quote: ClassVar = "'"

    def __init__(self) -> None:
        super().__init__("talker")
        self.count = self.first
        self.publisher = self.create_publisher(String, "chatter", 7)
        create_wall_timer(self, 1.0, self.say)

    def say(self) -> None:
        """Publish one greeting."""
        text = f"Hello World: {self.count}"
        self.count += 1
        self.get_logger().info(f"Publishing: {self.quote}{text}{self.quote}")
        self.publisher.publish(String(data=text))


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(Talker)
