#!/usr/bin/env python3
"""Exercise of the tutorial: count the words of all messages of /robot/message.

Run it with ``python examples/word_counter.py`` beside ``python examples/simple_publisher.py``; the
total is on /robot/word_count.
"""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import Int32, String


class WordCounter(Node):
    """Subscribes to one topic and publishes on another."""

    def __init__(self) -> None:
        super().__init__("word_counter")
        self.publisher = self.create_publisher(Int32, "/robot/word_count", 10)
        self.subscription = self.create_subscription(
            String, "/robot/message", self.listener_callback, 10
        )
        self.total = 0
        self.get_logger().info("Word Counter started. Counting the words of /robot/message")

    def listener_callback(self, msg: String) -> None:
        """Publish the number of words so far."""
        self.total += len(msg.data.split())
        self.publisher.publish(Int32(data=self.total))
        self.get_logger().info(f"Words so far: {self.total}")


if __name__ == "__main__":
    aionode.run(WordCounter)
