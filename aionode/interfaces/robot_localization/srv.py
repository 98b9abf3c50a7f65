"""Services of robot_localization.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geographic_msgs.msg import GeoPoint, GeoPose
from aionode.interfaces.geometry_msgs.msg import Point, PoseWithCovarianceStamped
from aionode.message import DEFAULT, Array, Floats, Message, ServiceType, float64

__all__ = [
    "FromLL",
    "GetState",
    "SetDatum",
    "SetPose",
    "SetUTMZone",
    "ToLL",
    "ToggleFilterProcessing",
]


class FromLL(ServiceType, typename="robot_localization/srv/FromLL"):
    """FromLL, as robot_localization defines it."""

    class Request(Message):
        """The request of FromLL."""

        ll_point: GeoPoint = DEFAULT

    class Response(Message):
        """The response of FromLL."""

        map_point: Point = DEFAULT


class GetState(ServiceType, typename="robot_localization/srv/GetState"):
    """GetState, as robot_localization defines it."""

    class Request(Message):
        """The request of GetState."""

        time_stamp: Time = DEFAULT
        frame_id: str = ""

    class Response(Message):
        """The response of GetState."""

        state: Annotated[Floats, Array[float64, 15]] = DEFAULT
        covariance: Annotated[Floats, Array[float64, 225]] = DEFAULT


class SetDatum(ServiceType, typename="robot_localization/srv/SetDatum"):
    """SetDatum, as robot_localization defines it."""

    class Request(Message):
        """The request of SetDatum."""

        geo_pose: GeoPose = DEFAULT

    class Response(Message):
        """The response of SetDatum."""


class SetPose(ServiceType, typename="robot_localization/srv/SetPose"):
    """SetPose, as robot_localization defines it."""

    class Request(Message):
        """The request of SetPose."""

        pose: PoseWithCovarianceStamped = DEFAULT

    class Response(Message):
        """The response of SetPose."""


class SetUTMZone(ServiceType, typename="robot_localization/srv/SetUTMZone"):
    """SetUTMZone, as robot_localization defines it."""

    class Request(Message):
        """The request of SetUTMZone."""

        utm_zone: str = ""

    class Response(Message):
        """The response of SetUTMZone."""


class ToLL(ServiceType, typename="robot_localization/srv/ToLL"):
    """ToLL, as robot_localization defines it."""

    class Request(Message):
        """The request of ToLL."""

        map_point: Point = DEFAULT

    class Response(Message):
        """The response of ToLL."""

        ll_point: GeoPoint = DEFAULT


class ToggleFilterProcessing(ServiceType, typename="robot_localization/srv/ToggleFilterProcessing"):
    """ToggleFilterProcessing, as robot_localization defines it."""

    class Request(Message):
        """The request of ToggleFilterProcessing."""

        on: bool = False

    class Response(Message):
        """The response of ToggleFilterProcessing."""

        status: bool = False
