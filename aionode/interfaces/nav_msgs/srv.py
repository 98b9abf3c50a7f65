"""nav_msgs."""

from typing import ClassVar

from aionode.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from aionode.interfaces.nav_msgs.msg import OccupancyGrid, Path
from aionode.message import DEFAULT, Message, ServiceType, float32, uint8


class GetMap(ServiceType, typename="nav_msgs/srv/GetMap"):
    """GetMap."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        map: OccupancyGrid = DEFAULT


class GetPlan(ServiceType, typename="nav_msgs/srv/GetPlan"):
    """GetPlan."""

    class Request(Message):
        """Request."""

        start: PoseStamped = DEFAULT
        goal: PoseStamped = DEFAULT
        tolerance: float32 = 0.0

    class Response(Message):
        """Response."""

        plan: Path = DEFAULT


class LoadMap(ServiceType, typename="nav_msgs/srv/LoadMap"):
    """LoadMap."""

    class Request(Message):
        """Request."""

        map_url: str = ""

    class Response(Message):
        """Response."""

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
        """Request."""

        map: OccupancyGrid = DEFAULT
        initial_pose: PoseWithCovarianceStamped = DEFAULT

    class Response(Message):
        """Response."""

        success: bool = False
