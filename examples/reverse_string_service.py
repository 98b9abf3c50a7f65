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
    """Serves /reverse_string."""

    def __init__(self) -> None:
        super().__init__("reverse_string_service")
        self.service = self.create_service(ReverseString, "/reverse_string", self.reverse)
        self.get_logger().info("Service server ready: /reverse_string")

    def reverse(
        self, request: ReverseString.Request, response: ReverseString.Response
    ) -> ReverseString.Response:
        """Serve one request."""
        response.reversed = request.text[::-1]
        self.get_logger().info(f'Request: "{request.text}" -> "{response.reversed}"')
        return response


async def main() -> None:
    """Run the server, or with the parameter `mode` set to `client`, call it once."""
    reader = Node("param_reader")
    mode = reader.declare_parameter("mode", "server").value
    text = reader.declare_parameter("text", "hello").value
    reader.destroy_node()
    if mode == "client":
        async with Node("reverse_string_client") as node:
            client = node.create_client(ReverseString, "/reverse_string")
            await client.wait_for_service()
            response = await client.call(ReverseString.Request(text=text))
            node.get_logger().info(f'Response: "{response.reversed}"')
    else:
        await ReverseStringService().run()


if __name__ == "__main__":
    aionode.run(main)
