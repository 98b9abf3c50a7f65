"""Actions of turtlesim.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import ActionType, Message, float32

__all__ = ["RotateAbsolute"]


class RotateAbsolute(ActionType, typename="turtlesim/action/RotateAbsolute"):
    """Turns a turtle to an angle, in radians."""

    class Goal(Message):
        """The goal of RotateAbsolute."""

        theta: float32 = 0.0

    class Result(Message):
        """The result of RotateAbsolute."""

        delta: float32 = 0.0

    class Feedback(Message):
        """The feedback of RotateAbsolute."""

        remaining: float32 = 0.0
