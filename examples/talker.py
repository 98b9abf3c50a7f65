"""Publish a greeting on /chatter, twice a second."""

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import String


class Talker(Node):
    """Publishes from a timer."""

    def __init__(self) -> None:
        super().__init__("talker")
        self.publisher = self.create_publisher(String, "/chatter", 10)
        self.create_timer(0.5, self.say)

    def say(self) -> None:
        """Publish one greeting."""
        self.publisher.publish(String(data="Hello"))


if __name__ == "__main__":
    aionode.run(Talker)
