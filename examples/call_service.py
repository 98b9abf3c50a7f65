"""Ask a service for a sum, from any async program."""

import asyncio

from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts


async def add(a: int, b: int) -> int:
    """Return the sum that /add_two_ints gives; TimeoutError after two seconds without one."""
    async with asyncio.timeout(2), Node("asker") as node:
        client = node.create_client(AddTwoInts, "/add_two_ints")
        await client.wait_for_service()
        response = await client.call(AddTwoInts.Request(a=a, b=b))
        return response.sum


if __name__ == "__main__":
    print(asyncio.run(add(10, 25)))
