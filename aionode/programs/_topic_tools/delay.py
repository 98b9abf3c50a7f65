"""``topic_tools delay``: republishes a topic on another one after a delay."""

from __future__ import annotations

import sys
from collections import deque

import aionode
from aionode import Clock, ClockType, Timer
from aionode.arguments import remove_ros_args
from aionode.programs._topic_tools.any_type import AnyTypeNode, given_number

__all__ = ["MAX_BYTES", "Delay", "main"]

MAX_BYTES = 512_000_000
"""Maximum bytes of waiting messages; beyond that, the oldest are dropped."""


class Delay(AnyTypeNode):
    """Republishes each message after a delay.

    Args:
        *words: The input topic, the delay in seconds, and the output topic.
    """

    def __init__(self, *words: str) -> None:
        given: dict[str, str | float] = dict(zip(("input_topic",), words, strict=False))
        if len(words) > 1:
            given["delay"] = given_number(words[1], float, "the delay")
        given |= dict(zip(("output_topic",), words[2:], strict=False))
        super().__init__("delay", given)
        self.declare_topics("_delay")
        self.delay_ns = int(self.declare_parameter("delay", 0.0).value * 1e9)
        wall = self.declare_parameter("use_wall_clock", False).value
        self.clock = Clock(ClockType.SYSTEM_TIME) if wall else self.get_clock()
        self.waiting: deque[tuple[int, bytes]] = deque()
        self.bytes = 0
        self.timer: Timer | None = None

    def process(self, data: bytes) -> None:
        """Keep a message until it is due."""
        self.waiting.append((self.clock.now().nanoseconds + self.delay_ns, bytes(data)))
        self.bytes += len(data)
        while self.bytes > MAX_BYTES:
            self.bytes -= len(self.waiting.popleft()[1])
            self.warn_once(f"more than {MAX_BYTES} bytes wait; the oldest messages are dropped")
        if self.timer is None:
            self.send_due()

    def send_due(self) -> None:
        """Publish the messages that are due, and set a timer for the others."""
        if self.timer is not None:
            self.timer.destroy()
            self.timer = None
        now = self.clock.now().nanoseconds
        while self.waiting and self.waiting[0][0] <= now:
            data = self.waiting.popleft()[1]
            self.bytes -= len(data)
            self.send(data)
        if self.waiting:
            left = (self.waiting[0][0] - now) / 1e9
            self.timer = self.create_timer(left, self.send_due, self.clock)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(lambda: Delay(*remove_ros_args(sys.argv)[1:]))
