"""A service adds two integers, and an async application awaits its responses.

Run it with ``python -m aionode.examples.service``.
"""

from __future__ import annotations

import asyncio

import aionode
from aionode import CallbackContext, Client, Node
from aionode.errors import ServiceError
from aionode.interfaces.example_interfaces.srv import AddTwoInts

__all__ = ["Adder", "application", "main"]

AdderClient = Client[AddTwoInts.Request, AddTwoInts.Response]


class Adder(Node):
    """Serves ~/add_two_ints, a name below its own, several requests at a time."""

    def __init__(self) -> None:
        super().__init__("adder")
        self.service = self.create_service(
            AddTwoInts, "~/add_two_ints", self.add, concurrent=True, on_error=self.report
        )

    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Handle one request, slowly, as if it had to ask another machine."""
        if request.a < 0 or request.b < 0:
            raise ValueError("only counts, please: nothing below zero")
        await self.get_clock().sleep(0.2)
        return AddTwoInts.Response(sum=request.a + request.b)

    def report(self, error: Exception, _context: CallbackContext) -> None:
        """Log the error in one line; the service keeps running."""
        self.get_logger().warning(f"refused: {error}")


async def application() -> None:
    """Make one call, ten at once, an invalid one, and one without a server; then end."""
    async with Adder(), Node("application") as node:
        client = node.create_client(AddTwoInts, "/adder/add_two_ints")
        await client.wait_for_service()
        await call_once(client)
        await call_ten_at_once(client)
        await call_with_bad_request(client)
        await call_without_server(node.create_client(AddTwoInts, "/adder/multiply_two_ints"))


async def call_once(client: AdderClient) -> None:
    """Await one response."""
    response = await client.call(AddTwoInts.Request(a=10, b=25))
    print(f"one call:      10 + 25 = {response.sum}", flush=True)


async def call_ten_at_once(client: AdderClient) -> None:
    """Await ten responses together, which takes as long as one."""
    calls = [client.call(AddTwoInts.Request(a=number, b=number)) for number in range(10)]
    responses = await asyncio.gather(*calls)
    print(f"ten at once:   {[response.sum for response in responses]}", flush=True)


async def call_with_bad_request(client: AdderClient) -> None:
    """Show that an exception of the callback is raised by the call."""
    try:
        await client.call(AddTwoInts.Request(a=-1, b=0))
    except ServiceError as error:
        print(f"a bad request: {error}", flush=True)


async def call_without_server(client: AdderClient) -> None:
    """Call a service without a server, so that the call times out."""
    try:
        await client.call(AddTwoInts.Request(a=2, b=3), timeout_sec=0.5)
    except TimeoutError as error:
        print(f"no server:     {error}", flush=True)


def main() -> None:
    """Run the application until the last response, or until Ctrl-C."""
    aionode.run(application)


if __name__ == "__main__":
    main()
