"""Services of nav_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from aionode.interfaces.nav_msgs.msg import OccupancyGrid, Path
from aionode.message import DEFAULT, Message, ServiceType, float32, uint8

__all__ = ["GetMap", "GetPlan", "LoadMap", "SetMap"]


class GetMap(ServiceType, typename="nav_msgs/srv/GetMap"):
    """GetMap."""

    class Request(Message):
        """The request of GetMap."""

    class Response(Message):
        """The response of GetMap."""

        map: OccupancyGrid = DEFAULT


class GetPlan(ServiceType, typename="nav_msgs/srv/GetPlan"):
    """GetPlan."""

    class Request(Message):
        """The request of GetPlan."""

        start: PoseStamped = DEFAULT
        goal: PoseStamped = DEFAULT
        tolerance: float32 = 0.0

    class Response(Message):
        """The response of GetPlan."""

        plan: Path = DEFAULT


class LoadMap(ServiceType, typename="nav_msgs/srv/LoadMap"):
    """LoadMap."""

    class Request(Message):
        """The request of LoadMap."""

        map_url: str = ""

    class Response(Message):
        """The response of LoadMap."""

        RESULT_SUCCESS: ClassVar[uint8] = 0
        RESULT_MAP_DOES_NOT_EXIST: ClassVar[uint8] = 1
        RESULT_INVALID_MAP_DATA: ClassVar[uint8] = 2
        RESULT_INVALID_MAP_METADATA: ClassVar[uint8] = 3
        RESULT_UNDEFINED_FAILURE: ClassVar[uint8] = 255

        map: OccupancyGrid = DEFAULT
        result: uint8 = 0


class SetMap(ServiceType, typename="nav_msgs/srv/SetMap"):
    """SetMap."""

    class Request(Message):
        """The request of SetMap."""

        map: OccupancyGrid = DEFAULT
        initial_pose: PoseWithCovarianceStamped = DEFAULT

    class Response(Message):
        """The response of SetMap."""

        success: bool = False
