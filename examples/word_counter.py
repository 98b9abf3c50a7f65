"""Exercise of the tutorial: count the words of each message of /robot/message.

Run it with ``python examples/word_counter.py`` beside ``python examples/simple_publisher.py``; the
counts are on /robot/word_count.
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

    def listener_callback(self, msg: String) -> None:
        """Publish how many words `msg` has."""
        count = Int32(data=len(msg.data.split()))
        self.publisher.publish(count)
        self.get_logger().info(f'"{msg.data}" has {count.data} words')


if __name__ == "__main__":
    aionode.run(WordCounter)
