"""Services of nav_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from aionode.interfaces.nav_msgs.msg import OccupancyGrid, Path
from aionode.message import DEFAULT, Message, ServiceType, float32, uint8

__all__ = ["GetMap", "GetPlan", "LoadMap", "SetMap"]


class GetMap(ServiceType, typename="nav_msgs/srv/GetMap"):
    """Ask for the map."""

    class Request(Message):
        """The request of GetMap."""

    class Response(Message):
        """The map."""

        map: OccupancyGrid = DEFAULT


class GetPlan(ServiceType, typename="nav_msgs/srv/GetPlan"):
    """Ask for a path to a goal."""

    class Request(Message):
        """From where and to where; `tolerance` is how far from the goal is close enough, in m."""

        start: PoseStamped = DEFAULT
        goal: PoseStamped = DEFAULT
        tolerance: float32 = 0.0

    class Response(Message):
        """The path, empty if there is none."""

        plan: Path = DEFAULT


class LoadMap(ServiceType, typename="nav_msgs/srv/LoadMap"):
    """Load a map."""

    class Request(Message):
        """Where the map is: a path or a URL."""

        map_url: str = ""

    class Response(Message):
        """The map, and the outcome of loading: one of the constants."""

        RESULT_SUCCESS: ClassVar[uint8] = 0
        RESULT_MAP_DOES_NOT_EXIST: ClassVar[uint8] = 1
        RESULT_INVALID_MAP_DATA: ClassVar[uint8] = 2
        RESULT_INVALID_MAP_METADATA: ClassVar[uint8] = 3
        RESULT_UNDEFINED_FAILURE: ClassVar[uint8] = 255

        map: OccupancyGrid = DEFAULT
        result: uint8 = 0


class SetMap(ServiceType, typename="nav_msgs/srv/SetMap"):
    """Set the map and the robot's pose in it."""

    class Request(Message):
        """The map, and where in it the robot is."""

        map: OccupancyGrid = DEFAULT
        initial_pose: PoseWithCovarianceStamped = DEFAULT

    class Response(Message):
        """Whether both were accepted."""

        success: bool = False
