"""The other process of a link, until it is killed or its input ends.

It echoes numbers; with the argument ``stream`` it publishes large arrays as fast as it can, each
filled with its number.
"""

from __future__ import annotations

import asyncio
import sys

from aionode.engine.context import Context
from aionode.interfaces.std_msgs.msg import Int32, UInt8MultiArray
from aionode.node import Node

STREAMED_BYTES = 120_000  # less than what is shared, more than what a socket takes at once


async def main() -> None:
    """Send back what arrives."""
    ended = asyncio.Event()
    asyncio.get_running_loop().add_reader(sys.stdin, ended.set)
    async with (
        Context(link=True) as context,
        Node("echo", context=context, enable_rosout=False, start_parameter_services=False) as node,
    ):
        if "stream" in sys.argv:
            stream = node.create_publisher(UInt8MultiArray, "stream", 5)
            await stream.wait_for_subscribers()
            number = 0

            def send() -> None:
                nonlocal number
                number = number % 250 + 1
                stream.publish(UInt8MultiArray(data=bytes([number]) * STREAMED_BYTES))

            node.create_timer(0.001, send)
        publisher = node.create_publisher(Int32, "back", 1000)
        node.create_subscription(Int32, "there", publisher.publish, 1000)
        await ended.wait()


if __name__ == "__main__":
    asyncio.run(main())
