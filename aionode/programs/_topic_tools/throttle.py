"""``topic_tools throttle``: republishes a topic at a limited rate of messages or bytes."""

from __future__ import annotations

import sys
from collections import deque

import aionode
from aionode import Clock, ClockType, Parameter
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.programs._topic_tools.any_type import AnyTypeNode, given_number

__all__ = ["Throttle", "main"]


class Throttle(AnyTypeNode):
    """Republishes messages, up to a rate of messages or bytes.

    Args:
        *words: ``messages``, the input topic and the rate in Hz; or ``bytes``, the input topic, the
            bytes and the window in seconds; then the output topic.
    """

    def __init__(self, *words: str) -> None:
        super().__init__("throttle", given_by(words))
        self.declare_topics("_throttle")
        kind = self.needed("throttle_type", Parameter.Type.STRING)
        self.period_ns = self.most_bytes = self.window_ns = 0
        if kind == "messages":
            rate = self.needed("msgs_per_sec", Parameter.Type.DOUBLE)
            if not rate > 0:
                raise CommandError(f"msgs_per_sec is {rate}; use a number above 0")
            self.period_ns = int(1e9 / rate)
        elif kind == "bytes":
            self.most_bytes = self.needed("bytes_per_sec", Parameter.Type.INTEGER)
            self.window_ns = int(self.needed("window", Parameter.Type.DOUBLE) * 1e9)
        else:
            raise CommandError(f"Unknown throttle type: {kind!r}; use messages or bytes")
        wall = self.declare_parameter("use_wall_clock", False).value
        self.clock = Clock(ClockType.SYSTEM_TIME) if wall else self.get_clock()
        self.sent: deque[tuple[int, int]] = deque()
        self.last_ns = self.clock.now().nanoseconds

    def process(self, data: bytes) -> None:
        """Publish a message, if there is room for it."""
        now = self.clock.now().nanoseconds
        if not self.period_ns:
            while self.sent and self.sent[0][0] < now - self.window_ns:
                self.sent.popleft()
            if sum(size for _, size in self.sent) < self.most_bytes:
                self.send(data)
                self.sent.append((now, len(data)))
            return
        if self.last_ns > now:
            self.get_logger().warning(
                "Detected jump back in time, resetting throttle period to now for."
            )
            self.last_ns = now
        if now - self.last_ns >= self.period_ns:
            self.send(data)
            self.last_ns = now


def given_by(words: tuple[str, ...]) -> dict[str, str | float]:
    """Return the parameters given as arguments.

    Raises:
        CommandError: A number is invalid.
    """
    match words:
        case ["messages", topic, rate, *rest]:
            given = {"input_topic": topic, "msgs_per_sec": given_number(rate, float, "the rate")}
        case ["bytes", topic, size, window, *rest]:
            given = {
                "input_topic": topic,
                "bytes_per_sec": given_number(size, int, "the number of bytes"),
                "window": given_number(window, float, "the window"),
            }
        case ["messages" | "bytes", *_]:
            given, rest = {}, []
        case _:
            return {}
    return {"throttle_type": words[0], **given, **dict(zip(("output_topic",), rest, strict=False))}


def main() -> None:
    """Run the node until Ctrl-C."""
    words = remove_ros_args(sys.argv)[1:]
    aionode.run(lambda: Throttle(*words))
