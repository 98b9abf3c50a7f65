#!/usr/bin/env python3
"""Publish a counted greeting on /robot/message, once a second.

Run it with ``python examples/simple_publisher.py``; Ctrl-C ends it.
"""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import String


class SimplePublisher(Node):
    """Publishes once a second."""

    def __init__(self) -> None:
        super().__init__("simple_publisher")
        self.publisher = self.create_publisher(String, "/robot/message", 10)
        self.timer = self.create_timer(1.0, self.timer_callback)
        self.count = 0
        self.get_logger().info("Simple Publisher started. Publishing to /robot/message")

    def timer_callback(self) -> None:
        """Publish the next greeting."""
        msg = String(data=f"Hello from ROS 2! Message count: {self.count}")
        self.publisher.publish(msg)
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.count += 1


if __name__ == "__main__":
    aionode.run(SimplePublisher)
