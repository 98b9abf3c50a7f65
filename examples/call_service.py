"""Call a service from an ordinary async program."""

import asyncio

from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts


async def add(a: int, b: int) -> int:
    """Return the sum from /add_two_ints; raise TimeoutError after two seconds without an answer."""
    async with Node("adder_client") as node:
        client = node.create_client(AddTwoInts, "/add_two_ints")
        response = await client.call(AddTwoInts.Request(a=a, b=b), timeout_sec=2.0)
        return response.sum


if __name__ == "__main__":
    try:
        print(asyncio.run(add(10, 25)))
    except TimeoutError as error:
        raise SystemExit(f"error: {error}") from None
