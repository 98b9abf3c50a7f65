"""A program with its own resources, which goes on after `aionode.run`.

``python tests/end_to_end/guest_member.py FOLDER END`` prints ``runs``, ends by a signal, by a
``failure`` of a callback or by a ``return``, and prints ``as before`` if nothing has changed.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path

import aionode
from aionode import Node, runner
from aionode.interfaces.std_msgs.msg import Int32
from tests.support.guest import guest


def tell(text: str) -> None:
    """Write one line at once."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


class Program(Node):
    """Receives its own messages, and ends as specified."""

    def __init__(self, end: str) -> None:
        super().__init__("program")
        self.end = end
        self.numbers = self.create_publisher(Int32, "numbers", 10)
        self.create_subscription(Int32, "numbers", self.hear, 10)
        self.create_timer(0.05, self.tick)
        self.left = 3

    def tick(self) -> None:
        """Publish."""
        self.numbers.publish(Int32(data=1))

    def hear(self, _: Int32) -> None:
        """End after some messages."""
        self.left -= 1
        if self.left == 0:
            tell("runs")
            if self.end == "failure":
                raise RuntimeError("a mistake of the program")
            if self.end == "return":
                self.destroy_node()


def main(folder: Path, end: str) -> None:
    """Run the program."""
    runner.STARTED_SEC = 0.0  # objects are frozen by then
    with guest(folder), suppress(SystemExit):  # after a failure
        aionode.run(lambda: Program(end))
    tell("as before")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
