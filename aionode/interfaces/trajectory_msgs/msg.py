"""Messages of trajectory_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geometry_msgs.msg import Transform, Twist
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Floats, Message, Sequence, float64

__all__ = [
    "JointTrajectory",
    "JointTrajectoryPoint",
    "MultiDOFJointTrajectory",
    "MultiDOFJointTrajectoryPoint",
]


class JointTrajectoryPoint(Message, typename="trajectory_msgs/msg/JointTrajectoryPoint"):
    """Where joints should be at one time. The lists correspond by index; each may be empty.

    Attributes:
        positions: In rad, or in m for a joint that slides.
        velocities: In rad/s or m/s.
        accelerations: In rad/s² or m/s².
        effort: In N·m or N.
        time_from_start: When, after the trajectory begins.
    """

    positions: Annotated[Floats, Sequence[float64]] = DEFAULT
    velocities: Annotated[Floats, Sequence[float64]] = DEFAULT
    accelerations: Annotated[Floats, Sequence[float64]] = DEFAULT
    effort: Annotated[Floats, Sequence[float64]] = DEFAULT
    time_from_start: Duration = DEFAULT


class JointTrajectory(Message, typename="trajectory_msgs/msg/JointTrajectory"):
    """How joints should move: points in time for the joints of `joint_names`."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    points: Annotated[list[JointTrajectoryPoint], Sequence[JointTrajectoryPoint]] = DEFAULT


class MultiDOFJointTrajectoryPoint(
    Message, typename="trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"
):
    """Where such joints should be at one time; in m, m/s, m/s² and rad."""

    transforms: Annotated[list[Transform], Sequence[Transform]] = DEFAULT
    velocities: Annotated[list[Twist], Sequence[Twist]] = DEFAULT
    accelerations: Annotated[list[Twist], Sequence[Twist]] = DEFAULT
    time_from_start: Duration = DEFAULT


class MultiDOFJointTrajectory(Message, typename="trajectory_msgs/msg/MultiDOFJointTrajectory"):
    """How joints that move along or about several axes should move."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    points: Annotated[
        list[MultiDOFJointTrajectoryPoint], Sequence[MultiDOFJointTrajectoryPoint]
    ] = DEFAULT
