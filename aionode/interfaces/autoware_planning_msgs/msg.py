"""Messages of autoware_planning_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.geometry_msgs.msg import Point, Pose
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Message, Sequence, float32, int64, uint8

__all__ = [
    "LaneletPrimitive",
    "LaneletRoute",
    "LaneletSegment",
    "Path",
    "PathPoint",
    "PoseWithUuidStamped",
    "RouteState",
    "Trajectory",
    "TrajectoryPoint",
]


class LaneletPrimitive(Message, typename="autoware_planning_msgs/msg/LaneletPrimitive"):
    """LaneletPrimitive, as Autoware defines it."""

    id: int64 = 0
    primitive_type: str = ""


class LaneletSegment(Message, typename="autoware_planning_msgs/msg/LaneletSegment"):
    """LaneletSegment, as Autoware defines it."""

    preferred_primitive: LaneletPrimitive = DEFAULT
    primitives: Annotated[list[LaneletPrimitive], Sequence[LaneletPrimitive]] = DEFAULT


class LaneletRoute(Message, typename="autoware_planning_msgs/msg/LaneletRoute"):
    """LaneletRoute, as Autoware defines it."""

    header: Header = DEFAULT
    start_pose: Pose = DEFAULT
    goal_pose: Pose = DEFAULT
    segments: Annotated[list[LaneletSegment], Sequence[LaneletSegment]] = DEFAULT
    uuid: UUID = DEFAULT
    allow_modification: bool = False


class PathPoint(Message, typename="autoware_planning_msgs/msg/PathPoint"):
    """PathPoint, as Autoware defines it."""

    pose: Pose = DEFAULT
    longitudinal_velocity_mps: float32 = 0.0
    lateral_velocity_mps: float32 = 0.0
    heading_rate_rps: float32 = 0.0
    is_final: bool = False


class Path(Message, typename="autoware_planning_msgs/msg/Path"):
    """Path, as Autoware defines it."""

    header: Header = DEFAULT
    points: Annotated[list[PathPoint], Sequence[PathPoint]] = DEFAULT
    left_bound: Annotated[list[Point], Sequence[Point]] = DEFAULT
    right_bound: Annotated[list[Point], Sequence[Point]] = DEFAULT


class PoseWithUuidStamped(Message, typename="autoware_planning_msgs/msg/PoseWithUuidStamped"):
    """PoseWithUuidStamped, as Autoware defines it."""

    header: Header = DEFAULT
    pose: Pose = DEFAULT
    uuid: UUID = DEFAULT


class RouteState(Message, typename="autoware_planning_msgs/msg/RouteState"):
    """RouteState, as Autoware defines it."""

    UNKNOWN: ClassVar[uint8] = 0
    INITIALIZING: ClassVar[uint8] = 1
    UNSET: ClassVar[uint8] = 2
    ROUTING: ClassVar[uint8] = 3
    SET: ClassVar[uint8] = 4
    REROUTING: ClassVar[uint8] = 5
    ARRIVED: ClassVar[uint8] = 6
    ABORTED: ClassVar[uint8] = 7
    INTERRUPTED: ClassVar[uint8] = 8

    stamp: Time = DEFAULT
    state: uint8 = 0


class TrajectoryPoint(Message, typename="autoware_planning_msgs/msg/TrajectoryPoint"):
    """TrajectoryPoint, as Autoware defines it."""

    time_from_start: Duration = DEFAULT
    pose: Pose = DEFAULT
    longitudinal_velocity_mps: float32 = 0.0
    lateral_velocity_mps: float32 = 0.0
    acceleration_mps2: float32 = 0.0
    heading_rate_rps: float32 = 0.0
    front_wheel_angle_rad: float32 = 0.0
    rear_wheel_angle_rad: float32 = 0.0


class Trajectory(Message, typename="autoware_planning_msgs/msg/Trajectory"):
    """Trajectory, as Autoware defines it."""

    header: Header = DEFAULT
    points: Annotated[list[TrajectoryPoint], Sequence[TrajectoryPoint]] = DEFAULT
