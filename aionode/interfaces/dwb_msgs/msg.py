"""Messages of dwb_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geometry_msgs.msg import Pose2D
from aionode.interfaces.nav_2d_msgs.msg import Twist2D
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, float32, uint16

__all__ = ["CriticScore", "LocalPlanEvaluation", "Trajectory2D", "TrajectoryScore"]


class CriticScore(Message, typename="dwb_msgs/msg/CriticScore"):
    """CriticScore, as Nav2 defines it."""

    name: str = ""
    raw_score: float32 = 0.0
    scale: float32 = 0.0


class Trajectory2D(Message, typename="dwb_msgs/msg/Trajectory2D"):
    """Trajectory2D, as Nav2 defines it."""

    velocity: Twist2D = DEFAULT
    time_offsets: Annotated[list[Duration], Sequence[Duration]] = DEFAULT
    poses: Annotated[list[Pose2D], Sequence[Pose2D]] = DEFAULT


class TrajectoryScore(Message, typename="dwb_msgs/msg/TrajectoryScore"):
    """TrajectoryScore, as Nav2 defines it."""

    traj: Trajectory2D = DEFAULT
    scores: Annotated[list[CriticScore], Sequence[CriticScore]] = DEFAULT
    total: float32 = 0.0


class LocalPlanEvaluation(Message, typename="dwb_msgs/msg/LocalPlanEvaluation"):
    """LocalPlanEvaluation, as Nav2 defines it."""

    header: Header = DEFAULT
    twists: Annotated[list[TrajectoryScore], Sequence[TrajectoryScore]] = DEFAULT
    best_index: uint16 = 0
    worst_index: uint16 = 0
