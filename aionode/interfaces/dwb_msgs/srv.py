"""Services of dwb_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.dwb_msgs.msg import (
    CriticScore,
    LocalPlanEvaluation,
    Trajectory2D,
    TrajectoryScore,
)
from aionode.interfaces.geometry_msgs.msg import Pose2D
from aionode.interfaces.nav_2d_msgs.msg import Path2D, Pose2DStamped, Twist2D
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = [
    "DebugLocalPlan",
    "GenerateTrajectory",
    "GenerateTwists",
    "GetCriticScore",
    "ScoreTrajectory",
]


class DebugLocalPlan(ServiceType, typename="dwb_msgs/srv/DebugLocalPlan"):
    """DebugLocalPlan, as Nav2 defines it."""

    class Request(Message):
        """The request of DebugLocalPlan."""

        pose: Pose2DStamped = DEFAULT
        velocity: Twist2D = DEFAULT
        global_plan: Path2D = DEFAULT

    class Response(Message):
        """The response of DebugLocalPlan."""

        results: LocalPlanEvaluation = DEFAULT


class GenerateTrajectory(ServiceType, typename="dwb_msgs/srv/GenerateTrajectory"):
    """GenerateTrajectory, as Nav2 defines it."""

    class Request(Message):
        """The request of GenerateTrajectory."""

        start_pose: Pose2D = DEFAULT
        start_vel: Twist2D = DEFAULT
        cmd_vel: Twist2D = DEFAULT

    class Response(Message):
        """The response of GenerateTrajectory."""

        traj: Trajectory2D = DEFAULT


class GenerateTwists(ServiceType, typename="dwb_msgs/srv/GenerateTwists"):
    """GenerateTwists, as Nav2 defines it."""

    class Request(Message):
        """The request of GenerateTwists."""

        current_vel: Twist2D = DEFAULT

    class Response(Message):
        """The response of GenerateTwists."""

        twists: Annotated[list[Twist2D], Sequence[Twist2D]] = DEFAULT


class GetCriticScore(ServiceType, typename="dwb_msgs/srv/GetCriticScore"):
    """GetCriticScore, as Nav2 defines it."""

    class Request(Message):
        """The request of GetCriticScore."""

        pose: Pose2DStamped = DEFAULT
        velocity: Twist2D = DEFAULT
        global_plan: Path2D = DEFAULT
        traj: Trajectory2D = DEFAULT
        critic_name: str = ""

    class Response(Message):
        """The response of GetCriticScore."""

        score: CriticScore = DEFAULT


class ScoreTrajectory(ServiceType, typename="dwb_msgs/srv/ScoreTrajectory"):
    """ScoreTrajectory, as Nav2 defines it."""

    class Request(Message):
        """The request of ScoreTrajectory."""

        pose: Pose2DStamped = DEFAULT
        velocity: Twist2D = DEFAULT
        global_plan: Path2D = DEFAULT
        traj: Trajectory2D = DEFAULT

    class Response(Message):
        """The response of ScoreTrajectory."""

        score: TrajectoryScore = DEFAULT
