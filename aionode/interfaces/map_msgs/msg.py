"""Messages of map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Ints, Message, Sequence, float64, int8, int32, uint32

__all__ = ["OccupancyGridUpdate", "PointCloud2Update", "ProjectedMap", "ProjectedMapInfo"]


class OccupancyGridUpdate(Message, typename="map_msgs/msg/OccupancyGridUpdate"):
    """OccupancyGridUpdate, as navigation_msgs defines it."""

    header: Header = DEFAULT
    x: int32 = 0
    y: int32 = 0
    width: uint32 = 0
    height: uint32 = 0
    data: Annotated[Ints, Sequence[int8]] = DEFAULT


class PointCloud2Update(Message, typename="map_msgs/msg/PointCloud2Update"):
    """PointCloud2Update, as navigation_msgs defines it."""

    ADD: ClassVar[uint32] = 0
    DELETE: ClassVar[uint32] = 1

    header: Header = DEFAULT
    type: uint32 = 0
    points: PointCloud2 = DEFAULT


class ProjectedMap(Message, typename="map_msgs/msg/ProjectedMap"):
    """ProjectedMap, as navigation_msgs defines it."""

    map: OccupancyGrid = DEFAULT
    min_z: float64 = 0.0
    max_z: float64 = 0.0


class ProjectedMapInfo(Message, typename="map_msgs/msg/ProjectedMapInfo"):
    """ProjectedMapInfo, as navigation_msgs defines it."""

    frame_id: str = ""
    x: float64 = 0.0
    y: float64 = 0.0
    width: float64 = 0.0
    height: float64 = 0.0
    min_z: float64 = 0.0
    max_z: float64 = 0.0
