"""A process that commands, or one that drives and prints the commands of its wheels.

Each command is the time of its publication, in nanoseconds since 1970.
"""

from __future__ import annotations

import asyncio
import sys

from aionode import Node, run
from aionode.clock import MachineTime
from aionode.interfaces.std_msgs.msg import Int64

TOPIC = "commands"

now_ns = MachineTime.system_ns


class Mover(Node):
    """Commands at 50 Hz."""

    def __init__(self) -> None:
        super().__init__("mover", enable_rosout=False)
        publisher = self.create_publisher(Int64, TOPIC, 10)
        self.create_timer(0.02, lambda: publisher.publish(Int64(data=now_ns())))


class Wheels(Node):
    """Drives, and stops 0.3 s after the last command."""

    def __init__(self) -> None:
        super().__init__("wheels", enable_rosout=False)
        self.create_subscription(
            Int64,
            TOPIC,
            lambda msg: print("drive", msg.data, flush=True),  # noqa: T201  # the test reads it
            100,
            on_silence=lambda: print("stop", now_ns(), flush=True),  # noqa: T201  # as above
        )


if __name__ == "__main__":
    run({"mover": Mover, "wheels": Wheels}[sys.argv[1]], loop_factory=asyncio.new_event_loop)
