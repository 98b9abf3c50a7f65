#!/usr/bin/env python3
"""Add two integers: a server or a client, depending on a parameter.

Run the server with ``python examples/service_client_server.py --ros-args -p mode:=server``, and in
a second terminal a client with the same command and ``-p mode:=client -p a:=10 -p b:=25``.
"""

from __future__ import annotations

import sys

import aionode
from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts


class AddTwoIntsServer(Node):
    """Serves /add_two_ints."""

    def __init__(self) -> None:
        super().__init__("add_two_ints_server")
        self.service = self.create_service(AddTwoInts, "/add_two_ints", self.add_two_ints_callback)
        self.get_logger().info("AddTwoInts service server started at /add_two_ints")

    def add_two_ints_callback(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        """Serve one request."""
        response.sum = request.a + request.b
        self.get_logger().info(f"Request: a={request.a}, b={request.b} -> sum={response.sum}")
        return response


class AddTwoIntsClient(Node):
    """Calls /add_two_ints once."""

    def __init__(self, a: int, b: int) -> None:
        super().__init__("add_two_ints_client")
        self.client = self.create_client(AddTwoInts, "/add_two_ints")
        self.request = AddTwoInts.Request(a=a, b=b)

    async def call(self) -> None:
        """Wait for the service, call it, and log the response."""
        logger, a, b = self.get_logger(), self.request.a, self.request.b
        while not await self.client.wait_for_service(timeout_sec=1.0):
            logger.info("Waiting for service /add_two_ints...")
        logger.info(f"Service client ready. Request: a={a}, b={b}")
        logger.info(f"Calling service with a={a}, b={b}")
        response = await self.client.call(self.request)
        logger.info(f"Response: {a} + {b} = {response.sum}")


async def main() -> None:
    """Run the server or the client, depending on the parameter `mode`."""
    reader = Node("param_reader")
    mode = reader.declare_parameter("mode", "server").value
    a = reader.declare_parameter("a", 0).value
    b = reader.declare_parameter("b", 0).value
    reader.destroy_node()

    if mode == "server":
        await AddTwoIntsServer().run()
    elif mode == "client":
        async with AddTwoIntsClient(a, b) as client:
            await client.call()
    else:
        sys.exit(f"mode: {mode!r} given; expected 'server' or 'client'")


if __name__ == "__main__":
    aionode.run(main)
