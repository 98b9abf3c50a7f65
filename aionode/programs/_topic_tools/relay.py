"""``topic_tools relay``: republishes a topic on another one."""

from __future__ import annotations

import sys

import aionode
from aionode.arguments import remove_ros_args
from aionode.programs._topic_tools.any_type import AnyTypeNode

__all__ = ["Relay", "main"]


class Relay(AnyTypeNode):
    """Republishes each message.

    Args:
        *words: The input topic, and the output topic; what is left out comes from parameters.
    """

    def __init__(self, *words: str) -> None:
        super().__init__("relay", dict(zip(("input_topic", "output_topic"), words, strict=False)))
        self.declare_topics("_relay")


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(lambda: Relay(*remove_ros_args(sys.argv)[1:]))
