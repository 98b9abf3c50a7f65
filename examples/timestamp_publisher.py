#!/usr/bin/env python3
"""Exercise of the tutorial: publish the time on /robot/timestamp, ten times a second.

Run it with ``python examples/timestamp_publisher.py``; Ctrl-C ends it.
"""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.interfaces.builtin_interfaces.msg import Time


class TimestampPublisher(Node):
    """Publishes the time of its clock: simulated time with ``-p use_sim_time:=true``."""

    def __init__(self) -> None:
        super().__init__("timestamp_publisher")
        self.publisher = self.create_publisher(Time, "/robot/timestamp", 10)
        self.timer = self.create_timer(0.1, self.timer_callback)

    def timer_callback(self) -> None:
        """Publish the current time."""
        stamp = self.get_clock().now().to_msg()
        self.publisher.publish(stamp)
        self.get_logger().info(f"Publishing: {stamp.sec}.{stamp.nanosec:09d}")


if __name__ == "__main__":
    aionode.run(TimestampPublisher)
