"""Messages of nav_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import (
    Point,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    TwistWithCovariance,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Ints, Message, Sequence, float32, int8, uint32

__all__ = ["Goals", "GridCells", "MapMetaData", "OccupancyGrid", "Odometry", "Path"]


class Goals(Message, typename="nav_msgs/msg/Goals"):
    """Goals."""

    header: Header = DEFAULT
    goals: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT


class GridCells(Message, typename="nav_msgs/msg/GridCells"):
    """GridCells."""

    header: Header = DEFAULT
    cell_width: float32 = 0.0
    cell_height: float32 = 0.0
    cells: Annotated[list[Point], Sequence[Point]] = DEFAULT


class MapMetaData(Message, typename="nav_msgs/msg/MapMetaData"):
    """MapMetaData."""

    map_load_time: Time = DEFAULT
    resolution: float32 = 0.0
    width: uint32 = 0
    height: uint32 = 0
    origin: Pose = DEFAULT


class OccupancyGrid(Message, typename="nav_msgs/msg/OccupancyGrid"):
    """OccupancyGrid."""

    header: Header = DEFAULT
    info: MapMetaData = DEFAULT
    data: Annotated[Ints, Sequence[int8]] = DEFAULT


class Odometry(Message, typename="nav_msgs/msg/Odometry"):
    """Odometry."""

    header: Header = DEFAULT
    child_frame_id: str = ""
    pose: PoseWithCovariance = DEFAULT
    twist: TwistWithCovariance = DEFAULT


class Path(Message, typename="nav_msgs/msg/Path"):
    """Path."""

    header: Header = DEFAULT
    poses: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT
