"""``topic_tools drop``: republishes a topic without the first X of every Y messages."""

from __future__ import annotations

import sys

import aionode
from aionode import Parameter
from aionode.arguments import remove_ros_args
from aionode.programs._topic_tools.any_type import AnyTypeNode, given_number

__all__ = ["Drop", "main"]


class Drop(AnyTypeNode):
    """Republishes some of the messages.

    Args:
        *words: The input topic, X, Y, and the output topic; fewer than three are ignored.
    """

    def __init__(self, *words: str) -> None:
        given: dict[str, str | float] = {}
        if len(words) > 2:
            given = {
                "input_topic": words[0],
                "X": given_number(words[1], int, "X"),
                "Y": given_number(words[2], int, "Y"),
            }
            given |= dict(zip(("output_topic",), words[3:], strict=False))
        super().__init__("drop", given)
        self.declare_topics("_drop")
        self.left_out: int = self.needed("X", Parameter.Type.INTEGER)
        self.total: int = self.needed("Y", Parameter.Type.INTEGER)
        self.count = 0

    def process(self, data: bytes) -> None:
        """Publish a message, unless it is one of the first X."""
        if self.count >= self.left_out:
            self.send(data)
        self.count += 1
        if self.count >= self.total:
            self.count = 0


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(lambda: Drop(*remove_ros_args(sys.argv)[1:]))
