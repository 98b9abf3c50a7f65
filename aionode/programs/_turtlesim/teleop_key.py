"""``turtlesim turtle_teleop_key``: moves the first turtle with keys."""

from __future__ import annotations

import asyncio
from typing import Any, Final

import aionode
from aionode import Node
from aionode.errors import AionodeError
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.turtlesim.action import RotateAbsolute
from aionode.programs._teleop_twist_keyboard import show, terminal
from aionode.programs._turtlesim.node import TOPIC_QOS

__all__ = ["TeleopTurtle", "main"]

HELP: Final = """\
Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. 'F' to cancel a rotation.
'Q' to quit.
"""

ARROWS: Final[dict[str, tuple[int, int]]] = {"A": (1, 0), "B": (-1, 0), "C": (0, -1), "D": (0, 1)}
"""The last letters that arrow keys send, and how they move the turtle: ahead, and around."""

ANGLES: Final = {"g": 0.0, "t": 0.7854, "r": 1.5708, "e": 2.3562, "d": 3.1416, "c": -2.3562,
                 "v": -1.5708, "b": -0.7854}  # fmt: skip


class TeleopTurtle(Node):
    """Publishes each arrow key's command on `turtle1/cmd_vel` once: turtles stop after a second."""

    def __init__(self) -> None:
        super().__init__("teleop_turtle")
        self.declare_parameter("scale_angular", 2.0)
        self.declare_parameter("scale_linear", 2.0)
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", TOPIC_QOS)
        self.rotations = self.create_action_client(RotateAbsolute, "turtle1/rotate_absolute")
        self.goal: asyncio.Future[Any] | None = None
        self.is_ended = asyncio.Event()

    def press(self, key: str) -> None:
        """Handle a key."""
        if key in ARROWS:
            ahead, around = ARROWS[key]
            linear = Vector3(x=ahead * self.get_parameter("scale_linear").value)
            angular = Vector3(z=around * self.get_parameter("scale_angular").value)
            self.publisher.publish(Twist(linear=linear, angular=angular))
        elif key in ANGLES:
            self.goal = self.rotations.send_goal_async(RotateAbsolute.Goal(theta=ANGLES[key]))
            self.goal.add_done_callback(self.note)
        elif key == "f" and (goal := self.accepted_goal()) is not None:
            goal.cancel_goal_async().add_done_callback(self.note)
        elif key == "q":
            self.is_ended.set()

    def accepted_goal(self) -> Any:
        """Return the last goal, if the turtle has accepted it."""
        answer = self.goal
        if answer is None or not answer.done() or answer.cancelled() or answer.exception():
            return None
        return answer.result() if answer.result().accepted else None

    def note(self, answer: asyncio.Future[Any]) -> None:
        """Print why a turtle does not turn."""
        error = None if answer.cancelled() else answer.exception()
        if isinstance(error, AionodeError):
            self.get_logger().warning(str(error))


async def drive_by_keys() -> None:
    """Drive until 'q' or Ctrl-C, or until the terminal is lost."""
    async with TeleopTurtle() as node:
        with terminal(node.press, node.is_ended.set):
            show(HELP)  # from here on keys are handled
            await node.is_ended.wait()


def main() -> None:
    """Drive until 'q' or Ctrl-C, or until the terminal is lost."""
    aionode.run(drive_by_keys)
