"""Actions of nav2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geographic_msgs.msg import GeoPose
from aionode.interfaces.geometry_msgs.msg import Point, PoseStamped
from aionode.interfaces.nav2_msgs.msg import MissedWaypoint, Route
from aionode.interfaces.nav_msgs.msg import Path
from aionode.interfaces.std_msgs.msg import Empty, String
from aionode.message import DEFAULT, ActionType, Message, Sequence, float32, int16, uint16, uint32

__all__ = [
    "AssistedTeleop",
    "BackUp",
    "ComputeAndTrackRoute",
    "ComputePathThroughPoses",
    "ComputePathToPose",
    "ComputeRoute",
    "DockRobot",
    "DriveOnHeading",
    "DummyBehavior",
    "FollowGPSWaypoints",
    "FollowObject",
    "FollowPath",
    "FollowWaypoints",
    "NavigateThroughPoses",
    "NavigateToPose",
    "SmoothPath",
    "Spin",
    "UndockRobot",
    "Wait",
]


class AssistedTeleop(ActionType, typename="nav2_msgs/action/AssistedTeleop"):
    """AssistedTeleop, as Nav2 defines it."""

    class Goal(Message):
        """The goal of AssistedTeleop."""

        time_allowance: Duration = DEFAULT

    class Result(Message):
        """The result of AssistedTeleop."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 730
        TIMEOUT: ClassVar[uint16] = 731
        TF_ERROR: ClassVar[uint16] = 732

        total_elapsed_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of AssistedTeleop."""

        current_teleop_duration: Duration = DEFAULT


class BackUp(ActionType, typename="nav2_msgs/action/BackUp"):
    """BackUp, as Nav2 defines it."""

    class Goal(Message):
        """The goal of BackUp."""

        target: Point = DEFAULT
        speed: float32 = 0.0
        time_allowance: Duration = DEFAULT

    class Result(Message):
        """The result of BackUp."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 710
        TIMEOUT: ClassVar[uint16] = 711
        TF_ERROR: ClassVar[uint16] = 712
        INVALID_INPUT: ClassVar[uint16] = 713
        COLLISION_AHEAD: ClassVar[uint16] = 714

        total_elapsed_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of BackUp."""

        distance_traveled: float32 = 0.0


class ComputeAndTrackRoute(ActionType, typename="nav2_msgs/action/ComputeAndTrackRoute"):
    """ComputeAndTrackRoute, as Nav2 defines it."""

    class Goal(Message):
        """The goal of ComputeAndTrackRoute."""

        start_id: uint16 = 0
        start: PoseStamped = DEFAULT
        goal_id: uint16 = 0
        goal: PoseStamped = DEFAULT
        use_start: bool = False
        use_poses: bool = False

    class Result(Message):
        """The result of ComputeAndTrackRoute."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 400
        TF_ERROR: ClassVar[uint16] = 401
        NO_VALID_GRAPH: ClassVar[uint16] = 402
        INDETERMINANT_NODES_ON_GRAPH: ClassVar[uint16] = 403
        TIMEOUT: ClassVar[uint16] = 404
        NO_VALID_ROUTE: ClassVar[uint16] = 405
        OPERATION_FAILED: ClassVar[uint16] = 406
        INVALID_EDGE_SCORER_USE: ClassVar[uint16] = 407

        execution_duration: Duration = DEFAULT
        error_code: uint16 = 0

    class Feedback(Message):
        """The feedback of ComputeAndTrackRoute."""

        last_node_id: uint16 = 0
        next_node_id: uint16 = 0
        current_edge_id: uint16 = 0
        route: Route = DEFAULT
        path: Path = DEFAULT
        operations_triggered: Annotated[list[str], Sequence[str]] = DEFAULT
        rerouted: bool = False


class ComputePathThroughPoses(ActionType, typename="nav2_msgs/action/ComputePathThroughPoses"):
    """ComputePathThroughPoses, as Nav2 defines it."""

    class Goal(Message):
        """The goal of ComputePathThroughPoses."""

        goals: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT
        start: PoseStamped = DEFAULT
        planner_id: str = ""
        use_start: bool = False

    class Result(Message):
        """The result of ComputePathThroughPoses."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 300
        INVALID_PLANNER: ClassVar[uint16] = 301
        TF_ERROR: ClassVar[uint16] = 302
        START_OUTSIDE_MAP: ClassVar[uint16] = 303
        GOAL_OUTSIDE_MAP: ClassVar[uint16] = 304
        START_OCCUPIED: ClassVar[uint16] = 305
        GOAL_OCCUPIED: ClassVar[uint16] = 306
        TIMEOUT: ClassVar[uint16] = 307
        NO_VALID_PATH: ClassVar[uint16] = 308
        NO_VIAPOINTS_GIVEN: ClassVar[uint16] = 309

        path: Path = DEFAULT
        planning_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of ComputePathThroughPoses."""


class ComputePathToPose(ActionType, typename="nav2_msgs/action/ComputePathToPose"):
    """ComputePathToPose, as Nav2 defines it."""

    class Goal(Message):
        """The goal of ComputePathToPose."""

        goal: PoseStamped = DEFAULT
        start: PoseStamped = DEFAULT
        planner_id: str = ""
        use_start: bool = False

    class Result(Message):
        """The result of ComputePathToPose."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 200
        INVALID_PLANNER: ClassVar[uint16] = 201
        TF_ERROR: ClassVar[uint16] = 202
        START_OUTSIDE_MAP: ClassVar[uint16] = 203
        GOAL_OUTSIDE_MAP: ClassVar[uint16] = 204
        START_OCCUPIED: ClassVar[uint16] = 205
        GOAL_OCCUPIED: ClassVar[uint16] = 206
        TIMEOUT: ClassVar[uint16] = 207
        NO_VALID_PATH: ClassVar[uint16] = 208

        path: Path = DEFAULT
        planning_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of ComputePathToPose."""


class ComputeRoute(ActionType, typename="nav2_msgs/action/ComputeRoute"):
    """ComputeRoute, as Nav2 defines it."""

    class Goal(Message):
        """The goal of ComputeRoute."""

        start_id: uint16 = 0
        start: PoseStamped = DEFAULT
        goal_id: uint16 = 0
        goal: PoseStamped = DEFAULT
        use_start: bool = False
        use_poses: bool = False

    class Result(Message):
        """The result of ComputeRoute."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 400
        TF_ERROR: ClassVar[uint16] = 401
        NO_VALID_GRAPH: ClassVar[uint16] = 402
        INDETERMINANT_NODES_ON_GRAPH: ClassVar[uint16] = 403
        TIMEOUT: ClassVar[uint16] = 404
        NO_VALID_ROUTE: ClassVar[uint16] = 405
        INVALID_EDGE_SCORER_USE: ClassVar[uint16] = 407

        planning_time: Duration = DEFAULT
        path: Path = DEFAULT
        route: Route = DEFAULT
        error_code: uint16 = 0

    class Feedback(Message):
        """The feedback of ComputeRoute."""


class DockRobot(ActionType, typename="nav2_msgs/action/DockRobot"):
    """DockRobot, as Nav2 defines it."""

    class Goal(Message):
        """The goal of DockRobot."""

        use_dock_id: bool = True
        dock_id: str = ""
        dock_pose: PoseStamped = DEFAULT
        dock_type: str = ""
        max_staging_time: float32 = 1000.0
        navigate_to_staging_pose: bool = True

    class Result(Message):
        """The result of DockRobot."""

        NONE: ClassVar[uint16] = 0
        DOCK_NOT_IN_DB: ClassVar[uint16] = 901
        DOCK_NOT_VALID: ClassVar[uint16] = 902
        FAILED_TO_STAGE: ClassVar[uint16] = 903
        FAILED_TO_DETECT_DOCK: ClassVar[uint16] = 904
        FAILED_TO_CONTROL: ClassVar[uint16] = 905
        FAILED_TO_CHARGE: ClassVar[uint16] = 906
        UNKNOWN: ClassVar[uint16] = 999

        success: bool = True
        error_code: uint16 = 0
        num_retries: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of DockRobot."""

        NONE: ClassVar[uint16] = 0
        NAV_TO_STAGING_POSE: ClassVar[uint16] = 1
        INITIAL_PERCEPTION: ClassVar[uint16] = 2
        CONTROLLING: ClassVar[uint16] = 3
        WAIT_FOR_CHARGE: ClassVar[uint16] = 4
        RETRY: ClassVar[uint16] = 5

        state: uint16 = 0
        docking_time: Duration = DEFAULT
        num_retries: uint16 = 0


class DriveOnHeading(ActionType, typename="nav2_msgs/action/DriveOnHeading"):
    """DriveOnHeading, as Nav2 defines it."""

    class Goal(Message):
        """The goal of DriveOnHeading."""

        target: Point = DEFAULT
        speed: float32 = 0.0
        time_allowance: Duration = DEFAULT

    class Result(Message):
        """The result of DriveOnHeading."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 720
        TIMEOUT: ClassVar[uint16] = 721
        TF_ERROR: ClassVar[uint16] = 722
        COLLISION_AHEAD: ClassVar[uint16] = 723
        INVALID_INPUT: ClassVar[uint16] = 724

        total_elapsed_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of DriveOnHeading."""

        distance_traveled: float32 = 0.0


class DummyBehavior(ActionType, typename="nav2_msgs/action/DummyBehavior"):
    """DummyBehavior, as Nav2 defines it."""

    class Goal(Message):
        """The goal of DummyBehavior."""

        command: String = DEFAULT

    class Result(Message):
        """The result of DummyBehavior."""

        total_elapsed_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of DummyBehavior."""


class FollowGPSWaypoints(ActionType, typename="nav2_msgs/action/FollowGPSWaypoints"):
    """FollowGPSWaypoints, as Nav2 defines it."""

    class Goal(Message):
        """The goal of FollowGPSWaypoints."""

        number_of_loops: uint32 = 0
        goal_index: uint32 = 0
        gps_poses: Annotated[list[GeoPose], Sequence[GeoPose]] = DEFAULT

    class Result(Message):
        """The result of FollowGPSWaypoints."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 600
        TASK_EXECUTOR_FAILED: ClassVar[uint16] = 601

        missed_waypoints: Annotated[list[MissedWaypoint], Sequence[MissedWaypoint]] = DEFAULT
        error_code: int16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of FollowGPSWaypoints."""

        current_waypoint: uint32 = 0


class FollowObject(ActionType, typename="nav2_msgs/action/FollowObject"):
    """FollowObject, as Nav2 defines it."""

    class Goal(Message):
        """The goal of FollowObject."""

        pose_topic: str = ""
        tracked_frame: str = ""
        max_duration: Duration = DEFAULT

    class Result(Message):
        """The result of FollowObject."""

        NONE: ClassVar[uint16] = 0
        TF_ERROR: ClassVar[uint16] = 901
        FAILED_TO_DETECT_OBJECT: ClassVar[uint16] = 902
        FAILED_TO_CONTROL: ClassVar[uint16] = 903
        TIMEOUT: ClassVar[uint16] = 904
        UNKNOWN: ClassVar[uint16] = 999

        total_elapsed_time: Duration = DEFAULT
        error_code: uint16 = 0
        num_retries: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of FollowObject."""

        NONE: ClassVar[uint16] = 0
        INITIAL_PERCEPTION: ClassVar[uint16] = 1
        CONTROLLING: ClassVar[uint16] = 2
        STOPPING: ClassVar[uint16] = 3
        RETRY: ClassVar[uint16] = 4

        state: uint16 = 0
        following_time: Duration = DEFAULT
        num_retries: uint16 = 0


class FollowPath(ActionType, typename="nav2_msgs/action/FollowPath"):
    """FollowPath, as Nav2 defines it."""

    class Goal(Message):
        """The goal of FollowPath."""

        path: Path = DEFAULT
        controller_id: str = ""
        goal_checker_id: str = ""
        progress_checker_id: str = ""

    class Result(Message):
        """The result of FollowPath."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 100
        INVALID_CONTROLLER: ClassVar[uint16] = 101
        TF_ERROR: ClassVar[uint16] = 102
        INVALID_PATH: ClassVar[uint16] = 103
        PATIENCE_EXCEEDED: ClassVar[uint16] = 104
        FAILED_TO_MAKE_PROGRESS: ClassVar[uint16] = 105
        NO_VALID_CONTROL: ClassVar[uint16] = 106
        CONTROLLER_TIMED_OUT: ClassVar[uint16] = 107

        result: Empty = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of FollowPath."""

        distance_to_goal: float32 = 0.0
        speed: float32 = 0.0


class FollowWaypoints(ActionType, typename="nav2_msgs/action/FollowWaypoints"):
    """FollowWaypoints, as Nav2 defines it."""

    class Goal(Message):
        """The goal of FollowWaypoints."""

        number_of_loops: uint32 = 0
        goal_index: uint32 = 0
        poses: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT

    class Result(Message):
        """The result of FollowWaypoints."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 600
        TASK_EXECUTOR_FAILED: ClassVar[uint16] = 601

        missed_waypoints: Annotated[list[MissedWaypoint], Sequence[MissedWaypoint]] = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of FollowWaypoints."""

        current_waypoint: uint32 = 0


class NavigateThroughPoses(ActionType, typename="nav2_msgs/action/NavigateThroughPoses"):
    """NavigateThroughPoses, as Nav2 defines it."""

    class Goal(Message):
        """The goal of NavigateThroughPoses."""

        poses: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT
        behavior_tree: str = ""

    class Result(Message):
        """The result of NavigateThroughPoses."""

        NONE: ClassVar[uint16] = 0

        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of NavigateThroughPoses."""

        current_pose: PoseStamped = DEFAULT
        navigation_time: Duration = DEFAULT
        estimated_time_remaining: Duration = DEFAULT
        number_of_recoveries: int16 = 0
        distance_remaining: float32 = 0.0
        number_of_poses_remaining: int16 = 0


class NavigateToPose(ActionType, typename="nav2_msgs/action/NavigateToPose"):
    """NavigateToPose, as Nav2 defines it."""

    class Goal(Message):
        """The goal of NavigateToPose."""

        pose: PoseStamped = DEFAULT
        behavior_tree: str = ""

    class Result(Message):
        """The result of NavigateToPose."""

        NONE: ClassVar[uint16] = 0

        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of NavigateToPose."""

        current_pose: PoseStamped = DEFAULT
        navigation_time: Duration = DEFAULT
        estimated_time_remaining: Duration = DEFAULT
        number_of_recoveries: int16 = 0
        distance_remaining: float32 = 0.0


class SmoothPath(ActionType, typename="nav2_msgs/action/SmoothPath"):
    """SmoothPath, as Nav2 defines it."""

    class Goal(Message):
        """The goal of SmoothPath."""

        path: Path = DEFAULT
        smoother_id: str = ""
        max_smoothing_duration: Duration = DEFAULT
        check_for_collisions: bool = False

    class Result(Message):
        """The result of SmoothPath."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 500
        INVALID_SMOOTHER: ClassVar[uint16] = 501
        TIMEOUT: ClassVar[uint16] = 502
        SMOOTHED_PATH_IN_COLLISION: ClassVar[uint16] = 503
        FAILED_TO_SMOOTH_PATH: ClassVar[uint16] = 504
        INVALID_PATH: ClassVar[uint16] = 505

        path: Path = DEFAULT
        smoothing_duration: Duration = DEFAULT
        was_completed: bool = False
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of SmoothPath."""


class Spin(ActionType, typename="nav2_msgs/action/Spin"):
    """Spin, as Nav2 defines it."""

    class Goal(Message):
        """The goal of Spin."""

        target_yaw: float32 = 0.0
        time_allowance: Duration = DEFAULT

    class Result(Message):
        """The result of Spin."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 700
        TIMEOUT: ClassVar[uint16] = 701
        TF_ERROR: ClassVar[uint16] = 702
        COLLISION_AHEAD: ClassVar[uint16] = 703

        total_elapsed_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of Spin."""

        angular_distance_traveled: float32 = 0.0


class UndockRobot(ActionType, typename="nav2_msgs/action/UndockRobot"):
    """UndockRobot, as Nav2 defines it."""

    class Goal(Message):
        """The goal of UndockRobot."""

        dock_type: str = ""
        max_undocking_time: float32 = 30.0

    class Result(Message):
        """The result of UndockRobot."""

        NONE: ClassVar[uint16] = 0
        DOCK_NOT_VALID: ClassVar[uint16] = 902
        FAILED_TO_CONTROL: ClassVar[uint16] = 905
        UNKNOWN: ClassVar[uint16] = 999

        success: bool = True
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of UndockRobot."""


class Wait(ActionType, typename="nav2_msgs/action/Wait"):
    """Wait, as Nav2 defines it."""

    class Goal(Message):
        """The goal of Wait."""

        time: Duration = DEFAULT

    class Result(Message):
        """The result of Wait."""

        total_elapsed_time: Duration = DEFAULT
        error_code: uint16 = 0
        error_msg: str = ""

    class Feedback(Message):
        """The feedback of Wait."""

        time_left: Duration = DEFAULT
