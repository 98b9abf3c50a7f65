"""Timers keep their grid, never overlap themselves, and skip what they miss.

Run it with ``python -m aionode.examples.timers``; it ends after three seconds.
"""

from __future__ import annotations

import aionode
from aionode import Node, TimerInfo

__all__ = ["Timers", "main"]

FAST_SEC = 0.2
SLOW_SEC = 0.5
END_SEC = 3.1


class Timers(Node):
    """A fast timer, one whose callback is slower than its period, a rate, and an alarm."""

    def __init__(self) -> None:
        super().__init__("timers")
        self.ticks = 0
        self.fast = self.create_timer(FAST_SEC, self.tick)
        self.slow = self.create_timer(SLOW_SEC, self.work)
        self.counter = self.create_timer(0.0, self.count_down)
        self.alarm = self.create_timer(END_SEC, self.end)

    def tick(self, info: TimerInfo) -> None:
        """Log one tick; `info` has the time when it was due and when it was called."""
        self.ticks += 1
        late = info.actual_call_time - info.expected_call_time
        self.get_logger().info(f"fast: tick {self.ticks}, {late.nanoseconds / 1e6:.2f} ms late")

    async def work(self) -> None:
        """Take longer than the period: the missed tick is skipped, the grid is kept."""
        self.get_logger().info("slow: 0.7 s of work begin; all other callbacks continue")
        await self.get_clock().sleep(0.7)
        self.get_logger().info("slow: done")

    async def count_down(self) -> None:
        """Count down once, at a rate of two a second, in an ordinary loop."""
        self.counter.cancel()
        rate = self.create_rate(2)
        for left in (3, 2, 1):
            self.get_logger().info(f"rate: {left}")
            await rate.sleep()

    def end(self) -> None:
        """End the program."""
        expected = int(END_SEC / FAST_SEC)
        print(f"\n{self.ticks} of {expected} fast ticks came.", flush=True)
        self.context.shutdown()


def main() -> None:
    """Run the timers until the alarm, or until Ctrl-C."""
    aionode.run(Timers)


if __name__ == "__main__":
    main()
