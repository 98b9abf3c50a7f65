"""The rover's own action type; a ``DriveTo.action`` file with these fields is the same type."""

from __future__ import annotations

from aionode.message import ActionType, Message, float64

__all__ = ["DriveTo"]


class DriveTo(ActionType, typename="rover_interfaces/action/DriveTo"):
    """Drives to a place on the floor, in a straight line; all lengths are in metres."""

    class Goal(Message):
        """The destination, in the frame `odom`."""

        x: float64 = 0.0
        y: float64 = 0.0

    class Result(Message):
        """How far the rover drove, and its distance from the destination."""

        driven: float64 = 0.0
        distance_left: float64 = 0.0

    class Feedback(Message):
        """The remaining distance."""

        distance_left: float64 = 0.0
