"""A service adds two integers, and an async application awaits its answers.

Run it with ``python -m aionode.examples.service``.
"""

from __future__ import annotations

import asyncio

import aionode
from aionode import CallbackContext, Client, Node
from aionode.errors import ServiceError
from aionode.interfaces.example_interfaces.srv import AddTwoInts

__all__ = ["Adder", "application", "main"]

Asker = Client[AddTwoInts.Request, AddTwoInts.Response]


class Adder(Node):
    """Serves ~/add_two_ints, which is its own, several requests at a time."""

    def __init__(self) -> None:
        super().__init__("adder")
        self.service = self.create_service(
            AddTwoInts, "~/add_two_ints", self.add, concurrent=True, on_error=self.report
        )

    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Answer one request; slowly, as if another machine had to be asked."""
        if request.a < 0 or request.b < 0:
            raise ValueError("only counts, please: nothing below zero")
        await self.get_clock().sleep(0.2)
        return AddTwoInts.Response(sum=request.a + request.b)

    def report(self, error: Exception, _context: CallbackContext) -> None:
        """Say in one line what went wrong, and go on serving."""
        self.get_logger().warning(f"refused: {error}")


async def application() -> None:
    """Ask once, ten times at once, wrongly, and without a server; then end."""
    async with Adder(), Node("application") as node:
        client = node.create_client(AddTwoInts, "/adder/add_two_ints")
        await client.wait_for_service()
        await ask_once(client)
        await ask_ten_at_once(client)
        await ask_wrongly(client)
        await ask_nobody(node.create_client(AddTwoInts, "/adder/multiply_two_ints"))


async def ask_once(client: Asker) -> None:
    """Await one answer."""
    response = await client.call(AddTwoInts.Request(a=10, b=25))
    print(f"one call:      10 + 25 = {response.sum}", flush=True)


async def ask_ten_at_once(client: Asker) -> None:
    """Await ten answers together: that takes as long as one."""
    calls = [client.call(AddTwoInts.Request(a=number, b=number)) for number in range(10)]
    responses = await asyncio.gather(*calls)
    print(f"ten at once:   {[response.sum for response in responses]}", flush=True)


async def ask_wrongly(client: Asker) -> None:
    """Get the exception of the handler as an error of the call."""
    try:
        await client.call(AddTwoInts.Request(a=-1, b=0))
    except ServiceError as error:
        print(f"a bad request: {error}", flush=True)


async def ask_nobody(client: Asker) -> None:
    """Notice that there is no server: a limit is part of the call."""
    try:
        await client.call(AddTwoInts.Request(a=2, b=3), timeout_sec=0.5)
    except TimeoutError as error:
        print(f"no server:     {error}", flush=True)


def main() -> None:
    """Run server and application until the last answer, or until Ctrl-C."""
    aionode.run(application)


if __name__ == "__main__":
    main()
