"""Services of map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.map_msgs.msg import ProjectedMapInfo
from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.interfaces.std_msgs.msg import String
from aionode.message import DEFAULT, Message, Sequence, ServiceType, float64

__all__ = [
    "GetMapROI",
    "GetPointMap",
    "GetPointMapROI",
    "ProjectedMapsInfo",
    "SaveMap",
    "SetMapProjections",
]


class GetMapROI(ServiceType, typename="map_msgs/srv/GetMapROI"):
    """GetMapROI, as navigation_msgs defines it."""

    class Request(Message):
        """The request of GetMapROI."""

        x: float64 = 0.0
        y: float64 = 0.0
        l_x: float64 = 0.0
        l_y: float64 = 0.0

    class Response(Message):
        """The response of GetMapROI."""

        sub_map: OccupancyGrid = DEFAULT


class GetPointMap(ServiceType, typename="map_msgs/srv/GetPointMap"):
    """GetPointMap, as navigation_msgs defines it."""

    class Request(Message):
        """The request of GetPointMap."""

    class Response(Message):
        """The response of GetPointMap."""

        map: PointCloud2 = DEFAULT


class GetPointMapROI(ServiceType, typename="map_msgs/srv/GetPointMapROI"):
    """GetPointMapROI, as navigation_msgs defines it."""

    class Request(Message):
        """The request of GetPointMapROI."""

        x: float64 = 0.0
        y: float64 = 0.0
        z: float64 = 0.0
        r: float64 = 0.0
        l_x: float64 = 0.0
        l_y: float64 = 0.0
        l_z: float64 = 0.0

    class Response(Message):
        """The response of GetPointMapROI."""

        sub_map: PointCloud2 = DEFAULT


class ProjectedMapsInfo(ServiceType, typename="map_msgs/srv/ProjectedMapsInfo"):
    """ProjectedMapsInfo, as navigation_msgs defines it."""

    class Request(Message):
        """The request of ProjectedMapsInfo."""

        projected_maps_info: Annotated[list[ProjectedMapInfo], Sequence[ProjectedMapInfo]] = DEFAULT

    class Response(Message):
        """The response of ProjectedMapsInfo."""


class SaveMap(ServiceType, typename="map_msgs/srv/SaveMap"):
    """SaveMap, as navigation_msgs defines it."""

    class Request(Message):
        """The request of SaveMap."""

        filename: String = DEFAULT

    class Response(Message):
        """The response of SaveMap."""


class SetMapProjections(ServiceType, typename="map_msgs/srv/SetMapProjections"):
    """SetMapProjections, as navigation_msgs defines it."""

    class Request(Message):
        """The request of SetMapProjections."""

    class Response(Message):
        """The response of SetMapProjections."""

        projected_maps_info: Annotated[list[ProjectedMapInfo], Sequence[ProjectedMapInfo]] = DEFAULT
