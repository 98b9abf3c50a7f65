"""A robot controlled from a web page: the part that runs on the robot.

Run it with ``python examples/web_robot.py``, and beside it, or on another machine, the web
application with ``python examples/web_control.py``.
"""

from __future__ import annotations

import aionode
from aionode import (
    CancelResponse,
    Context,
    GoalRejected,
    GoalResponse,
    Node,
    ServerGoalHandle,
    Supervisor,
)
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.std_msgs.msg import Float32
from aionode.message import ActionType, Message, ServiceType, float64

STEP_SEC = 0.05
FASTEST = 1.0


class SetSpeed(ServiceType, typename="tutorial_interfaces/srv/SetSpeed"):
    """Sets the speed, in m/s."""

    class Request(Message):
        """The requested speed."""

        speed: float64 = 0.0

    class Response(Message):
        """The new speed."""

        speed: float64 = 0.0


class Drive(ActionType, typename="tutorial_interfaces/action/Drive"):
    """Drives straight ahead; distances are in metres."""

    class Goal(Message):
        """The distance to drive."""

        distance: float64 = 0.0

    class Result(Message):
        """The distance driven."""

        distance: float64 = 0.0

    class Feedback(Message):
        """The distance driven so far."""

        distance: float64 = 0.0


Handle = ServerGoalHandle[Drive.Goal, Drive.Result, Drive.Feedback]


class Robot(Node):
    """Drives one goal at a time, and stops the wheels however the goal ends."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__("robot", context=context)
        self.speed = 0.5
        self.busy = False
        self.cmd_vel = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_service(SetSpeed, "/set_speed", self.set_speed)
        self.create_action_server(
            Drive,
            "/drive",
            self.drive,
            goal_callback=self.decide,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
            on_client_lost="cancel",
        )
        self.create_subscription(Float32, "/battery", self.check_battery, 10)
        self.get_logger().info("Ready to drive")

    def set_speed(self, request: SetSpeed.Request) -> SetSpeed.Response:
        """Set the speed; one that the motors cannot reach is an error for the caller only."""
        if not 0.0 < request.speed <= FASTEST:
            raise ValueError(f"speed={request.speed} m/s; expected above 0, at most {FASTEST}")
        self.speed = request.speed
        return SetSpeed.Response(speed=self.speed)

    def decide(self, _goal: Drive.Goal) -> GoalResponse:
        """Accept one goal at a time: two would both control the wheels."""
        if self.busy:
            raise GoalRejected("it drives to another goal")
        return GoalResponse.ACCEPT

    async def drive(self, handle: Handle) -> Drive.Result:
        """Drive until the goal is reached or canceled or the node ends; then stop."""
        self.busy = True
        driven = 0.0
        try:
            while driven < handle.request.distance:
                self.cmd_vel.publish(Twist(linear=Vector3(x=self.speed)))
                handle.publish_feedback(Drive.Feedback(distance=driven))
                await self.get_clock().sleep(STEP_SEC)
                driven += self.speed * STEP_SEC
        finally:
            self.cmd_vel.publish(Twist())
            self.busy = False
        handle.succeed()
        return Drive.Result(distance=driven)

    def check_battery(self, msg: Float32) -> None:
        """Fail if the sensor cannot be trusted; the supervisor restarts the node."""
        if msg.data < 0.0:
            raise ValueError(f"battery at {msg.data} V: the sensor is broken")


if __name__ == "__main__":
    aionode.run(Supervisor(Robot).run)
