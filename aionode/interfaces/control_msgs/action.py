"""Actions of control_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.control_msgs.msg import GripperCommand as ControlMsgsGripperCommand
from aionode.interfaces.control_msgs.msg import (
    JointComponentTolerance,
    JointTolerance,
    MotionPrimitiveSequence,
)
from aionode.interfaces.geometry_msgs.msg import PointStamped, Vector3
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory as TrajectoryMsgsJointTrajectory
from aionode.interfaces.trajectory_msgs.msg import (
    JointTrajectoryPoint,
    MultiDOFJointTrajectory,
    MultiDOFJointTrajectoryPoint,
)
from aionode.message import DEFAULT, ActionType, Message, Sequence, float64, int32, uint8

__all__ = [
    "ExecuteMotionPrimitiveSequence",
    "FollowJointTrajectory",
    "GripperCommand",
    "JointTrajectory",
    "ParallelGripperCommand",
    "PointHead",
    "SingleJointPosition",
]


class ExecuteMotionPrimitiveSequence(
    ActionType, typename="control_msgs/action/ExecuteMotionPrimitiveSequence"
):
    """ExecuteMotionPrimitiveSequence, as ros-controls defines it."""

    class Goal(Message):
        """The goal of ExecuteMotionPrimitiveSequence."""

        trajectory: MotionPrimitiveSequence = DEFAULT

    class Result(Message):
        """The result of ExecuteMotionPrimitiveSequence."""

        SUCCESSFUL: ClassVar[int32] = 0
        INVALID_GOAL: ClassVar[int32] = -1
        OLD_HEADER_TIMESTAMP: ClassVar[int32] = -3

        error_code: int32 = 0
        error_string: str = ""

    class Feedback(Message):
        """The feedback of ExecuteMotionPrimitiveSequence."""

        current_primitive_index: uint8 = 0


class FollowJointTrajectory(ActionType, typename="control_msgs/action/FollowJointTrajectory"):
    """FollowJointTrajectory, as ros-controls defines it."""

    class Goal(Message):
        """The goal of FollowJointTrajectory."""

        trajectory: TrajectoryMsgsJointTrajectory = DEFAULT
        multi_dof_trajectory: MultiDOFJointTrajectory = DEFAULT
        path_tolerance: Annotated[list[JointTolerance], Sequence[JointTolerance]] = DEFAULT
        component_path_tolerance: Annotated[
            list[JointComponentTolerance], Sequence[JointComponentTolerance]
        ] = DEFAULT
        goal_tolerance: Annotated[list[JointTolerance], Sequence[JointTolerance]] = DEFAULT
        component_goal_tolerance: Annotated[
            list[JointComponentTolerance], Sequence[JointComponentTolerance]
        ] = DEFAULT
        goal_time_tolerance: Duration = DEFAULT

    class Result(Message):
        """The result of FollowJointTrajectory."""

        SUCCESSFUL: ClassVar[int32] = 0
        INVALID_GOAL: ClassVar[int32] = -1
        INVALID_JOINTS: ClassVar[int32] = -2
        OLD_HEADER_TIMESTAMP: ClassVar[int32] = -3
        PATH_TOLERANCE_VIOLATED: ClassVar[int32] = -4
        GOAL_TOLERANCE_VIOLATED: ClassVar[int32] = -5

        error_code: int32 = 0
        error_string: str = ""

    class Feedback(Message):
        """The feedback of FollowJointTrajectory."""

        header: Header = DEFAULT
        joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
        desired: JointTrajectoryPoint = DEFAULT
        actual: JointTrajectoryPoint = DEFAULT
        error: JointTrajectoryPoint = DEFAULT
        multi_dof_joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
        multi_dof_desired: MultiDOFJointTrajectoryPoint = DEFAULT
        multi_dof_actual: MultiDOFJointTrajectoryPoint = DEFAULT
        multi_dof_error: MultiDOFJointTrajectoryPoint = DEFAULT


class GripperCommand(ActionType, typename="control_msgs/action/GripperCommand"):
    """GripperCommand, as ros-controls defines it."""

    class Goal(Message):
        """The goal of GripperCommand."""

        command: ControlMsgsGripperCommand = DEFAULT

    class Result(Message):
        """The result of GripperCommand."""

        position: float64 = 0.0
        effort: float64 = 0.0
        stalled: bool = False
        reached_goal: bool = False

    class Feedback(Message):
        """The feedback of GripperCommand."""

        position: float64 = 0.0
        effort: float64 = 0.0
        stalled: bool = False
        reached_goal: bool = False


class JointTrajectory(ActionType, typename="control_msgs/action/JointTrajectory"):
    """JointTrajectory, as ros-controls defines it."""

    class Goal(Message):
        """The goal of JointTrajectory."""

        trajectory: TrajectoryMsgsJointTrajectory = DEFAULT

    class Result(Message):
        """The result of JointTrajectory."""

    class Feedback(Message):
        """The feedback of JointTrajectory."""


class ParallelGripperCommand(ActionType, typename="control_msgs/action/ParallelGripperCommand"):
    """ParallelGripperCommand, as ros-controls defines it."""

    class Goal(Message):
        """The goal of ParallelGripperCommand."""

        command: JointState = DEFAULT

    class Result(Message):
        """The result of ParallelGripperCommand."""

        state: JointState = DEFAULT
        stalled: bool = False
        reached_goal: bool = False

    class Feedback(Message):
        """The feedback of ParallelGripperCommand."""

        state: JointState = DEFAULT


class PointHead(ActionType, typename="control_msgs/action/PointHead"):
    """PointHead, as ros-controls defines it."""

    class Goal(Message):
        """The goal of PointHead."""

        target: PointStamped = DEFAULT
        pointing_axis: Vector3 = DEFAULT
        pointing_frame: str = ""
        min_duration: Duration = DEFAULT
        max_velocity: float64 = 0.0

    class Result(Message):
        """The result of PointHead."""

    class Feedback(Message):
        """The feedback of PointHead."""

        pointing_angle_error: float64 = 0.0


class SingleJointPosition(ActionType, typename="control_msgs/action/SingleJointPosition"):
    """SingleJointPosition, as ros-controls defines it."""

    class Goal(Message):
        """The goal of SingleJointPosition."""

        position: float64 = 0.0
        min_duration: Duration = DEFAULT
        max_velocity: float64 = 0.0

    class Result(Message):
        """The result of SingleJointPosition."""

    class Feedback(Message):
        """The feedback of SingleJointPosition."""

        header: Header = DEFAULT
        position: float64 = 0.0
        velocity: float64 = 0.0
        error: float64 = 0.0
