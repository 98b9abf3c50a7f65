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


class Path(Message, typename="nav_msgs/msg/Path"):
    """Poses to pass, in order."""

    header: Header = DEFAULT
    poses: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT


class MapMetaData(Message, typename="nav_msgs/msg/MapMetaData"):
    """The properties of a map other than its cells.

    Attributes:
        map_load_time: When it was loaded.
        resolution: Width of a cell, in m.
        width: Number of cells along x.
        height: Number of cells along y.
        origin: Pose of the corner of cell (0, 0), in m.
    """

    map_load_time: Time = DEFAULT
    resolution: float32 = 0.0
    width: uint32 = 0
    height: uint32 = 0
    origin: Pose = DEFAULT


class OccupancyGrid(Message, typename="nav_msgs/msg/OccupancyGrid"):
    """A map of a floor, in cells that are free or not.

    Attributes:
        header: Time, and the frame of the map.
        info: Size, resolution and place.
        data: Row by row from the cell at the origin, x first: 0 is free, 100 is occupied,
            -1 is not known.
    """

    header: Header = DEFAULT
    info: MapMetaData = DEFAULT
    data: Annotated[Ints, Sequence[int8]] = DEFAULT


class Goals(Message, typename="nav_msgs/msg/Goals"):
    """Poses to visit, in order."""

    header: Header = DEFAULT
    goals: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT


class GridCells(Message, typename="nav_msgs/msg/GridCells"):
    """Marked cells of a grid: their centers, and the width and height of each, in m."""

    header: Header = DEFAULT
    cell_width: float32 = 0.0
    cell_height: float32 = 0.0
    cells: Annotated[list[Point], Sequence[Point]] = DEFAULT


class Odometry(Message, typename="nav_msgs/msg/Odometry"):
    """Where a robot is and how fast it moves, by its own reckoning.

    Attributes:
        header: Time, and the frame of `pose`, such as ``odom``.
        child_frame_id: The frame of `twist`, such as ``base_link``.
        pose: Position in m and orientation, with covariance.
        twist: Velocity in m/s and rad/s, with covariance.
    """

    header: Header = DEFAULT
    child_frame_id: str = ""
    pose: PoseWithCovariance = DEFAULT
    twist: TwistWithCovariance = DEFAULT
