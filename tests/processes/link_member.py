"""The other process of a link: echoes numbers, until it is killed or its input ends."""

from __future__ import annotations

import asyncio
import sys

from aionode.context import Context
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node


async def main() -> None:
    """Send back what comes."""
    ended = asyncio.Event()
    asyncio.get_running_loop().add_reader(sys.stdin, ended.set)
    async with (
        Context(link=True) as context,
        Node("echo", context=context, enable_rosout=False, start_parameter_services=False) as node,
    ):
        publisher = node.create_publisher(Int32, "back", 1000)
        node.create_subscription(Int32, "there", publisher.publish, 1000)
        await ended.wait()


if __name__ == "__main__":
    asyncio.run(main())
