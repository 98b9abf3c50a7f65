"""A talker pauses, and both ends are notified that the deadline was missed.

Run it with ``python -m aionode.examples.quality_of_service.deadline``, and with a deadline in
milliseconds for another: ``deadline 600 --publish-for 2000 --pause-for 1500``.
"""

from __future__ import annotations

import argparse
from functools import partial

import aionode
from aionode import (
    Duration,
    Node,
    PublisherEventCallbacks,
    QoSOfferedDeadlineMissedInfo,
    QoSProfile,
    QoSRequestedDeadlineMissedInfo,
    SubscriptionEventCallbacks,
)
from aionode.interfaces.std_msgs.msg import String

__all__ = ["Listener", "Talker", "main"]


class Talker(Node):
    """Publishes twice per deadline, pauses, and then publishes again."""

    def __init__(self, deadline_ms: int, publish_ms: int, pause_ms: int) -> None:
        super().__init__("qos_talker")
        self.publisher = self.create_publisher(
            String,
            "qos_chatter",
            QoSProfile(depth=10, deadline=Duration(seconds=deadline_ms / 1000)),
            event_callbacks=PublisherEventCallbacks(deadline=self.missed),
        )
        self.count = 0
        self.timer = self.create_timer(deadline_ms / 2000, self.say)
        self.pause = self.create_timer(publish_ms / 1000, self.timer.cancel)
        self.resume = self.create_timer((publish_ms + pause_ms) / 1000, self.go_on)
        self.end = self.create_timer((2 * publish_ms + pause_ms) / 1000, self.context.shutdown)

    def say(self) -> None:
        """Publish the next message."""
        self.count += 1
        self.get_logger().info(f"Publishing: {self.count}")
        self.publisher.publish(String(data=f"Talker says {self.count}"))

    def go_on(self) -> None:
        """Publish again."""
        self.pause.cancel()
        self.resume.cancel()
        self.timer.reset()

    def missed(self, event: QoSOfferedDeadlineMissedInfo) -> None:
        """Log that the offered deadline was missed."""
        self.get_logger().info(f"Offered deadline missed {event.total_count} times")


class Listener(Node):
    """Expects a message within each deadline."""

    def __init__(self, deadline_ms: int) -> None:
        super().__init__("qos_listener")
        self.create_subscription(
            String,
            "qos_chatter",
            self.hear,
            QoSProfile(depth=10, deadline=Duration(seconds=deadline_ms / 1000)),
            event_callbacks=SubscriptionEventCallbacks(deadline=self.missed),
        )

    def hear(self, msg: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: {msg.data}")

    def missed(self, event: QoSRequestedDeadlineMissedInfo) -> None:
        """Log that the requested deadline was missed."""
        self.get_logger().info(f"Requested deadline missed {event.total_count} times")


def main() -> None:
    """Run both nodes until the talker ends the program, or until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("deadline", type=int, nargs="?", default=400, help="in milliseconds")
    parser.add_argument("--publish-for", type=int, default=1000, help="in milliseconds")
    parser.add_argument("--pause-for", type=int, default=1100, help="in milliseconds")
    options, _ = parser.parse_known_args()
    aionode.run(
        partial(Listener, options.deadline),
        partial(Talker, options.deadline, options.publish_for, options.pause_for),
    )


if __name__ == "__main__":
    main()
