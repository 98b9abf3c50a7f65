"""A process with a publisher that asserts its liveliness; it runs until it is killed."""

from __future__ import annotations

import asyncio

from aionode import Duration, LivelinessPolicy, Node, QoSProfile
from aionode.interfaces.std_msgs.msg import Int32

PROFILE = QoSProfile(
    depth=1,
    liveliness=LivelinessPolicy.AUTOMATIC,
    liveliness_lease_duration=Duration(seconds=1),
)


async def main() -> None:
    """Offer a lease of a second, and publish nothing."""
    async with Node("member", enable_rosout=False) as node:
        node.create_publisher(Int32, "n", PROFILE)
        await node.until_destroyed()


if __name__ == "__main__":
    asyncio.run(main())
