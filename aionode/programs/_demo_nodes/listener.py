"""``demo_nodes_cpp listener``, and that of demo_nodes_py: logs what arrives on `chatter`."""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.errors import escaped
from aionode.interfaces.std_msgs.msg import String

__all__ = ["Listener", "main"]


class Listener(Node):
    """Logs what it hears."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.create_subscription(String, "chatter", self.hear, 10)

    def hear(self, msg: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: [{escaped(msg.data)}]")


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(Listener)
