"""Messages of nav_2d_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose2D
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, float32, float64

__all__ = ["Path2D", "Pose2D32", "Pose2DStamped", "Twist2D", "Twist2D32", "Twist2DStamped"]


class Twist2D(Message, typename="nav_2d_msgs/msg/Twist2D"):
    """Twist2D, as Nav2 defines it."""

    x: float64 = 0.0
    y: float64 = 0.0
    theta: float64 = 0.0


class Pose2DStamped(Message, typename="nav_2d_msgs/msg/Pose2DStamped"):
    """Pose2DStamped, as Nav2 defines it."""

    header: Header = DEFAULT
    pose: Pose2D = DEFAULT


class Path2D(Message, typename="nav_2d_msgs/msg/Path2D"):
    """Path2D, as Nav2 defines it."""

    header: Header = DEFAULT
    poses: Annotated[list[Pose2D], Sequence[Pose2D]] = DEFAULT


class Pose2D32(Message, typename="nav_2d_msgs/msg/Pose2D32"):
    """Pose2D32, as Nav2 defines it."""

    x: float32 = 0.0
    y: float32 = 0.0
    theta: float32 = 0.0


class Twist2D32(Message, typename="nav_2d_msgs/msg/Twist2D32"):
    """Twist2D32, as Nav2 defines it."""

    x: float32 = 0.0
    y: float32 = 0.0
    theta: float32 = 0.0


class Twist2DStamped(Message, typename="nav_2d_msgs/msg/Twist2DStamped"):
    """Twist2DStamped, as Nav2 defines it."""

    header: Header = DEFAULT
    velocity: Twist2D = DEFAULT
