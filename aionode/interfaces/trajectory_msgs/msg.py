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
    """JointTrajectoryPoint."""

    positions: Annotated[Floats, Sequence[float64]] = DEFAULT
    velocities: Annotated[Floats, Sequence[float64]] = DEFAULT
    accelerations: Annotated[Floats, Sequence[float64]] = DEFAULT
    effort: Annotated[Floats, Sequence[float64]] = DEFAULT
    time_from_start: Duration = DEFAULT


class JointTrajectory(Message, typename="trajectory_msgs/msg/JointTrajectory"):
    """JointTrajectory."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    points: Annotated[list[JointTrajectoryPoint], Sequence[JointTrajectoryPoint]] = DEFAULT


class MultiDOFJointTrajectoryPoint(
    Message, typename="trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"
):
    """MultiDOFJointTrajectoryPoint."""

    transforms: Annotated[list[Transform], Sequence[Transform]] = DEFAULT
    velocities: Annotated[list[Twist], Sequence[Twist]] = DEFAULT
    accelerations: Annotated[list[Twist], Sequence[Twist]] = DEFAULT
    time_from_start: Duration = DEFAULT


class MultiDOFJointTrajectory(Message, typename="trajectory_msgs/msg/MultiDOFJointTrajectory"):
    """MultiDOFJointTrajectory."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    points: Annotated[
        list[MultiDOFJointTrajectoryPoint], Sequence[MultiDOFJointTrajectoryPoint]
    ] = DEFAULT
