"""Services of moveit_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Pose, PoseStamped
from aionode.interfaces.moveit_msgs.msg import (
    CollisionObject,
    ConstraintEvalResult,
    Constraints,
    ContactInformation,
    CostSource,
    Grasp,
    MotionPlanRequest,
    MotionPlanResponse,
    MotionSequenceRequest,
    MotionSequenceResponse,
    MoveItErrorCodes,
    PlannerInterfaceDescription,
    PlannerParams,
    PlanningScene,
    PlanningSceneComponents,
    PositionIKRequest,
    RobotState,
    RobotTrajectory,
)
from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, ServiceType, float64, int8

__all__ = [
    "ApplyPlanningScene",
    "CheckIfRobotStateExistsInWarehouse",
    "DeleteRobotStateFromWarehouse",
    "GetCartesianPath",
    "GetGroupUrdf",
    "GetMotionPlan",
    "GetMotionSequence",
    "GetPlannerParams",
    "GetPlanningScene",
    "GetPositionFK",
    "GetPositionIK",
    "GetRobotStateFromWarehouse",
    "GetStateValidity",
    "GraspPlanning",
    "ListRobotStatesInWarehouse",
    "LoadGeometryFromFile",
    "LoadMap",
    "QueryPlannerInterfaces",
    "RenameRobotStateInWarehouse",
    "SaveGeometryToFile",
    "SaveMap",
    "SaveRobotStateToWarehouse",
    "ServoCommandType",
    "SetPlannerParams",
    "UpdatePointcloudOctomap",
]


class ApplyPlanningScene(ServiceType, typename="moveit_msgs/srv/ApplyPlanningScene"):
    """ApplyPlanningScene, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of ApplyPlanningScene."""

        scene: PlanningScene = DEFAULT

    class Response(Message):
        """The response of ApplyPlanningScene."""

        success: bool = False


class CheckIfRobotStateExistsInWarehouse(
    ServiceType, typename="moveit_msgs/srv/CheckIfRobotStateExistsInWarehouse"
):
    """CheckIfRobotStateExistsInWarehouse, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of CheckIfRobotStateExistsInWarehouse."""

        name: str = ""
        robot: str = ""

    class Response(Message):
        """The response of CheckIfRobotStateExistsInWarehouse."""

        exists: bool = False


class DeleteRobotStateFromWarehouse(
    ServiceType, typename="moveit_msgs/srv/DeleteRobotStateFromWarehouse"
):
    """DeleteRobotStateFromWarehouse, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of DeleteRobotStateFromWarehouse."""

        name: str = ""
        robot: str = ""

    class Response(Message):
        """The response of DeleteRobotStateFromWarehouse."""


class GetCartesianPath(ServiceType, typename="moveit_msgs/srv/GetCartesianPath"):
    """GetCartesianPath, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetCartesianPath."""

        header: Header = DEFAULT
        start_state: RobotState = DEFAULT
        group_name: str = ""
        link_name: str = ""
        waypoints: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
        max_step: float64 = 0.0
        jump_threshold: float64 = 0.0
        prismatic_jump_threshold: float64 = 0.0
        revolute_jump_threshold: float64 = 0.0
        avoid_collisions: bool = False
        path_constraints: Constraints = DEFAULT
        max_velocity_scaling_factor: float64 = 0.0
        max_acceleration_scaling_factor: float64 = 0.0
        cartesian_speed_limited_link: str = ""
        max_cartesian_speed: float64 = 0.0

    class Response(Message):
        """The response of GetCartesianPath."""

        start_state: RobotState = DEFAULT
        solution: RobotTrajectory = DEFAULT
        fraction: float64 = 0.0
        error_code: MoveItErrorCodes = DEFAULT


class GetGroupUrdf(ServiceType, typename="moveit_msgs/srv/GetGroupUrdf"):
    """GetGroupUrdf, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetGroupUrdf."""

        group_name: str = ""

    class Response(Message):
        """The response of GetGroupUrdf."""

        error_code: MoveItErrorCodes = DEFAULT
        urdf_string: str = ""


class GetMotionPlan(ServiceType, typename="moveit_msgs/srv/GetMotionPlan"):
    """GetMotionPlan, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetMotionPlan."""

        motion_plan_request: MotionPlanRequest = DEFAULT

    class Response(Message):
        """The response of GetMotionPlan."""

        motion_plan_response: MotionPlanResponse = DEFAULT


class GetMotionSequence(ServiceType, typename="moveit_msgs/srv/GetMotionSequence"):
    """GetMotionSequence, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetMotionSequence."""

        request: MotionSequenceRequest = DEFAULT

    class Response(Message):
        """The response of GetMotionSequence."""

        response: MotionSequenceResponse = DEFAULT


class GetPlannerParams(ServiceType, typename="moveit_msgs/srv/GetPlannerParams"):
    """GetPlannerParams, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetPlannerParams."""

        pipeline_id: str = ""
        planner_config: str = ""
        group: str = ""

    class Response(Message):
        """The response of GetPlannerParams."""

        params: PlannerParams = DEFAULT


class GetPlanningScene(ServiceType, typename="moveit_msgs/srv/GetPlanningScene"):
    """GetPlanningScene, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetPlanningScene."""

        components: PlanningSceneComponents = DEFAULT

    class Response(Message):
        """The response of GetPlanningScene."""

        scene: PlanningScene = DEFAULT


class GetPositionFK(ServiceType, typename="moveit_msgs/srv/GetPositionFK"):
    """GetPositionFK, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetPositionFK."""

        header: Header = DEFAULT
        fk_link_names: Annotated[list[str], Sequence[str]] = DEFAULT
        robot_state: RobotState = DEFAULT

    class Response(Message):
        """The response of GetPositionFK."""

        pose_stamped: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT
        fk_link_names: Annotated[list[str], Sequence[str]] = DEFAULT
        error_code: MoveItErrorCodes = DEFAULT


class GetPositionIK(ServiceType, typename="moveit_msgs/srv/GetPositionIK"):
    """GetPositionIK, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetPositionIK."""

        ik_request: PositionIKRequest = DEFAULT

    class Response(Message):
        """The response of GetPositionIK."""

        solution: RobotState = DEFAULT
        error_code: MoveItErrorCodes = DEFAULT


class GetRobotStateFromWarehouse(
    ServiceType, typename="moveit_msgs/srv/GetRobotStateFromWarehouse"
):
    """GetRobotStateFromWarehouse, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetRobotStateFromWarehouse."""

        name: str = ""
        robot: str = ""

    class Response(Message):
        """The response of GetRobotStateFromWarehouse."""

        state: RobotState = DEFAULT


class GetStateValidity(ServiceType, typename="moveit_msgs/srv/GetStateValidity"):
    """GetStateValidity, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GetStateValidity."""

        robot_state: RobotState = DEFAULT
        group_name: str = ""
        constraints: Constraints = DEFAULT

    class Response(Message):
        """The response of GetStateValidity."""

        valid: bool = False
        contacts: Annotated[list[ContactInformation], Sequence[ContactInformation]] = DEFAULT
        cost_sources: Annotated[list[CostSource], Sequence[CostSource]] = DEFAULT
        constraint_result: Annotated[list[ConstraintEvalResult], Sequence[ConstraintEvalResult]] = (
            DEFAULT
        )


class GraspPlanning(ServiceType, typename="moveit_msgs/srv/GraspPlanning"):
    """GraspPlanning, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of GraspPlanning."""

        group_name: str = ""
        target: CollisionObject = DEFAULT
        support_surfaces: Annotated[list[str], Sequence[str]] = DEFAULT
        candidate_grasps: Annotated[list[Grasp], Sequence[Grasp]] = DEFAULT
        movable_obstacles: Annotated[list[CollisionObject], Sequence[CollisionObject]] = DEFAULT

    class Response(Message):
        """The response of GraspPlanning."""

        grasps: Annotated[list[Grasp], Sequence[Grasp]] = DEFAULT
        error_code: MoveItErrorCodes = DEFAULT


class ListRobotStatesInWarehouse(
    ServiceType, typename="moveit_msgs/srv/ListRobotStatesInWarehouse"
):
    """ListRobotStatesInWarehouse, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of ListRobotStatesInWarehouse."""

        regex: str = ""
        robot: str = ""

    class Response(Message):
        """The response of ListRobotStatesInWarehouse."""

        states: Annotated[list[str], Sequence[str]] = DEFAULT


class LoadGeometryFromFile(ServiceType, typename="moveit_msgs/srv/LoadGeometryFromFile"):
    """LoadGeometryFromFile, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of LoadGeometryFromFile."""

        file_path_and_name: str = ""

    class Response(Message):
        """The response of LoadGeometryFromFile."""

        success: bool = False


class LoadMap(ServiceType, typename="moveit_msgs/srv/LoadMap"):
    """LoadMap, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of LoadMap."""

        filename: str = ""

    class Response(Message):
        """The response of LoadMap."""

        success: bool = False


class QueryPlannerInterfaces(ServiceType, typename="moveit_msgs/srv/QueryPlannerInterfaces"):
    """QueryPlannerInterfaces, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of QueryPlannerInterfaces."""

    class Response(Message):
        """The response of QueryPlannerInterfaces."""

        planner_interfaces: Annotated[
            list[PlannerInterfaceDescription], Sequence[PlannerInterfaceDescription]
        ] = DEFAULT


class RenameRobotStateInWarehouse(
    ServiceType, typename="moveit_msgs/srv/RenameRobotStateInWarehouse"
):
    """RenameRobotStateInWarehouse, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of RenameRobotStateInWarehouse."""

        old_name: str = ""
        new_name: str = ""
        robot: str = ""

    class Response(Message):
        """The response of RenameRobotStateInWarehouse."""


class SaveGeometryToFile(ServiceType, typename="moveit_msgs/srv/SaveGeometryToFile"):
    """SaveGeometryToFile, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of SaveGeometryToFile."""

        file_path_and_name: str = ""

    class Response(Message):
        """The response of SaveGeometryToFile."""

        success: bool = False


class SaveMap(ServiceType, typename="moveit_msgs/srv/SaveMap"):
    """SaveMap, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of SaveMap."""

        filename: str = ""

    class Response(Message):
        """The response of SaveMap."""

        success: bool = False


class SaveRobotStateToWarehouse(ServiceType, typename="moveit_msgs/srv/SaveRobotStateToWarehouse"):
    """SaveRobotStateToWarehouse, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of SaveRobotStateToWarehouse."""

        name: str = ""
        robot: str = ""
        state: RobotState = DEFAULT

    class Response(Message):
        """The response of SaveRobotStateToWarehouse."""

        success: bool = False


class ServoCommandType(ServiceType, typename="moveit_msgs/srv/ServoCommandType"):
    """ServoCommandType, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of ServoCommandType."""

        JOINT_JOG: ClassVar[int8] = 0
        TWIST: ClassVar[int8] = 1
        POSE: ClassVar[int8] = 2

        command_type: int8 = 0

    class Response(Message):
        """The response of ServoCommandType."""

        success: bool = False


class SetPlannerParams(ServiceType, typename="moveit_msgs/srv/SetPlannerParams"):
    """SetPlannerParams, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of SetPlannerParams."""

        pipeline_id: str = ""
        planner_config: str = ""
        group: str = ""
        params: PlannerParams = DEFAULT
        replace: bool = False

    class Response(Message):
        """The response of SetPlannerParams."""


class UpdatePointcloudOctomap(ServiceType, typename="moveit_msgs/srv/UpdatePointcloudOctomap"):
    """UpdatePointcloudOctomap, as MoveIt 2 defines it."""

    class Request(Message):
        """The request of UpdatePointcloudOctomap."""

        cloud: PointCloud2 = DEFAULT

    class Response(Message):
        """The response of UpdatePointcloudOctomap."""

        success: bool = False
