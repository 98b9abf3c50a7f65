"""A node of the how-to on access control, in a process of its own: ``visitor`` or ``robot``.

The visitor publishes ten numbers on /scan, and on /chatter, which its rules do not allow; the robot
prints what it receives, and which nodes publish /chatter.
"""

from __future__ import annotations

import asyncio
import sys

from aionode import Node
from aionode.interfaces.std_msgs.msg import Int32

COUNT = 10


async def visit() -> None:
    """Publish both topics."""
    async with Node("visitor") as node:
        scan, chatter = (node.create_publisher(Int32, name, COUNT) for name in ("scan", "chatter"))
        await scan.wait_for_subscribers()
        for number in range(COUNT):
            chatter.publish(Int32(data=number))
            scan.publish(Int32(data=number))
        await asyncio.Event().wait()


async def stay() -> None:
    """Subscribe to both topics."""
    async with Node("robot") as node:
        for name in ("scan", "chatter"):
            node.create_subscription(Int32, name, lambda msg, name=name: say(f"{name} {msg.data}"))
        say("open")
        await node.wait_for_node("visitor", 30)
        say("seen")
        await asyncio.Event().wait()


def say(text: str) -> None:
    """Print a line."""
    print(text, flush=True)  # noqa: T201 - a program


if __name__ == "__main__":
    asyncio.run(visit() if sys.argv[1] == "visitor" else stay())
