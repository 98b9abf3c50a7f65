"""``turtlesim turtlesim_node``: turtles that draw, in a window that is a topic of images."""

from __future__ import annotations

import asyncio
import math
import random
import struct
from dataclasses import dataclass
from typing import Any, Final

import aionode
from aionode import (
    CancelResponse,
    GoalResponse,
    Node,
    QoSProfile,
    ServerGoalHandle,
)
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from aionode.interfaces.sensor_msgs.msg import CompressedImage
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.std_srvs.srv import Empty
from aionode.interfaces.turtlesim.action import RotateAbsolute
from aionode.interfaces.turtlesim.msg import Color, Pose
from aionode.interfaces.turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from aionode.programs._turtlesim.picture import METER, SIZE, Pen, Picture, png
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["TOPIC_QOS", "TurtleSim", "main"]

TOPIC_QOS: Final = QoSProfile(depth=7)
"""The QoS of all topics of turtlesim, reliable."""

BACKGROUND: Final = {"background_r": ("Red", 0x45), "background_g": ("Green", 0x56),
                     "background_b": ("Blue", 0xFF)}  # fmt: skip

STEP_SEC: Final = 0.016
COMMAND_NS: Final = 1_000_000_000
"""How long a command is valid."""

EDGE: Final = (SIZE - 1) / METER
"""Width and height of the window, in units."""

NEAR: Final = 0.02
"""Tolerance of the final angle of a rotation, in radians."""

PICTURE_SEC: Final = 0.1
STILL_PICTURES: Final = 10
"""An unchanged picture is published only once in this many intervals."""

MAX_TURTLES: Final = 100

Handle = ServerGoalHandle[RotateAbsolute.Goal, RotateAbsolute.Result, RotateAbsolute.Feedback]


def normalized(angle: float) -> float:
    """Return an angle between -π and π."""
    return angle - 2 * math.pi * math.floor((angle + math.pi) / (2 * math.pi))


def single(number: float) -> float:
    """Return a number rounded to float32."""
    value: float = struct.unpack("f", struct.pack("f", number))[0]
    return value


def refuse_unreal(**numbers: float) -> None:
    """Refuse numbers that are not finite.

    Raises:
        ValueError: One is infinite or NaN.
    """
    for name, number in numbers.items():
        if not math.isfinite(number):
            raise ValueError(f"{name} is {number}; use a finite number")


def answer_to(goal: RotateAbsolute.Goal) -> GoalResponse:
    """Reject a goal whose angle is not a number."""
    return GoalResponse.ACCEPT if math.isfinite(goal.theta) else GoalResponse.REJECT


@dataclass
class Rotation:
    """A goal that turns a turtle.

    Attributes:
        handle: The goal.
        start: The angle of the turtle when it began.
        ended: Whether it was reached, once that is known.
        result: How far the turtle has turned.
    """

    handle: Handle
    start: float
    ended: asyncio.Future[bool]
    result: RotateAbsolute.Result


class Turtle:
    """A turtle with its topics, services and action.

    Args:
        node: The node that it belongs to.
        name: Its name, which prefixes those of its topics.
        picture: The picture that it draws on.
        x: Where it is, in units from the left.
        y: Where it is, in units from the bottom.
        theta: Its direction, in radians.
    """

    def __init__(
        self, node: Node, name: str, picture: Picture, x: float, y: float, theta: float
    ) -> None:
        self.node = node
        self.picture = picture
        self.x, self.down, self.theta = x, EDGE - y, theta
        self.forward = self.sideways = self.turning = 0.0
        self.pen: Pen | None = Pen()
        self.shell = random.randrange(1000)  # noqa: S311  # a color
        self.has_jumped = False
        self.rotation: Rotation | None = None
        self.commanded_ns = node.get_clock().now().nanoseconds
        self.pose = node.create_publisher(Pose, f"{name}/pose", TOPIC_QOS)
        self.color = node.create_publisher(Color, f"{name}/color_sensor", TOPIC_QOS)
        self.parts: tuple[Any, ...] = (
            self.pose,
            self.color,
            node.create_subscription(Twist, f"{name}/cmd_vel", self.on_command, TOPIC_QOS),
            node.create_service(SetPen, f"{name}/set_pen", self.set_pen),
            node.create_service(
                TeleportRelative, f"{name}/teleport_relative", self.teleport_relative
            ),
            node.create_service(
                TeleportAbsolute, f"{name}/teleport_absolute", self.teleport_absolute
            ),
            node.create_action_server(
                RotateAbsolute,
                f"{name}/rotate_absolute",
                self.rotate,
                goal_callback=answer_to,
                cancel_callback=lambda _goal: CancelResponse.ACCEPT,
            ),
        )

    def destroy(self) -> None:
        """End its topics, services and action."""
        for part in self.parts:
            part.destroy()

    def on_command(self, twist: Twist) -> None:
        """Move with these speeds for a second."""
        log = self.node.get_logger()
        numbers = twist.linear.x, twist.linear.y, twist.angular.z
        if not all(map(math.isfinite, numbers)):
            log.warning(
                f"{self.pose.topic_name}: stopped, because a command is not finite: {numbers}"
            )
            numbers = 0.0, 0.0, 0.0
        self.commanded_ns = self.node.get_clock().now().nanoseconds
        self.forward, sideways, self.turning = numbers
        if self.node.get_parameter("holonomic").value:
            self.sideways = sideways
        if self.rotation is not None:
            log.warning("Velocity command received during rotation goal. Aborting goal")
            self.end_rotation(reached=False)

    def set_pen(self, request: Any, response: Any) -> Any:
        """Change or lift the pen."""
        if request.off:
            self.pen = None
        else:
            # A pen without a width gets the width of the original's new pen.
            self.pen = Pen((request.r, request.g, request.b), request.width or 1)
        return response

    def teleport_relative(self, request: Any, response: Any) -> Any:
        """Turn and move, at once."""
        refuse_unreal(linear=request.linear, angular=request.angular)
        self.theta += request.angular
        self.jump(
            self.x + math.cos(self.theta) * request.linear,
            self.down - math.sin(self.theta) * request.linear,
        )
        return response

    def teleport_absolute(self, request: Any, response: Any) -> Any:
        """Jump to a place, at once."""
        refuse_unreal(x=request.x, y=request.y, theta=request.theta)
        self.theta = request.theta
        self.jump(request.x, max(0.0, EDGE - request.y))
        return response

    def jump(self, x: float, down: float) -> None:
        """Jump to a place, drawing a line with the pen."""
        before = self.x, self.down
        self.x, self.down = x, down
        self.draw(before)
        self.has_jumped = True

    async def rotate(self, handle: Handle) -> RotateAbsolute.Result:
        """Turn to an angle."""
        log = self.node.get_logger()
        if self.rotation is not None:
            log.warning(
                "Rotation goal received before a previous goal finished. Aborting previous goal"
            )
            self.end_rotation(reached=False)
        ended = asyncio.get_running_loop().create_future()
        mine = self.rotation = Rotation(handle, self.theta, ended, RotateAbsolute.Result())
        try:
            reached = await ended
        except asyncio.CancelledError:
            if not handle.is_cancel_requested:
                raise
            log.info("Rotation goal canceled")
            self.stop()
            handle.canceled()
            return mine.result
        finally:
            if self.rotation is mine:
                self.rotation = None
        if reached:
            log.info("Rotation goal completed successfully")
            handle.succeed()
        else:
            handle.abort()
        return mine.result

    def end_rotation(self, *, reached: bool) -> None:
        """End the goal that turns it."""
        if self.rotation is not None and not self.rotation.ended.done():
            self.rotation.ended.set_result(reached)
        self.rotation = None

    def stop(self) -> None:
        """Stop moving."""
        self.forward = self.sideways = self.turning = 0.0

    def follow(self, rotation: Rotation, now_ns: int) -> None:
        """Continue to turn towards the angle of a goal."""
        remaining = normalized(normalized(rotation.handle.request.theta) - self.theta)
        rotation.result.delta = normalized(rotation.start - self.theta)
        rotation.handle.publish_feedback(RotateAbsolute.Feedback(remaining=remaining))
        self.stop()
        if abs(remaining) < NEAR:
            self.end_rotation(reached=True)
        else:
            self.turning = -1.0 if remaining < 0 else 1.0
            self.commanded_ns = now_ns

    def update(self) -> bool:
        """Move by one step; return whether the picture has changed."""
        start = self.theta
        is_changed, self.has_jumped = self.has_jumped, False
        now_ns = self.node.get_clock().now().nanoseconds
        if self.rotation is not None:
            self.follow(self.rotation, now_ns)
        if now_ns - self.commanded_ns > COMMAND_NS:
            self.stop()
        before = self.x, self.down
        self.theta = normalized(self.theta + self.turning * STEP_SEC)
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        self.x += (cos * self.forward - sin * self.sideways) * STEP_SEC
        self.down -= (cos * self.sideways + sin * self.forward) * STEP_SEC
        if not (0 <= self.x <= EDGE and 0 <= self.down <= EDGE):
            self.node.get_logger().warning(
                f"Oh no! I hit the wall! (Clamping from [x={self.x:f}, y={self.down:f}])"
            )
            self.x, self.down = min(max(self.x, 0.0), EDGE), min(max(self.down, 0.0), EDGE)
        self.publish()
        if (self.x, self.down) != before:
            self.draw(before)
            is_changed = True
        return is_changed or self.theta != start

    def draw(self, before: tuple[float, float]) -> None:
        """Draw a line from its last place."""
        if self.pen is not None:
            places = (*before, self.x, self.down)
            self.picture.draw(self.pen, *(place * METER for place in places))

    def publish(self) -> None:
        """Publish its place, and the color under it."""
        self.pose.publish(
            Pose(
                x=self.x,
                y=EDGE - self.down,
                theta=self.theta,
                linear_velocity=math.hypot(self.forward, self.sideways),
                angular_velocity=self.turning,
            )
        )
        red, green, blue = self.picture.color_at(self.x * METER, self.down * METER)
        self.color.publish(Color(r=red, g=green, b=blue))


class TurtleSim(Node):
    """Simulates turtles, and publishes a picture of them on `~/image/compressed`, as PNG."""

    def __init__(self) -> None:
        super().__init__("turtlesim")
        limits = [IntegerRange(from_value=0, to_value=255, step=1)]
        for parameter, (color, value) in BACKGROUND.items():
            text = f"{color} channel of the background color"
            self.declare_parameter(
                parameter, value, ParameterDescriptor(description=text, integer_range=limits)
            )
        text = "If true, then turtles will be holonomic"
        self.declare_parameter("holonomic", False, ParameterDescriptor(description=text))
        self.picture = Picture()
        self.turtles: dict[str, Turtle] = {}
        self.number = 0
        self.is_changed = True
        self.shown_at = self.ticks = 0
        self.background = self.colors()
        self.create_service(Empty, "clear", self.on_clear)
        self.create_service(Empty, "reset", self.on_reset)
        self.create_service(Spawn, "spawn", self.on_spawn)
        self.create_service(Kill, "kill", self.on_kill)
        self.images = self.create_publisher(CompressedImage, "~/image/compressed", 1)
        self.get_logger().info(
            f"Starting turtlesim with node name {self.get_fully_qualified_name()}"
        )
        self.spawn("", EDGE / 2, EDGE / 2, 0.0)
        create_wall_timer(self, STEP_SEC, self.update)
        create_wall_timer(self, PICTURE_SEC, self.show)

    def colors(self) -> tuple[int, int, int]:
        """Return the color of the background."""
        red, green, blue = (self.get_parameter(name).value for name in BACKGROUND)
        return red, green, blue

    def spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """Add a turtle, and return its name; an empty name if there is already one with that name.

        Raises:
            ValueError: Its place is not finite, its name is invalid in topics, or there are too
                many.
        """
        refuse_unreal(x=x, y=y, theta=theta)
        if len(self.turtles) >= MAX_TURTLES:
            raise ValueError(f"there are already {MAX_TURTLES} turtles; kill one")
        while not name:
            self.number += 1
            if f"turtle{self.number}" not in self.turtles:
                name = f"turtle{self.number}"
        if name in self.turtles:
            return ""
        self.resolve_topic_name(f"{name}/pose")  # refuses invalid names
        x, y, theta = single(x), single(y), single(theta)
        self.turtles[name] = Turtle(self, name, self.picture, x, y, theta)
        self.is_changed = True
        self.get_logger().info(
            f"Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]"
        )
        return name

    def on_spawn(self, request: Any, response: Any) -> Any:
        """Add a turtle."""
        response.name = self.spawn(request.name, request.x, request.y, request.theta)
        if not response.name:
            self.get_logger().error(f"A turtle named [{request.name}] already exists")
        return response

    def on_kill(self, request: Any, response: Any) -> Any:
        """Remove a turtle."""
        if request.name not in self.turtles:
            self.get_logger().error(f"Tried to kill turtle [{request.name}], which does not exist")
            return response
        self.turtles.pop(request.name).destroy()
        self.is_changed = True
        return response

    def on_clear(self, _request: Any, response: Any) -> Any:
        """Remove all lines."""
        self.get_logger().info("Clearing turtlesim.")
        self.picture.clear()
        self.is_changed = True
        return response

    def on_reset(self, _request: Any, response: Any) -> Any:
        """Start over."""
        self.get_logger().info("Resetting turtlesim.")
        while self.turtles:
            self.turtles.popitem()[1].destroy()
        self.number = 0
        self.spawn("", EDGE / 2, EDGE / 2, 0.0)
        self.picture.clear()
        return response

    def update(self) -> None:
        """Move all turtles by a step."""
        for _, turtle in sorted(self.turtles.items()):
            self.is_changed |= turtle.update()

    def show(self) -> None:
        """Publish the picture for subscriptions if it has changed, and otherwise once a second."""
        self.ticks += 1
        background = self.colors()
        is_old = self.ticks >= self.shown_at + STILL_PICTURES
        is_new = self.is_changed or background != self.background
        if not (is_old or is_new) or not self.images.get_subscription_count():
            return
        self.is_changed, self.background, self.shown_at = False, background, self.ticks
        turtles = [
            (turtle.x * METER, turtle.down * METER, turtle.theta, turtle.shell)
            for _, turtle in sorted(self.turtles.items())
        ]
        self.images.publish(
            CompressedImage(
                header=Header(stamp=self.get_clock().now().to_msg(), frame_id="turtlesim"),
                format="rgb8; png compressed bgr8",
                data=png(self.picture.painted(background, turtles)),
            )
        )


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(TurtleSim)
