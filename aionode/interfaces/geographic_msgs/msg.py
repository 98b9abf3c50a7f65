"""Messages of geographic_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Quaternion
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Array, Floats, Message, Sequence, float64

__all__ = [
    "BoundingBox",
    "GeoPath",
    "GeoPoint",
    "GeoPointStamped",
    "GeoPose",
    "GeoPoseStamped",
    "GeoPoseWithCovariance",
    "GeoPoseWithCovarianceStamped",
    "GeographicMap",
    "GeographicMapChanges",
    "KeyValue",
    "MapFeature",
    "RouteNetwork",
    "RoutePath",
    "RouteSegment",
    "WayPoint",
]


class GeoPoint(Message, typename="geographic_msgs/msg/GeoPoint"):
    """A place on the earth (WGS 84): degrees, and meters above the ellipsoid, NaN if unknown."""

    latitude: float64 = 0.0
    longitude: float64 = 0.0
    altitude: float64 = 0.0


class BoundingBox(Message, typename="geographic_msgs/msg/BoundingBox"):
    """A part of the earth between two corners; NaN in the altitudes for no limit of height."""

    min_pt: GeoPoint = DEFAULT
    max_pt: GeoPoint = DEFAULT


class GeoPose(Message, typename="geographic_msgs/msg/GeoPose"):
    """A place on the earth, and an orientation: x is east, y north, z up."""

    position: GeoPoint = DEFAULT
    orientation: Quaternion = DEFAULT


class GeoPoseStamped(Message, typename="geographic_msgs/msg/GeoPoseStamped"):
    """A pose on the earth, with its time."""

    header: Header = DEFAULT
    pose: GeoPose = DEFAULT


class GeoPath(Message, typename="geographic_msgs/msg/GeoPath"):
    """Poses on the earth in their order."""

    header: Header = DEFAULT
    poses: Annotated[list[GeoPoseStamped], Sequence[GeoPoseStamped]] = DEFAULT


class GeoPointStamped(Message, typename="geographic_msgs/msg/GeoPointStamped"):
    """A place on the earth, with its time."""

    header: Header = DEFAULT
    position: GeoPoint = DEFAULT


class GeoPoseWithCovariance(Message, typename="geographic_msgs/msg/GeoPoseWithCovariance"):
    """A pose on the earth, and how uncertain it is, in square meters and radians."""

    pose: GeoPose = DEFAULT
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT


class GeoPoseWithCovarianceStamped(
    Message, typename="geographic_msgs/msg/GeoPoseWithCovarianceStamped"
):
    """A pose on the earth with its uncertainty and time."""

    header: Header = DEFAULT
    pose: GeoPoseWithCovariance = DEFAULT


class KeyValue(Message, typename="geographic_msgs/msg/KeyValue"):
    """A property of something on a map."""

    key: str = ""
    value: str = ""


class WayPoint(Message, typename="geographic_msgs/msg/WayPoint"):
    """A point of a map, with its id and properties."""

    id: UUID = DEFAULT
    position: GeoPoint = DEFAULT
    props: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class MapFeature(Message, typename="geographic_msgs/msg/MapFeature"):
    """Something on a map that is made of points or of other features."""

    id: UUID = DEFAULT
    components: Annotated[list[UUID], Sequence[UUID]] = DEFAULT
    props: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class GeographicMap(Message, typename="geographic_msgs/msg/GeographicMap"):
    """The points and features of a part of the earth."""

    header: Header = DEFAULT
    id: UUID = DEFAULT
    bounds: BoundingBox = DEFAULT
    points: Annotated[list[WayPoint], Sequence[WayPoint]] = DEFAULT
    features: Annotated[list[MapFeature], Sequence[MapFeature]] = DEFAULT
    props: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class GeographicMapChanges(Message, typename="geographic_msgs/msg/GeographicMapChanges"):
    """What is new or different on a map, and what is not there any more."""

    header: Header = DEFAULT
    diffs: GeographicMap = DEFAULT
    deletes: Annotated[list[UUID], Sequence[UUID]] = DEFAULT


class RouteSegment(Message, typename="geographic_msgs/msg/RouteSegment"):
    """A way from one point of a map to another, in that direction."""

    id: UUID = DEFAULT
    start: UUID = DEFAULT
    end: UUID = DEFAULT
    props: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class RouteNetwork(Message, typename="geographic_msgs/msg/RouteNetwork"):
    """The ways of a part of the earth, and the points that they join."""

    header: Header = DEFAULT
    id: UUID = DEFAULT
    bounds: BoundingBox = DEFAULT
    points: Annotated[list[WayPoint], Sequence[WayPoint]] = DEFAULT
    segments: Annotated[list[RouteSegment], Sequence[RouteSegment]] = DEFAULT
    props: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT


class RoutePath(Message, typename="geographic_msgs/msg/RoutePath"):
    """A path through a network: its segments in their order."""

    header: Header = DEFAULT
    network: UUID = DEFAULT
    segments: Annotated[list[UUID], Sequence[UUID]] = DEFAULT
    props: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT
