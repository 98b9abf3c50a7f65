"""Messages of moveit_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geometry_msgs.msg import (
    Accel,
    Point,
    Point32,
    Pose,
    PoseStamped,
    Quaternion,
    TransformStamped,
    Twist,
    Vector3,
    Vector3Stamped,
)
from aionode.interfaces.object_recognition_msgs.msg import ObjectType
from aionode.interfaces.octomap_msgs.msg import OctomapWithPose
from aionode.interfaces.sensor_msgs.msg import JointState, MultiDOFJointState
from aionode.interfaces.shape_msgs.msg import Mesh, Plane, SolidPrimitive
from aionode.interfaces.std_msgs.msg import ColorRGBA, Header
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory
from aionode.message import (
    DEFAULT,
    Bools,
    Floats,
    Message,
    Sequence,
    byte,
    float32,
    float64,
    int8,
    int32,
    uint8,
    uint32,
)

__all__ = [
    "AllowedCollisionEntry",
    "AllowedCollisionMatrix",
    "AttachedCollisionObject",
    "BoundingVolume",
    "CartesianPoint",
    "CartesianTrajectory",
    "CartesianTrajectoryPoint",
    "CollisionObject",
    "ConstraintEvalResult",
    "Constraints",
    "ContactInformation",
    "CostSource",
    "DisplayRobotState",
    "DisplayTrajectory",
    "GenericTrajectory",
    "Grasp",
    "GripperTranslation",
    "JointConstraint",
    "JointLimits",
    "KinematicSolverInfo",
    "LinkPadding",
    "LinkScale",
    "MotionPlanDetailedResponse",
    "MotionPlanRequest",
    "MotionPlanResponse",
    "MotionSequenceItem",
    "MotionSequenceRequest",
    "MotionSequenceResponse",
    "MoveItErrorCodes",
    "ObjectColor",
    "OrientationConstraint",
    "OrientedBoundingBox",
    "PipelineState",
    "PlaceLocation",
    "PlannerInterfaceDescription",
    "PlannerParams",
    "PlanningOptions",
    "PlanningScene",
    "PlanningSceneComponents",
    "PlanningSceneWorld",
    "PositionConstraint",
    "PositionIKRequest",
    "RobotState",
    "RobotTrajectory",
    "ServoStatus",
    "TrajectoryConstraints",
    "VisibilityConstraint",
    "WorkspaceParameters",
]


class RobotTrajectory(Message, typename="moveit_msgs/msg/RobotTrajectory"):
    """RobotTrajectory, as MoveIt 2 defines it."""

    joint_trajectory: JointTrajectory = DEFAULT
    multi_dof_joint_trajectory: MultiDOFJointTrajectory = DEFAULT


class MoveItErrorCodes(Message, typename="moveit_msgs/msg/MoveItErrorCodes"):
    """MoveItErrorCodes, as MoveIt 2 defines it."""

    SUCCESS: ClassVar[int32] = 1
    UNDEFINED: ClassVar[int32] = 0
    FAILURE: ClassVar[int32] = 99999
    PLANNING_FAILED: ClassVar[int32] = -1
    INVALID_MOTION_PLAN: ClassVar[int32] = -2
    MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE: ClassVar[int32] = -3
    CONTROL_FAILED: ClassVar[int32] = -4
    UNABLE_TO_AQUIRE_SENSOR_DATA: ClassVar[int32] = -5
    TIMED_OUT: ClassVar[int32] = -6
    PREEMPTED: ClassVar[int32] = -7
    START_STATE_IN_COLLISION: ClassVar[int32] = -10
    START_STATE_VIOLATES_PATH_CONSTRAINTS: ClassVar[int32] = -11
    START_STATE_INVALID: ClassVar[int32] = -26
    GOAL_IN_COLLISION: ClassVar[int32] = -12
    GOAL_VIOLATES_PATH_CONSTRAINTS: ClassVar[int32] = -13
    GOAL_CONSTRAINTS_VIOLATED: ClassVar[int32] = -14
    GOAL_STATE_INVALID: ClassVar[int32] = -27
    UNRECOGNIZED_GOAL_TYPE: ClassVar[int32] = -28
    INVALID_GROUP_NAME: ClassVar[int32] = -15
    INVALID_GOAL_CONSTRAINTS: ClassVar[int32] = -16
    INVALID_ROBOT_STATE: ClassVar[int32] = -17
    INVALID_LINK_NAME: ClassVar[int32] = -18
    INVALID_OBJECT_NAME: ClassVar[int32] = -19
    FRAME_TRANSFORM_FAILURE: ClassVar[int32] = -21
    COLLISION_CHECKING_UNAVAILABLE: ClassVar[int32] = -22
    ROBOT_STATE_STALE: ClassVar[int32] = -23
    SENSOR_INFO_STALE: ClassVar[int32] = -24
    COMMUNICATION_FAILURE: ClassVar[int32] = -25
    CRASH: ClassVar[int32] = -29
    ABORT: ClassVar[int32] = -30
    NO_IK_SOLUTION: ClassVar[int32] = -31

    val: int32 = 0
    message: str = ""
    source: str = ""


class WorkspaceParameters(Message, typename="moveit_msgs/msg/WorkspaceParameters"):
    """WorkspaceParameters, as MoveIt 2 defines it."""

    header: Header = DEFAULT
    min_corner: Vector3 = DEFAULT
    max_corner: Vector3 = DEFAULT


class CollisionObject(Message, typename="moveit_msgs/msg/CollisionObject"):
    """CollisionObject, as MoveIt 2 defines it."""

    ADD: ClassVar[byte] = b"\x00"
    REMOVE: ClassVar[byte] = b"\x01"
    APPEND: ClassVar[byte] = b"\x02"
    MOVE: ClassVar[byte] = b"\x03"

    header: Header = DEFAULT
    pose: Pose = DEFAULT
    id: str = ""
    type: ObjectType = DEFAULT
    primitives: Annotated[list[SolidPrimitive], Sequence[SolidPrimitive]] = DEFAULT
    primitive_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    meshes: Annotated[list[Mesh], Sequence[Mesh]] = DEFAULT
    mesh_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    planes: Annotated[list[Plane], Sequence[Plane]] = DEFAULT
    plane_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    subframe_names: Annotated[list[str], Sequence[str]] = DEFAULT
    subframe_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    operation: byte = b"\x00"


class AttachedCollisionObject(Message, typename="moveit_msgs/msg/AttachedCollisionObject"):
    """AttachedCollisionObject, as MoveIt 2 defines it."""

    link_name: str = ""
    object: CollisionObject = DEFAULT
    touch_links: Annotated[list[str], Sequence[str]] = DEFAULT
    detach_posture: JointTrajectory = DEFAULT
    weight: float64 = 0.0


class RobotState(Message, typename="moveit_msgs/msg/RobotState"):
    """RobotState, as MoveIt 2 defines it."""

    joint_state: JointState = DEFAULT
    multi_dof_joint_state: MultiDOFJointState = DEFAULT
    attached_collision_objects: Annotated[
        list[AttachedCollisionObject], Sequence[AttachedCollisionObject]
    ] = DEFAULT
    is_diff: bool = False


class JointConstraint(Message, typename="moveit_msgs/msg/JointConstraint"):
    """JointConstraint, as MoveIt 2 defines it."""

    joint_name: str = ""
    position: float64 = 0.0
    tolerance_above: float64 = 0.0
    tolerance_below: float64 = 0.0
    weight: float64 = 0.0


class BoundingVolume(Message, typename="moveit_msgs/msg/BoundingVolume"):
    """BoundingVolume, as MoveIt 2 defines it."""

    primitives: Annotated[list[SolidPrimitive], Sequence[SolidPrimitive]] = DEFAULT
    primitive_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    meshes: Annotated[list[Mesh], Sequence[Mesh]] = DEFAULT
    mesh_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT


class PositionConstraint(Message, typename="moveit_msgs/msg/PositionConstraint"):
    """PositionConstraint, as MoveIt 2 defines it."""

    header: Header = DEFAULT
    link_name: str = ""
    target_point_offset: Vector3 = DEFAULT
    constraint_region: BoundingVolume = DEFAULT
    weight: float64 = 0.0


class OrientationConstraint(Message, typename="moveit_msgs/msg/OrientationConstraint"):
    """OrientationConstraint, as MoveIt 2 defines it."""

    XYZ_EULER_ANGLES: ClassVar[uint8] = 0
    ROTATION_VECTOR: ClassVar[uint8] = 1

    header: Header = DEFAULT
    orientation: Quaternion = DEFAULT
    link_name: str = ""
    absolute_x_axis_tolerance: float64 = 0.0
    absolute_y_axis_tolerance: float64 = 0.0
    absolute_z_axis_tolerance: float64 = 0.0
    parameterization: uint8 = 0
    weight: float64 = 0.0


class VisibilityConstraint(Message, typename="moveit_msgs/msg/VisibilityConstraint"):
    """VisibilityConstraint, as MoveIt 2 defines it."""

    SENSOR_Z: ClassVar[uint8] = 0
    SENSOR_Y: ClassVar[uint8] = 1
    SENSOR_X: ClassVar[uint8] = 2

    target_radius: float64 = 0.0
    target_pose: PoseStamped = DEFAULT
    cone_sides: int32 = 0
    sensor_pose: PoseStamped = DEFAULT
    max_view_angle: float64 = 0.0
    max_range_angle: float64 = 0.0
    sensor_view_direction: uint8 = 0
    weight: float64 = 0.0


class Constraints(Message, typename="moveit_msgs/msg/Constraints"):
    """Constraints, as MoveIt 2 defines it."""

    name: str = ""
    joint_constraints: Annotated[list[JointConstraint], Sequence[JointConstraint]] = DEFAULT
    position_constraints: Annotated[list[PositionConstraint], Sequence[PositionConstraint]] = (
        DEFAULT
    )
    orientation_constraints: Annotated[
        list[OrientationConstraint], Sequence[OrientationConstraint]
    ] = DEFAULT
    visibility_constraints: Annotated[
        list[VisibilityConstraint], Sequence[VisibilityConstraint]
    ] = DEFAULT


class TrajectoryConstraints(Message, typename="moveit_msgs/msg/TrajectoryConstraints"):
    """TrajectoryConstraints, as MoveIt 2 defines it."""

    constraints: Annotated[list[Constraints], Sequence[Constraints]] = DEFAULT


class CartesianPoint(Message, typename="moveit_msgs/msg/CartesianPoint"):
    """CartesianPoint, as MoveIt 2 defines it."""

    pose: Pose = DEFAULT
    velocity: Twist = DEFAULT
    acceleration: Accel = DEFAULT


class CartesianTrajectoryPoint(Message, typename="moveit_msgs/msg/CartesianTrajectoryPoint"):
    """CartesianTrajectoryPoint, as MoveIt 2 defines it."""

    point: CartesianPoint = DEFAULT
    time_from_start: Duration = DEFAULT


class CartesianTrajectory(Message, typename="moveit_msgs/msg/CartesianTrajectory"):
    """CartesianTrajectory, as MoveIt 2 defines it."""

    header: Header = DEFAULT
    tracked_frame: str = ""
    points: Annotated[list[CartesianTrajectoryPoint], Sequence[CartesianTrajectoryPoint]] = DEFAULT


class GenericTrajectory(Message, typename="moveit_msgs/msg/GenericTrajectory"):
    """GenericTrajectory, as MoveIt 2 defines it."""

    header: Header = DEFAULT
    joint_trajectory: Annotated[list[JointTrajectory], Sequence[JointTrajectory]] = DEFAULT
    cartesian_trajectory: Annotated[list[CartesianTrajectory], Sequence[CartesianTrajectory]] = (
        DEFAULT
    )


class MotionPlanRequest(Message, typename="moveit_msgs/msg/MotionPlanRequest"):
    """MotionPlanRequest, as MoveIt 2 defines it."""

    workspace_parameters: WorkspaceParameters = DEFAULT
    start_state: RobotState = DEFAULT
    goal_constraints: Annotated[list[Constraints], Sequence[Constraints]] = DEFAULT
    path_constraints: Constraints = DEFAULT
    trajectory_constraints: TrajectoryConstraints = DEFAULT
    reference_trajectories: Annotated[list[GenericTrajectory], Sequence[GenericTrajectory]] = (
        DEFAULT
    )
    pipeline_id: str = ""
    planner_id: str = ""
    group_name: str = ""
    num_planning_attempts: int32 = 0
    allowed_planning_time: float64 = 0.0
    max_velocity_scaling_factor: float64 = 0.0
    max_acceleration_scaling_factor: float64 = 0.0
    cartesian_speed_limited_link: str = ""
    max_cartesian_speed: float64 = 0.0


class MotionSequenceItem(Message, typename="moveit_msgs/msg/MotionSequenceItem"):
    """MotionSequenceItem, as MoveIt 2 defines it."""

    req: MotionPlanRequest = DEFAULT
    blend_radius: float64 = 0.0


class MotionSequenceRequest(Message, typename="moveit_msgs/msg/MotionSequenceRequest"):
    """MotionSequenceRequest, as MoveIt 2 defines it."""

    items: Annotated[list[MotionSequenceItem], Sequence[MotionSequenceItem]] = DEFAULT


class MotionPlanResponse(Message, typename="moveit_msgs/msg/MotionPlanResponse"):
    """MotionPlanResponse, as MoveIt 2 defines it."""

    trajectory_start: RobotState = DEFAULT
    group_name: str = ""
    trajectory: RobotTrajectory = DEFAULT
    planning_time: float64 = 0.0
    error_code: MoveItErrorCodes = DEFAULT


class AllowedCollisionEntry(Message, typename="moveit_msgs/msg/AllowedCollisionEntry"):
    """AllowedCollisionEntry, as MoveIt 2 defines it."""

    enabled: Annotated[Bools, Sequence[bool]] = DEFAULT


class AllowedCollisionMatrix(Message, typename="moveit_msgs/msg/AllowedCollisionMatrix"):
    """AllowedCollisionMatrix, as MoveIt 2 defines it."""

    entry_names: Annotated[list[str], Sequence[str]] = DEFAULT
    entry_values: Annotated[list[AllowedCollisionEntry], Sequence[AllowedCollisionEntry]] = DEFAULT
    default_entry_names: Annotated[list[str], Sequence[str]] = DEFAULT
    default_entry_values: Annotated[Bools, Sequence[bool]] = DEFAULT


class LinkPadding(Message, typename="moveit_msgs/msg/LinkPadding"):
    """LinkPadding, as MoveIt 2 defines it."""

    link_name: str = ""
    padding: float64 = 0.0


class LinkScale(Message, typename="moveit_msgs/msg/LinkScale"):
    """LinkScale, as MoveIt 2 defines it."""

    link_name: str = ""
    scale: float64 = 0.0


class ObjectColor(Message, typename="moveit_msgs/msg/ObjectColor"):
    """ObjectColor, as MoveIt 2 defines it."""

    id: str = ""
    color: ColorRGBA = DEFAULT


class PlanningSceneWorld(Message, typename="moveit_msgs/msg/PlanningSceneWorld"):
    """PlanningSceneWorld, as MoveIt 2 defines it."""

    collision_objects: Annotated[list[CollisionObject], Sequence[CollisionObject]] = DEFAULT
    octomap: OctomapWithPose = DEFAULT


class PlanningScene(Message, typename="moveit_msgs/msg/PlanningScene"):
    """PlanningScene, as MoveIt 2 defines it."""

    name: str = ""
    robot_state: RobotState = DEFAULT
    robot_model_name: str = ""
    fixed_frame_transforms: Annotated[list[TransformStamped], Sequence[TransformStamped]] = DEFAULT
    allowed_collision_matrix: AllowedCollisionMatrix = DEFAULT
    link_padding: Annotated[list[LinkPadding], Sequence[LinkPadding]] = DEFAULT
    link_scale: Annotated[list[LinkScale], Sequence[LinkScale]] = DEFAULT
    object_colors: Annotated[list[ObjectColor], Sequence[ObjectColor]] = DEFAULT
    world: PlanningSceneWorld = DEFAULT
    is_diff: bool = False


class PlanningOptions(Message, typename="moveit_msgs/msg/PlanningOptions"):
    """PlanningOptions, as MoveIt 2 defines it."""

    planning_scene_diff: PlanningScene = DEFAULT
    plan_only: bool = False
    look_around: bool = False
    look_around_attempts: int32 = 0
    max_safe_execution_cost: float64 = 0.0
    replan: bool = False
    replan_attempts: int32 = 0
    replan_delay: float64 = 0.0


class MotionSequenceResponse(Message, typename="moveit_msgs/msg/MotionSequenceResponse"):
    """MotionSequenceResponse, as MoveIt 2 defines it."""

    error_code: MoveItErrorCodes = DEFAULT
    sequence_start: RobotState = DEFAULT
    planned_trajectories: Annotated[list[RobotTrajectory], Sequence[RobotTrajectory]] = DEFAULT
    planning_time: float64 = 0.0


class GripperTranslation(Message, typename="moveit_msgs/msg/GripperTranslation"):
    """GripperTranslation, as MoveIt 2 defines it."""

    direction: Vector3Stamped = DEFAULT
    desired_distance: float32 = 0.0
    min_distance: float32 = 0.0


class Grasp(Message, typename="moveit_msgs/msg/Grasp"):
    """Grasp, as MoveIt 2 defines it."""

    id: str = ""
    pre_grasp_posture: JointTrajectory = DEFAULT
    grasp_posture: JointTrajectory = DEFAULT
    grasp_pose: PoseStamped = DEFAULT
    grasp_quality: float64 = 0.0
    pre_grasp_approach: GripperTranslation = DEFAULT
    post_grasp_retreat: GripperTranslation = DEFAULT
    post_place_retreat: GripperTranslation = DEFAULT
    max_contact_force: float32 = 0.0
    allowed_touch_objects: Annotated[list[str], Sequence[str]] = DEFAULT


class PlaceLocation(Message, typename="moveit_msgs/msg/PlaceLocation"):
    """PlaceLocation, as MoveIt 2 defines it."""

    id: str = ""
    post_place_posture: JointTrajectory = DEFAULT
    place_pose: PoseStamped = DEFAULT
    quality: float64 = 0.0
    pre_place_approach: GripperTranslation = DEFAULT
    post_place_retreat: GripperTranslation = DEFAULT
    allowed_touch_objects: Annotated[list[str], Sequence[str]] = DEFAULT


class ConstraintEvalResult(Message, typename="moveit_msgs/msg/ConstraintEvalResult"):
    """ConstraintEvalResult, as MoveIt 2 defines it."""

    result: bool = False
    distance: float64 = 0.0


class ContactInformation(Message, typename="moveit_msgs/msg/ContactInformation"):
    """ContactInformation, as MoveIt 2 defines it."""

    ROBOT_LINK: ClassVar[uint32] = 0
    WORLD_OBJECT: ClassVar[uint32] = 1
    ROBOT_ATTACHED: ClassVar[uint32] = 2

    header: Header = DEFAULT
    position: Point = DEFAULT
    normal: Vector3 = DEFAULT
    depth: float64 = 0.0
    contact_body_1: str = ""
    body_type_1: uint32 = 0
    contact_body_2: str = ""
    body_type_2: uint32 = 0


class CostSource(Message, typename="moveit_msgs/msg/CostSource"):
    """CostSource, as MoveIt 2 defines it."""

    cost_density: float64 = 0.0
    aabb_min: Vector3 = DEFAULT
    aabb_max: Vector3 = DEFAULT


class DisplayRobotState(Message, typename="moveit_msgs/msg/DisplayRobotState"):
    """DisplayRobotState, as MoveIt 2 defines it."""

    state: RobotState = DEFAULT
    highlight_links: Annotated[list[ObjectColor], Sequence[ObjectColor]] = DEFAULT
    hide: bool = False


class DisplayTrajectory(Message, typename="moveit_msgs/msg/DisplayTrajectory"):
    """DisplayTrajectory, as MoveIt 2 defines it."""

    model_id: str = ""
    trajectory: Annotated[list[RobotTrajectory], Sequence[RobotTrajectory]] = DEFAULT
    trajectory_start: RobotState = DEFAULT


class JointLimits(Message, typename="moveit_msgs/msg/JointLimits"):
    """JointLimits, as MoveIt 2 defines it."""

    joint_name: str = ""
    has_position_limits: bool = False
    min_position: float64 = 0.0
    max_position: float64 = 0.0
    has_velocity_limits: bool = False
    max_velocity: float64 = 0.0
    has_acceleration_limits: bool = False
    max_acceleration: float64 = 0.0
    has_jerk_limits: bool = False
    max_jerk: float64 = 0.0


class KinematicSolverInfo(Message, typename="moveit_msgs/msg/KinematicSolverInfo"):
    """KinematicSolverInfo, as MoveIt 2 defines it."""

    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    limits: Annotated[list[JointLimits], Sequence[JointLimits]] = DEFAULT
    link_names: Annotated[list[str], Sequence[str]] = DEFAULT


class MotionPlanDetailedResponse(Message, typename="moveit_msgs/msg/MotionPlanDetailedResponse"):
    """MotionPlanDetailedResponse, as MoveIt 2 defines it."""

    trajectory_start: RobotState = DEFAULT
    group_name: str = ""
    trajectory: Annotated[list[RobotTrajectory], Sequence[RobotTrajectory]] = DEFAULT
    description: Annotated[list[str], Sequence[str]] = DEFAULT
    processing_time: Annotated[Floats, Sequence[float64]] = DEFAULT
    error_code: MoveItErrorCodes = DEFAULT


class OrientedBoundingBox(Message, typename="moveit_msgs/msg/OrientedBoundingBox"):
    """OrientedBoundingBox, as MoveIt 2 defines it."""

    pose: Pose = DEFAULT
    extents: Point32 = DEFAULT


class PipelineState(Message, typename="moveit_msgs/msg/PipelineState"):
    """PipelineState, as MoveIt 2 defines it."""

    request: MotionPlanRequest = DEFAULT
    response: MotionPlanResponse = DEFAULT
    pipeline_stage: str = ""


class PlannerInterfaceDescription(Message, typename="moveit_msgs/msg/PlannerInterfaceDescription"):
    """PlannerInterfaceDescription, as MoveIt 2 defines it."""

    name: str = ""
    pipeline_id: str = ""
    planner_ids: Annotated[list[str], Sequence[str]] = DEFAULT


class PlannerParams(Message, typename="moveit_msgs/msg/PlannerParams"):
    """PlannerParams, as MoveIt 2 defines it."""

    keys: Annotated[list[str], Sequence[str]] = DEFAULT
    values: Annotated[list[str], Sequence[str]] = DEFAULT
    descriptions: Annotated[list[str], Sequence[str]] = DEFAULT


class PlanningSceneComponents(Message, typename="moveit_msgs/msg/PlanningSceneComponents"):
    """PlanningSceneComponents, as MoveIt 2 defines it."""

    SCENE_SETTINGS: ClassVar[uint32] = 1
    ROBOT_STATE: ClassVar[uint32] = 2
    ROBOT_STATE_ATTACHED_OBJECTS: ClassVar[uint32] = 4
    WORLD_OBJECT_NAMES: ClassVar[uint32] = 8
    WORLD_OBJECT_GEOMETRY: ClassVar[uint32] = 16
    OCTOMAP: ClassVar[uint32] = 32
    TRANSFORMS: ClassVar[uint32] = 64
    ALLOWED_COLLISION_MATRIX: ClassVar[uint32] = 128
    LINK_PADDING_AND_SCALING: ClassVar[uint32] = 256
    OBJECT_COLORS: ClassVar[uint32] = 512

    components: uint32 = 0


class PositionIKRequest(Message, typename="moveit_msgs/msg/PositionIKRequest"):
    """PositionIKRequest, as MoveIt 2 defines it."""

    group_name: str = ""
    robot_state: RobotState = DEFAULT
    constraints: Constraints = DEFAULT
    avoid_collisions: bool = False
    ik_link_name: str = ""
    pose_stamped: PoseStamped = DEFAULT
    ik_link_names: Annotated[list[str], Sequence[str]] = DEFAULT
    pose_stamped_vector: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT
    timeout: Duration = DEFAULT


class ServoStatus(Message, typename="moveit_msgs/msg/ServoStatus"):
    """ServoStatus, as MoveIt 2 defines it."""

    INVALID: ClassVar[int8] = -1
    NO_WARNING: ClassVar[int8] = 0
    DECELERATE_FOR_APPROACHING_SINGULARITY: ClassVar[int8] = 1
    HALT_FOR_SINGULARITY: ClassVar[int8] = 2
    DECELERATE_FOR_LEAVING_SINGULARITY: ClassVar[int8] = 3
    DECELERATE_FOR_COLLISION: ClassVar[int8] = 4
    HALT_FOR_COLLISION: ClassVar[int8] = 5
    JOINT_BOUND: ClassVar[int8] = 6

    code: int8 = 0
    message: str = ""
