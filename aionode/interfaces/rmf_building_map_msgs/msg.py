"""Messages of rmf_building_map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import DEFAULT, Bytes, Message, Sequence, float32, int32, uint8, uint32

__all__ = [
    "AffineImage",
    "BuildingMap",
    "Door",
    "Graph",
    "GraphEdge",
    "GraphNode",
    "Level",
    "Lift",
    "Param",
    "Place",
]


class AffineImage(Message, typename="rmf_building_map_msgs/msg/AffineImage"):
    """AffineImage, as Open-RMF defines it."""

    name: str = ""
    x_offset: float32 = 0.0
    y_offset: float32 = 0.0
    yaw: float32 = 0.0
    scale: float32 = 0.0
    encoding: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class Place(Message, typename="rmf_building_map_msgs/msg/Place"):
    """Place, as Open-RMF defines it."""

    name: str = ""
    x: float32 = 0.0
    y: float32 = 0.0
    yaw: float32 = 0.0
    position_tolerance: float32 = 0.0
    yaw_tolerance: float32 = 0.0


class Door(Message, typename="rmf_building_map_msgs/msg/Door"):
    """Door, as Open-RMF defines it."""

    DOOR_TYPE_UNDEFINED: ClassVar[uint8] = 0
    DOOR_TYPE_SINGLE_SLIDING: ClassVar[uint8] = 1
    DOOR_TYPE_DOUBLE_SLIDING: ClassVar[uint8] = 2
    DOOR_TYPE_SINGLE_TELESCOPE: ClassVar[uint8] = 3
    DOOR_TYPE_DOUBLE_TELESCOPE: ClassVar[uint8] = 4
    DOOR_TYPE_SINGLE_SWING: ClassVar[uint8] = 5
    DOOR_TYPE_DOUBLE_SWING: ClassVar[uint8] = 6

    name: str = ""
    v1_x: float32 = 0.0
    v1_y: float32 = 0.0
    v2_x: float32 = 0.0
    v2_y: float32 = 0.0
    door_type: uint8 = 0
    motion_range: float32 = 0.0
    motion_direction: int32 = 0


class Param(Message, typename="rmf_building_map_msgs/msg/Param"):
    """Param, as Open-RMF defines it."""

    TYPE_UNDEFINED: ClassVar[uint32] = 0
    TYPE_STRING: ClassVar[uint32] = 1
    TYPE_INT: ClassVar[uint32] = 2
    TYPE_DOUBLE: ClassVar[uint32] = 3
    TYPE_BOOL: ClassVar[uint32] = 4

    name: str = ""
    type: uint32 = 0
    value_int: int32 = 0
    value_float: float32 = 0.0
    value_string: str = ""
    value_bool: bool = False


class GraphNode(Message, typename="rmf_building_map_msgs/msg/GraphNode"):
    """GraphNode, as Open-RMF defines it."""

    x: float32 = 0.0
    y: float32 = 0.0
    name: str = ""
    params: Annotated[list[Param], Sequence[Param]] = DEFAULT


class GraphEdge(Message, typename="rmf_building_map_msgs/msg/GraphEdge"):
    """GraphEdge, as Open-RMF defines it."""

    EDGE_TYPE_BIDIRECTIONAL: ClassVar[uint8] = 0
    EDGE_TYPE_UNIDIRECTIONAL: ClassVar[uint8] = 1

    v1_idx: uint32 = 0
    v2_idx: uint32 = 0
    params: Annotated[list[Param], Sequence[Param]] = DEFAULT
    edge_type: uint8 = 0


class Graph(Message, typename="rmf_building_map_msgs/msg/Graph"):
    """Graph, as Open-RMF defines it."""

    name: str = ""
    vertices: Annotated[list[GraphNode], Sequence[GraphNode]] = DEFAULT
    edges: Annotated[list[GraphEdge], Sequence[GraphEdge]] = DEFAULT
    params: Annotated[list[Param], Sequence[Param]] = DEFAULT


class Level(Message, typename="rmf_building_map_msgs/msg/Level"):
    """Level, as Open-RMF defines it."""

    name: str = ""
    elevation: float32 = 0.0
    images: Annotated[list[AffineImage], Sequence[AffineImage]] = DEFAULT
    places: Annotated[list[Place], Sequence[Place]] = DEFAULT
    doors: Annotated[list[Door], Sequence[Door]] = DEFAULT
    nav_graphs: Annotated[list[Graph], Sequence[Graph]] = DEFAULT
    wall_graph: Graph = DEFAULT


class Lift(Message, typename="rmf_building_map_msgs/msg/Lift"):
    """Lift, as Open-RMF defines it."""

    name: str = ""
    levels: Annotated[list[str], Sequence[str]] = DEFAULT
    doors: Annotated[list[Door], Sequence[Door]] = DEFAULT
    wall_graph: Graph = DEFAULT
    ref_x: float32 = 0.0
    ref_y: float32 = 0.0
    ref_yaw: float32 = 0.0
    width: float32 = 0.0
    depth: float32 = 0.0


class BuildingMap(Message, typename="rmf_building_map_msgs/msg/BuildingMap"):
    """BuildingMap, as Open-RMF defines it."""

    name: str = ""
    levels: Annotated[list[Level], Sequence[Level]] = DEFAULT
    lifts: Annotated[list[Lift], Sequence[Lift]] = DEFAULT
