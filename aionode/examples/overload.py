"""A subscription that is too slow: dropped messages are counted, and nothing else is delayed.

A publisher sends far more than the callback of the only subscription can process. The subscription
keeps the newest ten messages and counts the others, and a timer of 10 ms keeps firing.

Run it with ``python -m aionode.examples.overload``, or with ``--seconds 60`` for longer.
"""

from __future__ import annotations

import argparse
import time  # noqa: TID251 - this callback blocks on purpose
from functools import partial

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import Int64

__all__ = ["Overload", "main"]

BURST = 10
BURST_PERIOD_SEC = 0.001
WORK_SEC = 0.002
TICK_SEC = 0.01
REPORT_SEC = 1.0


class Overload(Node):
    """Publishes up to 10 000 messages a second to a callback that can process 500."""

    def __init__(self, seconds: float) -> None:
        super().__init__("overload")
        self.sent = 0
        self.ticks = 0
        self.publisher = self.create_publisher(Int64, "/flood", 10)
        self.subscription = self.create_subscription(Int64, "/flood", self.work, 10)
        self.begun = self.get_clock().now()
        self.create_timer(BURST_PERIOD_SEC, self.burst)
        self.create_timer(TICK_SEC, self.tick)
        self.create_timer(REPORT_SEC, self.report)
        self.create_timer(seconds, self.context.shutdown)

    def burst(self) -> None:
        """Publish faster than the subscription can process; publishing never waits."""
        for _ in range(BURST):
            self.publisher.publish(Int64(data=self.sent))
            self.sent += 1

    def work(self, _msg: Int64) -> None:
        """Block the event loop for 2 ms, which a callback should never do."""
        time.sleep(WORK_SEC)

    def tick(self) -> None:
        """Count a tick; this timer stays on time."""
        self.ticks += 1

    def report(self) -> None:
        """Print the counts so far: every lost message is counted."""
        stats = self.subscription.stats
        elapsed = (self.get_clock().now() - self.begun).nanoseconds / 1e9
        waiting = self.sent - stats.received - stats.dropped
        print(
            f"{elapsed:5.1f} s: {self.sent} sent = {stats.received} received "
            f"+ {stats.dropped} dropped + {waiting} waiting; "
            f"{self.ticks} of {elapsed / TICK_SEC:.0f} ticks of 10 ms fired",
            flush=True,
        )


def main() -> None:
    """Run for the given time, or until Ctrl-C."""
    parser = argparse.ArgumentParser(description="A slow subscription and a fast publisher.")
    parser.add_argument("--seconds", type=float, default=5.0, help="how long to run (default 5)")
    known, rest = parser.parse_known_args()
    print("A slow subscription and a fast publisher, in one event loop:", flush=True)
    aionode.run(partial(Overload, known.seconds + TICK_SEC), args=rest)


if __name__ == "__main__":
    main()
