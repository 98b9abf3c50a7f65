"""Messages of nav2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import Point, Point32, Pose, PoseStamped, Vector3
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Bools,
    Bytes,
    Ints,
    Message,
    Sequence,
    float32,
    float64,
    uint8,
    uint16,
    uint32,
)

__all__ = [
    "BehaviorTreeLog",
    "BehaviorTreeStatusChange",
    "CollisionDetectorState",
    "CollisionMonitorState",
    "Costmap",
    "CostmapFilterInfo",
    "CostmapMetaData",
    "CostmapUpdate",
    "EdgeCost",
    "MissedWaypoint",
    "Particle",
    "ParticleCloud",
    "Route",
    "RouteEdge",
    "RouteNode",
    "SpeedLimit",
    "VoxelGrid",
]


class RouteNode(Message, typename="nav2_msgs/msg/RouteNode"):
    """RouteNode, as Nav2 defines it."""

    nodeid: uint16 = 0
    position: Point = DEFAULT


class RouteEdge(Message, typename="nav2_msgs/msg/RouteEdge"):
    """RouteEdge, as Nav2 defines it."""

    edgeid: uint16 = 0
    start: Point = DEFAULT
    end: Point = DEFAULT


class Route(Message, typename="nav2_msgs/msg/Route"):
    """Route, as Nav2 defines it."""

    header: Header = DEFAULT
    route_cost: float32 = 0.0
    nodes: Annotated[list[RouteNode], Sequence[RouteNode]] = DEFAULT
    edges: Annotated[list[RouteEdge], Sequence[RouteEdge]] = DEFAULT


class MissedWaypoint(Message, typename="nav2_msgs/msg/MissedWaypoint"):
    """MissedWaypoint, as Nav2 defines it."""

    index: uint32 = 0
    goal: PoseStamped = DEFAULT
    error_code: uint16 = 0


class BehaviorTreeStatusChange(Message, typename="nav2_msgs/msg/BehaviorTreeStatusChange"):
    """BehaviorTreeStatusChange, as Nav2 defines it."""

    timestamp: Time = DEFAULT
    node_name: str = ""
    uid: uint16 = 0
    previous_status: str = ""
    current_status: str = ""


class BehaviorTreeLog(Message, typename="nav2_msgs/msg/BehaviorTreeLog"):
    """BehaviorTreeLog, as Nav2 defines it."""

    timestamp: Time = DEFAULT
    event_log: Annotated[list[BehaviorTreeStatusChange], Sequence[BehaviorTreeStatusChange]] = (
        DEFAULT
    )


class CollisionDetectorState(Message, typename="nav2_msgs/msg/CollisionDetectorState"):
    """CollisionDetectorState, as Nav2 defines it."""

    polygons: Annotated[list[str], Sequence[str]] = DEFAULT
    detections: Annotated[Bools, Sequence[bool]] = DEFAULT


class CollisionMonitorState(Message, typename="nav2_msgs/msg/CollisionMonitorState"):
    """CollisionMonitorState, as Nav2 defines it."""

    DO_NOTHING: ClassVar[uint8] = 0
    STOP: ClassVar[uint8] = 1
    SLOWDOWN: ClassVar[uint8] = 2
    APPROACH: ClassVar[uint8] = 3
    LIMIT: ClassVar[uint8] = 4

    action_type: uint8 = 0
    polygon_name: str = ""


class CostmapMetaData(Message, typename="nav2_msgs/msg/CostmapMetaData"):
    """CostmapMetaData, as Nav2 defines it."""

    map_load_time: Time = DEFAULT
    update_time: Time = DEFAULT
    layer: str = ""
    resolution: float32 = 0.0
    size_x: uint32 = 0
    size_y: uint32 = 0
    origin: Pose = DEFAULT


class Costmap(Message, typename="nav2_msgs/msg/Costmap"):
    """Costmap, as Nav2 defines it."""

    header: Header = DEFAULT
    metadata: CostmapMetaData = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class CostmapFilterInfo(Message, typename="nav2_msgs/msg/CostmapFilterInfo"):
    """CostmapFilterInfo, as Nav2 defines it."""

    header: Header = DEFAULT
    type: uint8 = 0
    filter_mask_topic: str = ""
    base: float32 = 0.0
    multiplier: float32 = 0.0


class CostmapUpdate(Message, typename="nav2_msgs/msg/CostmapUpdate"):
    """CostmapUpdate, as Nav2 defines it."""

    header: Header = DEFAULT
    x: uint32 = 0
    y: uint32 = 0
    size_x: uint32 = 0
    size_y: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class EdgeCost(Message, typename="nav2_msgs/msg/EdgeCost"):
    """EdgeCost, as Nav2 defines it."""

    edgeid: uint16 = 0
    cost: float32 = 0.0


class Particle(Message, typename="nav2_msgs/msg/Particle"):
    """Particle, as Nav2 defines it."""

    pose: Pose = DEFAULT
    weight: float64 = 0.0


class ParticleCloud(Message, typename="nav2_msgs/msg/ParticleCloud"):
    """ParticleCloud, as Nav2 defines it."""

    header: Header = DEFAULT
    particles: Annotated[list[Particle], Sequence[Particle]] = DEFAULT


class SpeedLimit(Message, typename="nav2_msgs/msg/SpeedLimit"):
    """SpeedLimit, as Nav2 defines it."""

    header: Header = DEFAULT
    percentage: bool = False
    speed_limit: float64 = 0.0


class VoxelGrid(Message, typename="nav2_msgs/msg/VoxelGrid"):
    """VoxelGrid, as Nav2 defines it."""

    header: Header = DEFAULT
    data: Annotated[Ints, Sequence[uint32]] = DEFAULT
    origin: Point32 = DEFAULT
    resolutions: Vector3 = DEFAULT
    size_x: uint32 = 0
    size_y: uint32 = 0
    size_z: uint32 = 0
