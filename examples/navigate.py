"""Drive to a place: an action of a custom type, with feedback on the way.

Run the server with ``python examples/navigate.py``, and in a second terminal a client with
``python examples/navigate.py --ros-args -p mode:=client -p x:=3.0 -p y:=4.0``. Ctrl-C in the client
stops the robot.
"""

from __future__ import annotations

import asyncio
import math

import aionode
from aionode import CancelResponse, Node, ServerGoalHandle
from aionode.message import ActionType, Message, float64

SPEED = 2.0
STEP_SEC = 0.1


class NavigateTo(ActionType, typename="tutorial_interfaces/action/NavigateTo"):
    """Drives to a place; all distances are in metres."""

    class Goal(Message):
        """The destination."""

        x: float64 = 0.0
        y: float64 = 0.0

    class Result(Message):
        """The distance that the robot travelled."""

        travelled: float64 = 0.0

    class Feedback(Message):
        """The distance that is left."""

        distance_left: float64 = 0.0


Handle = ServerGoalHandle[NavigateTo.Goal, NavigateTo.Result, NavigateTo.Feedback]


async def main() -> None:
    """Run the robot, or with the parameter `mode` set to `client`, send it a goal."""
    reader = Node("param_reader")
    mode = reader.declare_parameter("mode", "server").value
    reader.destroy_node()
    if mode == "client":
        async with Node("navigate_client") as node:
            await send(node)
    else:
        async with Node("navigate_server") as node:
            await serve(node)


async def serve(node: Node) -> None:
    """Serve the action until Ctrl-C."""

    async def drive(handle: Handle) -> NavigateTo.Result:
        """Drive in a straight line, and publish the distance left."""
        distance = left = math.hypot(handle.request.x, handle.request.y)
        try:
            while left > 0:
                await node.get_clock().sleep(STEP_SEC)
                left = max(0.0, left - SPEED * STEP_SEC)
                handle.publish_feedback(NavigateTo.Feedback(distance_left=left))
        except asyncio.CancelledError:
            node.get_logger().info(f"Stopped {left:.1f} m before the goal")
            raise
        handle.succeed()
        node.get_logger().info("Arrived")
        return NavigateTo.Result(travelled=distance)

    node.create_action_server(
        NavigateTo,
        "/navigate_to",
        drive,
        cancel_callback=lambda _handle: CancelResponse.ACCEPT,
        on_client_lost="cancel",
    )
    node.get_logger().info("Action server ready: /navigate_to")
    await asyncio.Event().wait()


async def send(node: Node) -> None:
    """Send a goal, and log its feedback and result; Ctrl-C cancels the goal."""
    x = node.declare_parameter("x", 3.0).value
    y = node.declare_parameter("y", 4.0).value
    client = node.create_action_client(NavigateTo, "/navigate_to")
    await client.wait_for_server()
    goal = await client.send_goal(NavigateTo.Goal(x=x, y=y))
    async for feedback in goal:
        node.get_logger().info(f"Feedback: {feedback.distance_left:.1f} m left")
    outcome = await goal.result()
    node.get_logger().info(f"Result: {outcome.result.travelled:.1f} m travelled")


if __name__ == "__main__":
    aionode.run(main)
