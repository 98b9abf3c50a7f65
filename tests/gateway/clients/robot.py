"""A robot for clients of rosbridge: topics, services, an action and parameters, and a gateway.

Run it as ``python tests/gateway/clients/robot.py PORT [ORIGIN...]``. Everything is allowed, on this
host only; pages of these origins may connect.
"""

from __future__ import annotations

import asyncio
import sys
from typing import Any

import msgspec

from aionode import Context, Node
from aionode.action import ActionServer, CancelResponse, ServerGoalHandle
from aionode.gateway import Gateway, Policy
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String


class AddTwoIntsServer(Node):
    """The robot that the examples of roslibjs expect."""

    def __init__(self, context: Context) -> None:
        super().__init__("add_two_ints_server", context=context)
        self.declare_parameter("speed", 1.5)
        self.create_service(AddTwoInts, "/add_two_ints", self.add)
        self.words = self.create_publisher(String, "/listener", 10)
        self.create_timer(0.1, self.publish)
        ActionServer(self, Fibonacci, "/fibonacci", self.count, cancel_callback=self.accept)

    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Add two numbers."""
        return AddTwoInts.Response(sum=request.a + request.b)

    def publish(self) -> None:
        """Say hello."""
        self.words.publish(String(data="Hello, World"))

    def accept(self, goal: object) -> CancelResponse:
        """Accept every request to cancel a goal."""
        return CancelResponse.ACCEPT

    async def count(self, goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
        """Count for 0.25 s for each number, with feedback."""
        sequence = [0, 1]
        for _ in range(1, goal.request.order):
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            await self.get_clock().sleep(0.25)
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)


async def main(port: int, origins: list[str]) -> None:
    """Serve until the process is ended."""
    policy = msgspec.structs.replace(Policy.default(allow_write=True), origins=origins)
    async with (
        Context(transport="local") as context,
        AddTwoIntsServer(context),
        Node("gateway", context=context) as node,
        Gateway(node, policy, port=port) as gateway,
    ):
        sys.stdout.write(f"{gateway.port}\n")
        sys.stdout.flush()
        await asyncio.Event().wait()


if __name__ == "__main__":
    asyncio.run(main(int(sys.argv[1]), sys.argv[2:]))
