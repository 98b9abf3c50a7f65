"""Actions of turtlebot3_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geometry_msgs.msg import Vector3
from aionode.message import DEFAULT, ActionType, Message

__all__ = ["Patrol"]


class Patrol(ActionType, typename="turtlebot3_msgs/action/Patrol"):
    """Patrol, as TurtleBot 3 defines it."""

    class Goal(Message):
        """The goal of Patrol."""

        goal: Vector3 = DEFAULT

    class Result(Message):
        """The result of Patrol."""

        result: str = ""

    class Feedback(Message):
        """The feedback of Patrol."""

        state: str = ""
