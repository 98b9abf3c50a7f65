"""Services of turtlebot3_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, Floats, Message, Sequence, ServiceType, float32, uint8

__all__ = ["Dqn", "Goal", "Sound"]


class Dqn(ServiceType, typename="turtlebot3_msgs/srv/Dqn"):
    """Dqn, as TurtleBot 3 defines it."""

    class Request(Message):
        """The request of Dqn."""

        action: uint8 = 0
        init: bool = False

    class Response(Message):
        """The response of Dqn."""

        state: Annotated[Floats, Sequence[float32]] = DEFAULT
        reward: float32 = 0.0
        done: bool = False


class Goal(ServiceType, typename="turtlebot3_msgs/srv/Goal"):
    """Goal, as TurtleBot 3 defines it."""

    class Request(Message):
        """The request of Goal."""

    class Response(Message):
        """The response of Goal."""

        pose_x: float32 = 0.0
        pose_y: float32 = 0.0
        success: bool = False


class Sound(ServiceType, typename="turtlebot3_msgs/srv/Sound"):
    """Sound, as TurtleBot 3 defines it."""

    class Request(Message):
        """The request of Sound."""

        value: uint8 = 0

    class Response(Message):
        """The response of Sound."""

        success: bool = False
        message: str = ""
