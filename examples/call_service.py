"""Call a service from an ordinary async program."""

import asyncio

from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts


async def add(a: int, b: int) -> int:
    """Return the sum from /add_two_ints; raise TimeoutError after two seconds without an answer."""
    async with asyncio.timeout(2), Node("adder_client") as node:
        client = node.create_client(AddTwoInts, "/add_two_ints")
        await client.wait_for_service()
        response = await client.call(AddTwoInts.Request(a=a, b=b))
        return response.sum


if __name__ == "__main__":
    print(asyncio.run(add(10, 25)))
