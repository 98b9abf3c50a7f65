"""The other process of a link, which publishes and then ends on request.

Arguments: how many numbers to publish; and ``exit``, to exit abruptly after the last of them, or
``leave``, to end cleanly.
"""

from __future__ import annotations

import asyncio
import os
import sys

from aionode.engine.context import Context
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from tests.support.peers import KEEP_ALL


async def main(count: int, end: str) -> None:
    """Publish numbers, slowly until the link carries them, and then all at once."""
    told = asyncio.Event()
    asyncio.get_running_loop().add_reader(sys.stdin, told.set)
    async with (
        Context(link=True) as context,
        Node("ender", context=context, enable_rosout=False, start_parameter_services=False) as node,
    ):
        publisher = node.create_publisher(Int32, "numbers", KEEP_ALL)
        await publisher.wait_for_subscribers()
        while not told.is_set():
            publisher.publish(Int32(data=-1))
            await node.get_clock().sleep(0.002)
        for number in range(count):
            publisher.publish(Int32(data=number))
        if end == "exit":
            await asyncio.to_thread(lambda: None)  # until the loop has sent the batch
            os._exit(0)


if __name__ == "__main__":
    asyncio.run(main(int(sys.argv[1]), sys.argv[2]))
