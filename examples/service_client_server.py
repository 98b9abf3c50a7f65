"""Add two integers: one program that is the server or the client, as its parameter says.

Run the server with ``python examples/service_client_server.py --ros-args -p mode:=server``, and in
a second terminal a client with the same command and ``-p mode:=client -p a:=10 -p b:=25``.
"""

from __future__ import annotations

import sys

import aionode
from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts


class ServiceClientServer(Node):
    """A server of /add_two_ints, or a client that asks it once."""

    def __init__(self) -> None:
        super().__init__("service_client_server")
        mode = self.declare_parameter("mode", "server").value
        if mode == "server":
            self.service = self.create_service(
                AddTwoInts, "/add_two_ints", self.add_two_ints_callback
            )
            self.get_logger().info("Service server ready: /add_two_ints")
        elif mode == "client":
            self.a = self.declare_parameter("a", 0).value
            self.b = self.declare_parameter("b", 0).value
            self.client = self.create_client(AddTwoInts, "/add_two_ints")
            self.timer = self.create_timer(0.0, self.call_service)
        else:
            sys.exit(f"mode: {mode!r}; it is 'server' or 'client'")

    def add_two_ints_callback(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        """Serve one request."""
        response.sum = request.a + request.b
        self.get_logger().info(f"Request: a={request.a}, b={request.b} -> sum={response.sum}")
        return response

    async def call_service(self) -> None:
        """Ask once, print the answer, and end."""
        self.timer.cancel()
        while not await self.client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("Waiting for the service /add_two_ints ...")
        response = await self.client.call(AddTwoInts.Request(a=self.a, b=self.b))
        self.get_logger().info(f"Response: {self.a} + {self.b} = {response.sum}")
        self.destroy_node()


if __name__ == "__main__":
    aionode.run(ServiceClientServer)
