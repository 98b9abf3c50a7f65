"""Messages of turtlesim.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, float32, uint8

__all__ = ["Color", "Pose"]


class Color(Message, typename="turtlesim/msg/Color"):
    """The color of the background under a turtle."""

    r: uint8 = 0
    g: uint8 = 0
    b: uint8 = 0


class Pose(Message, typename="turtlesim/msg/Pose"):
    """Where a turtle is, in units of its window and radians, and how fast it moves, per second."""

    x: float32 = 0.0
    y: float32 = 0.0
    theta: float32 = 0.0
    linear_velocity: float32 = 0.0
    angular_velocity: float32 = 0.0
