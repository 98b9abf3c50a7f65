#!/usr/bin/env python3
"""Exercise of the tutorial: a service of a custom type, which reverses a string.

Run the server with ``python examples/reverse_string_service.py``, and in a second terminal a client
with ``python examples/reverse_string_service.py --ros-args -p mode:=client -p text:=hello``.
"""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.message import Message, ServiceType


class ReverseString(ServiceType, typename="tutorial_interfaces/srv/ReverseString"):
    """The same type as a file ReverseString.srv: ``string text``, ``---``, ``string reversed``."""

    class Request(Message):
        """The string to reverse."""

        text: str = ""

    class Response(Message):
        """The same string, last character first."""

        reversed: str = ""


class ReverseStringService(Node):
    """A server of /reverse_string, or a client that calls it once."""

    def __init__(self) -> None:
        super().__init__("reverse_string_service")
        if self.declare_parameter("mode", "server").value == "client":
            self.text = self.declare_parameter("text", "hello").value
            self.client = self.create_client(ReverseString, "/reverse_string")
            self.timer = self.create_timer(0.0, self.call)
        else:
            self.service = self.create_service(ReverseString, "/reverse_string", self.reverse)
            self.get_logger().info("Service server ready: /reverse_string")

    def reverse(
        self, request: ReverseString.Request, response: ReverseString.Response
    ) -> ReverseString.Response:
        """Serve one request."""
        response.reversed = request.text[::-1]
        self.get_logger().info(f'Request: "{request.text}" -> "{response.reversed}"')
        return response

    async def call(self) -> None:
        """Call the service once, log the response, and end."""
        self.timer.cancel()
        await self.client.wait_for_service()
        response = await self.client.call(ReverseString.Request(text=self.text))
        self.get_logger().info(f'Response: "{response.reversed}"')
        self.destroy_node()


if __name__ == "__main__":
    aionode.run(ReverseStringService)
