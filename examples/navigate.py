"""Drive to a place: an action of a type of its own, with progress on the way.

Run the server with ``python examples/navigate.py``, and in a second terminal a client with
``python examples/navigate.py --ros-args -p mode:=client -p x:=3.0 -p y:=4.0``. Ctrl-C at the client
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
    """Where to go, how far it was, and how far it still is; all in metres."""

    class Goal(Message):
        """The place."""

        x: float64 = 0.0
        y: float64 = 0.0

    class Result(Message):
        """How far the robot went."""

        travelled: float64 = 0.0

    class Feedback(Message):
        """How far it still has to go."""

        distance_left: float64 = 0.0


Handle = ServerGoalHandle[NavigateTo.Goal, NavigateTo.Result, NavigateTo.Feedback]


class Navigate(Node):
    """A robot that drives where it is told to, or a client that tells it."""

    def __init__(self) -> None:
        super().__init__("navigate")
        if self.declare_parameter("mode", "server").value == "client":
            x = self.declare_parameter("x", 3.0).value
            y = self.declare_parameter("y", 4.0).value
            self.goal = NavigateTo.Goal(x=x, y=y)
            self.client = self.create_action_client(NavigateTo, "/navigate_to")
            self.timer = self.create_timer(0.0, self.send)
        else:
            self.server = self.create_action_server(
                NavigateTo,
                "/navigate_to",
                self.drive,
                cancel_callback=lambda _handle: CancelResponse.ACCEPT,
            )
            self.get_logger().info("Action server ready: /navigate_to")

    async def drive(self, handle: Handle) -> NavigateTo.Result:
        """Drive there in a straight line, and tell how far it still is."""
        distance = math.hypot(handle.request.x, handle.request.y)
        left = distance
        try:
            while left > 0:
                await self.get_clock().sleep(STEP_SEC)
                left = max(0.0, left - SPEED * STEP_SEC)
                handle.publish_feedback(NavigateTo.Feedback(distance_left=left))
        except asyncio.CancelledError:
            self.get_logger().info(f"Stopped {left:.1f} m before the goal")
            raise
        handle.succeed()
        self.get_logger().info("Arrived")
        return NavigateTo.Result(travelled=distance)

    async def send(self) -> None:
        """Send the goal, log the progress and the result, and end."""
        self.timer.cancel()
        await self.client.wait_for_server()
        result = await self.client.call(self.goal, feedback_callback=self.progress)
        self.get_logger().info(f"Result: {result.travelled:.1f} m travelled")
        self.destroy_node()

    def progress(self, message: NavigateTo.Impl.FeedbackMessage) -> None:
        """Log one feedback; the message also says which goal it is about, as in rclpy."""
        self.get_logger().info(f"Feedback: {message.feedback.distance_left:.1f} m left")


if __name__ == "__main__":
    aionode.run(Navigate)
