"""Two nodes: one publishes, the other ends the program after five messages.

Run it with ``python -m aionode.examples.pubsub``.
"""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import String

__all__ = ["Listener", "Talker", "main"]

MESSAGES = 5
PERIOD_SEC = 0.5


class Talker(Node):
    """Publishes a greeting twice a second."""

    def __init__(self) -> None:
        super().__init__("talker")
        self.publisher = self.create_publisher(String, "/chatter", 10)
        self.timer = self.create_timer(PERIOD_SEC, self.say)
        self.count = 0

    def say(self) -> None:
        """Publish the next greeting; the timer calls this."""
        self.count += 1
        msg = String(data=f"Hello {self.count}")
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.publisher.publish(msg)


class Listener(Node):
    """Receives `MESSAGES` greetings, prints statistics, and ends the program."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.subscription = self.create_subscription(String, "/chatter", self.hear, 10)
        self.heard = 0

    async def hear(self, msg: String) -> None:
        """Count a greeting; the subscription calls this. It may await anything."""
        self.heard += 1
        self.get_logger().info(f'I heard: "{msg.data}"')
        if self.heard == MESSAGES:
            self.print_statistics()
            self.context.shutdown()

    def print_statistics(self) -> None:
        """Print the statistics of the subscription."""
        stats = self.subscription.stats
        print(
            f"\n{self.heard} messages heard, {stats.dropped} dropped. "
            f"From publish to callback: {stats.queue_wait.p50_ns / 1e6:.3f} ms at the median.\n"
            "No ROS, no broker, one event loop. "
            "Next: python -m aionode.examples.service",
            flush=True,
        )


def main() -> None:
    """Run both nodes until the listener ends the program, or until Ctrl-C."""
    print(
        "Two nodes in this process: /talker publishes on /chatter, /listener subscribes to it.\n",
        flush=True,
    )
    aionode.run(Talker, Listener)


if __name__ == "__main__":
    main()
