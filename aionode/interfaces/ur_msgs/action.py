"""Actions of ur_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.control_msgs.msg import JointTolerance
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from aionode.message import DEFAULT, ActionType, Message, Sequence, int32, uint8

__all__ = ["FollowJointTrajectoryUntil", "ToolContact"]


class FollowJointTrajectoryUntil(ActionType, typename="ur_msgs/action/FollowJointTrajectoryUntil"):
    """FollowJointTrajectoryUntil, as Universal Robots defines it."""

    class Goal(Message):
        """The goal of FollowJointTrajectoryUntil."""

        TOOL_CONTACT: ClassVar[uint8] = 0

        trajectory: JointTrajectory = DEFAULT
        path_tolerance: Annotated[list[JointTolerance], Sequence[JointTolerance]] = DEFAULT
        goal_tolerance: Annotated[list[JointTolerance], Sequence[JointTolerance]] = DEFAULT
        goal_time_tolerance: Duration = DEFAULT
        until_type: uint8 = 0

    class Result(Message):
        """The result of FollowJointTrajectoryUntil."""

        SUCCESSFUL: ClassVar[int32] = 0
        INVALID_GOAL: ClassVar[int32] = -1
        INVALID_JOINTS: ClassVar[int32] = -2
        OLD_HEADER_TIMESTAMP: ClassVar[int32] = -3
        PATH_TOLERANCE_VIOLATED: ClassVar[int32] = -4
        GOAL_TOLERANCE_VIOLATED: ClassVar[int32] = -5
        TRIGGERED: ClassVar[int32] = 0
        NOT_TRIGGERED: ClassVar[int32] = 1

        error_code: int32 = 0
        until_condition_result: int32 = 0
        error_string: str = ""

    class Feedback(Message):
        """The feedback of FollowJointTrajectoryUntil."""

        header: Header = DEFAULT
        joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
        desired: JointTrajectoryPoint = DEFAULT
        actual: JointTrajectoryPoint = DEFAULT
        error: JointTrajectoryPoint = DEFAULT


class ToolContact(ActionType, typename="ur_msgs/action/ToolContact"):
    """ToolContact, as Universal Robots defines it."""

    class Goal(Message):
        """The goal of ToolContact."""

    class Result(Message):
        """The result of ToolContact."""

    class Feedback(Message):
        """The feedback of ToolContact."""
