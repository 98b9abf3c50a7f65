"""``demo_nodes_py talker``: counts from 0, and quotes differently from the one in C++."""

from __future__ import annotations

from typing import ClassVar

import aionode
from aionode.programs._demo_nodes.talker import Talker

__all__ = ["TalkerOfRclpy", "main"]


class TalkerOfRclpy(Talker):
    """Publishes once a second, and counts."""

    first: ClassVar = 0
    quote: ClassVar = '"'


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(TalkerOfRclpy)
