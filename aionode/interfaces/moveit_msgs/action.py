"""Actions of moveit_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.moveit_msgs.msg import (
    Constraints,
    Grasp,
    MotionPlanRequest,
    MotionPlanResponse,
    MotionSequenceRequest,
    MotionSequenceResponse,
    MoveItErrorCodes,
    PlaceLocation,
    PlanningOptions,
    RobotState,
    RobotTrajectory,
)
from aionode.message import DEFAULT, ActionType, Message, Sequence, float64

__all__ = [
    "ExecuteTrajectory",
    "GlobalPlanner",
    "HybridPlanner",
    "LocalPlanner",
    "MoveGroup",
    "MoveGroupSequence",
    "Pickup",
    "Place",
]


class ExecuteTrajectory(ActionType, typename="moveit_msgs/action/ExecuteTrajectory"):
    """ExecuteTrajectory, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of ExecuteTrajectory."""

        trajectory: RobotTrajectory = DEFAULT
        controller_names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Result(Message):
        """The result of ExecuteTrajectory."""

        error_code: MoveItErrorCodes = DEFAULT

    class Feedback(Message):
        """The feedback of ExecuteTrajectory."""

        state: str = ""


class GlobalPlanner(ActionType, typename="moveit_msgs/action/GlobalPlanner"):
    """GlobalPlanner, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of GlobalPlanner."""

        planning_group: str = ""
        motion_sequence: MotionSequenceRequest = DEFAULT

    class Result(Message):
        """The result of GlobalPlanner."""

        response: MotionPlanResponse = DEFAULT

    class Feedback(Message):
        """The feedback of GlobalPlanner."""

        feedback: str = ""


class HybridPlanner(ActionType, typename="moveit_msgs/action/HybridPlanner"):
    """HybridPlanner, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of HybridPlanner."""

        planning_group: str = ""
        motion_sequence: MotionSequenceRequest = DEFAULT

    class Result(Message):
        """The result of HybridPlanner."""

        error_code: MoveItErrorCodes = DEFAULT
        error_message: str = ""

    class Feedback(Message):
        """The feedback of HybridPlanner."""

        feedback: str = ""


class LocalPlanner(ActionType, typename="moveit_msgs/action/LocalPlanner"):
    """LocalPlanner, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of LocalPlanner."""

        local_constraints: Annotated[list[Constraints], Sequence[Constraints]] = DEFAULT

    class Result(Message):
        """The result of LocalPlanner."""

        error_code: MoveItErrorCodes = DEFAULT
        error_message: str = ""

    class Feedback(Message):
        """The feedback of LocalPlanner."""

        feedback: str = ""


class MoveGroup(ActionType, typename="moveit_msgs/action/MoveGroup"):
    """MoveGroup, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of MoveGroup."""

        request: MotionPlanRequest = DEFAULT
        planning_options: PlanningOptions = DEFAULT

    class Result(Message):
        """The result of MoveGroup."""

        error_code: MoveItErrorCodes = DEFAULT
        trajectory_start: RobotState = DEFAULT
        planned_trajectory: RobotTrajectory = DEFAULT
        executed_trajectory: RobotTrajectory = DEFAULT
        planning_time: float64 = 0.0

    class Feedback(Message):
        """The feedback of MoveGroup."""

        state: str = ""


class MoveGroupSequence(ActionType, typename="moveit_msgs/action/MoveGroupSequence"):
    """MoveGroupSequence, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of MoveGroupSequence."""

        request: MotionSequenceRequest = DEFAULT
        planning_options: PlanningOptions = DEFAULT

    class Result(Message):
        """The result of MoveGroupSequence."""

        response: MotionSequenceResponse = DEFAULT

    class Feedback(Message):
        """The feedback of MoveGroupSequence."""

        state: str = ""


class Pickup(ActionType, typename="moveit_msgs/action/Pickup"):
    """Pickup, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of Pickup."""

        target_name: str = ""
        group_name: str = ""
        end_effector: str = ""
        possible_grasps: Annotated[list[Grasp], Sequence[Grasp]] = DEFAULT
        support_surface_name: str = ""
        allow_gripper_support_collision: bool = False
        attached_object_touch_links: Annotated[list[str], Sequence[str]] = DEFAULT
        minimize_object_distance: bool = False
        path_constraints: Constraints = DEFAULT
        planner_id: str = ""
        allowed_touch_objects: Annotated[list[str], Sequence[str]] = DEFAULT
        allowed_planning_time: float64 = 0.0
        planning_options: PlanningOptions = DEFAULT

    class Result(Message):
        """The result of Pickup."""

        error_code: MoveItErrorCodes = DEFAULT
        trajectory_start: RobotState = DEFAULT
        trajectory_stages: Annotated[list[RobotTrajectory], Sequence[RobotTrajectory]] = DEFAULT
        trajectory_descriptions: Annotated[list[str], Sequence[str]] = DEFAULT
        grasp: Grasp = DEFAULT
        planning_time: float64 = 0.0

    class Feedback(Message):
        """The feedback of Pickup."""

        state: str = ""


class Place(ActionType, typename="moveit_msgs/action/Place"):
    """Place, as MoveIt 2 defines it."""

    class Goal(Message):
        """The goal of Place."""

        group_name: str = ""
        attached_object_name: str = ""
        place_locations: Annotated[list[PlaceLocation], Sequence[PlaceLocation]] = DEFAULT
        place_eef: bool = False
        support_surface_name: str = ""
        allow_gripper_support_collision: bool = False
        path_constraints: Constraints = DEFAULT
        planner_id: str = ""
        allowed_touch_objects: Annotated[list[str], Sequence[str]] = DEFAULT
        allowed_planning_time: float64 = 0.0
        planning_options: PlanningOptions = DEFAULT

    class Result(Message):
        """The result of Place."""

        error_code: MoveItErrorCodes = DEFAULT
        trajectory_start: RobotState = DEFAULT
        trajectory_stages: Annotated[list[RobotTrajectory], Sequence[RobotTrajectory]] = DEFAULT
        trajectory_descriptions: Annotated[list[str], Sequence[str]] = DEFAULT
        place_location: PlaceLocation = DEFAULT
        planning_time: float64 = 0.0

    class Feedback(Message):
        """The feedback of Place."""

        state: str = ""
