"""The nodes that the terminal tests inspect, run with ``aionode run``."""

from __future__ import annotations

import asyncio
from typing import Any

from aionode import Node
from aionode.action import ActionServer, CancelResponse
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import TwistStamped
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import LifecycleNode
from aionode.message import Message

__all__ = ["AddServer", "Camera", "FibServer", "ParamNode", "Talker"]


class Words(Message, typename="robot_msgs/msg/Words"):
    """A type that exists only as a Python class."""

    text: str = ""


class Talker(Node):
    """Publishes on /chatter and /stamped, 20 times a second."""

    def __init__(self) -> None:
        super().__init__("talker")
        chatter = self.create_publisher(String, "/chatter", 10)
        stamped = self.create_publisher(TwistStamped, "/stamped", 10)
        self.create_publisher(Words, "/_words", 10)  # hidden: only its type is requested
        self.create_timer(0.05, lambda: chatter.publish(String(data="Hello")))
        self.create_timer(0.05, lambda: stamped.publish(self.stamp()))

    def stamp(self) -> TwistStamped:
        """Return a message with the current time."""
        message = TwistStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        return message


class AddServer(Node):
    """Adds two numbers."""

    def __init__(self) -> None:
        super().__init__("add_server")
        self.create_service(AddTwoInts, "/add_two_ints", self.add)

    def add(
        self, request: AddTwoInts.Request, response: AddTwoInts.Response
    ) -> AddTwoInts.Response:
        """Answer with the sum."""
        response.sum = request.a + request.b
        return response


class ParamNode(Node):
    """Has two parameters."""

    def __init__(self) -> None:
        super().__init__("param_node")
        self.declare_parameter("name", "bob")
        self.declare_parameter("speed", 1.5)


class Camera(LifecycleNode):
    """A managed node that nobody configures; hidden, since only its transitions are requested."""

    def __init__(self) -> None:
        super().__init__("_camera")


class FibServer(Node):
    """Serves /fibonacci; order 0 never ends. the last one, so it reports readiness."""

    def __init__(self) -> None:
        super().__init__("fib_server")
        self.server = ActionServer(
            self,
            Fibonacci,
            "/fibonacci",
            self.execute,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )
        self.first = self.create_timer(0.01, self.ready)

    def ready(self) -> None:
        """Report that all nodes are running."""
        self.get_logger().info("the robot is ready")
        self.first.cancel()

    async def execute(self, goal_handle: Any) -> Fibonacci.Result:
        """Compute, or wait until cancelled."""
        if goal_handle.request.order == 0:
            await asyncio.get_running_loop().create_future()
        sequence = [0, 1]
        for _ in range(1, goal_handle.request.order):
            sequence.append(sequence[-1] + sequence[-2])
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal_handle.succeed()
        return Fibonacci.Result(sequence=sequence)
