#!/usr/bin/env python3
"""Print every message of /robot/message.

Run it with ``python examples/simple_subscriber.py``; Ctrl-C ends it.
"""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import String


class SimpleSubscriber(Node):
    """Logs and counts the messages it receives."""

    def __init__(self) -> None:
        super().__init__("simple_subscriber")
        self.subscription = self.create_subscription(
            String, "/robot/message", self.listener_callback, 10
        )
        self.count = 0
        self.get_logger().info("Simple Subscriber started. Listening to /robot/message")

    def listener_callback(self, msg: String) -> None:
        """Log one message."""
        self.count += 1
        self.get_logger().info(f'Received message #{self.count}: "{msg.data}"')


if __name__ == "__main__":
    aionode.run(SimpleSubscriber)
