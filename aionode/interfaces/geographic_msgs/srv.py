"""Services of geographic_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geographic_msgs.msg import (
    BoundingBox,
    GeographicMap,
    GeographicMapChanges,
    GeoPath,
    GeoPoint,
    RoutePath,
)
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Message, ServiceType, float64

__all__ = ["GetGeoPath", "GetGeographicMap", "GetRoutePlan", "UpdateGeographicMap"]


class GetGeoPath(ServiceType, typename="geographic_msgs/srv/GetGeoPath"):
    """Plans a path between two places on the earth; its length is in meters."""

    class Request(Message):
        """The request of GetGeoPath."""

        start: GeoPoint = DEFAULT
        goal: GeoPoint = DEFAULT

    class Response(Message):
        """The response of GetGeoPath."""

        success: bool = False
        status: str = ""
        plan: GeoPath = DEFAULT
        network: UUID = DEFAULT
        start_seg: UUID = DEFAULT
        goal_seg: UUID = DEFAULT
        distance: float64 = 0.0


class GetGeographicMap(ServiceType, typename="geographic_msgs/srv/GetGeographicMap"):
    """Returns the map of a part of the earth from a URL."""

    class Request(Message):
        """The request of GetGeographicMap."""

        url: str = ""
        bounds: BoundingBox = DEFAULT

    class Response(Message):
        """The response of GetGeographicMap."""

        success: bool = False
        status: str = ""
        map: GeographicMap = DEFAULT


class GetRoutePlan(ServiceType, typename="geographic_msgs/srv/GetRoutePlan"):
    """Plans a path between two points of a network."""

    class Request(Message):
        """The request of GetRoutePlan."""

        network: UUID = DEFAULT
        start: UUID = DEFAULT
        goal: UUID = DEFAULT

    class Response(Message):
        """The response of GetRoutePlan."""

        success: bool = False
        status: str = ""
        plan: RoutePath = DEFAULT


class UpdateGeographicMap(ServiceType, typename="geographic_msgs/srv/UpdateGeographicMap"):
    """Sets what is new or different on a map, and removes what is deleted."""

    class Request(Message):
        """The request of UpdateGeographicMap."""

        updates: GeographicMapChanges = DEFAULT

    class Response(Message):
        """The response of UpdateGeographicMap."""

        success: bool = False
        status: str = ""
