"""Services of nav2_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from aionode.interfaces.nav2_msgs.msg import Costmap, CostmapMetaData, EdgeCost
from aionode.interfaces.nav_msgs.msg import OccupancyGrid, Path
from aionode.interfaces.std_msgs.msg import Empty
from aionode.message import (
    DEFAULT,
    Ints,
    Message,
    Sequence,
    ServiceType,
    float32,
    float64,
    int32,
    uint8,
    uint16,
)

__all__ = [
    "ClearCostmapAroundPose",
    "ClearCostmapAroundRobot",
    "ClearCostmapExceptRegion",
    "ClearEntireCostmap",
    "DynamicEdges",
    "GetCost",
    "GetCostmap",
    "IsPathValid",
    "LoadMap",
    "ManageLifecycleNodes",
    "ReloadDockDatabase",
    "SaveMap",
    "SetInitialPose",
    "SetRouteGraph",
    "Toggle",
]


class ClearCostmapAroundPose(ServiceType, typename="nav2_msgs/srv/ClearCostmapAroundPose"):
    """ClearCostmapAroundPose, as Nav2 defines it."""

    class Request(Message):
        """The request of ClearCostmapAroundPose."""

        pose: PoseStamped = DEFAULT
        reset_distance: float64 = 0.0

    class Response(Message):
        """The response of ClearCostmapAroundPose."""

        response: Empty = DEFAULT


class ClearCostmapAroundRobot(ServiceType, typename="nav2_msgs/srv/ClearCostmapAroundRobot"):
    """ClearCostmapAroundRobot, as Nav2 defines it."""

    class Request(Message):
        """The request of ClearCostmapAroundRobot."""

        reset_distance: float32 = 0.0

    class Response(Message):
        """The response of ClearCostmapAroundRobot."""

        response: Empty = DEFAULT


class ClearCostmapExceptRegion(ServiceType, typename="nav2_msgs/srv/ClearCostmapExceptRegion"):
    """ClearCostmapExceptRegion, as Nav2 defines it."""

    class Request(Message):
        """The request of ClearCostmapExceptRegion."""

        reset_distance: float32 = 0.0

    class Response(Message):
        """The response of ClearCostmapExceptRegion."""

        response: Empty = DEFAULT


class ClearEntireCostmap(ServiceType, typename="nav2_msgs/srv/ClearEntireCostmap"):
    """ClearEntireCostmap, as Nav2 defines it."""

    class Request(Message):
        """The request of ClearEntireCostmap."""

        request: Empty = DEFAULT

    class Response(Message):
        """The response of ClearEntireCostmap."""

        response: Empty = DEFAULT


class DynamicEdges(ServiceType, typename="nav2_msgs/srv/DynamicEdges"):
    """DynamicEdges, as Nav2 defines it."""

    class Request(Message):
        """The request of DynamicEdges."""

        closed_edges: Annotated[Ints, Sequence[uint16]] = DEFAULT
        opened_edges: Annotated[Ints, Sequence[uint16]] = DEFAULT
        adjust_edges: Annotated[list[EdgeCost], Sequence[EdgeCost]] = DEFAULT

    class Response(Message):
        """The response of DynamicEdges."""

        success: bool = False


class GetCost(ServiceType, typename="nav2_msgs/srv/GetCost"):
    """GetCost, as Nav2 defines it."""

    class Request(Message):
        """The request of GetCost."""

        use_footprint: bool = False
        x: float32 = 0.0
        y: float32 = 0.0
        theta: float32 = 0.0

    class Response(Message):
        """The response of GetCost."""

        cost: float32 = 0.0


class GetCostmap(ServiceType, typename="nav2_msgs/srv/GetCostmap"):
    """GetCostmap, as Nav2 defines it."""

    class Request(Message):
        """The request of GetCostmap."""

        specs: CostmapMetaData = DEFAULT

    class Response(Message):
        """The response of GetCostmap."""

        map: Costmap = DEFAULT


class IsPathValid(ServiceType, typename="nav2_msgs/srv/IsPathValid"):
    """IsPathValid, as Nav2 defines it."""

    class Request(Message):
        """The request of IsPathValid."""

        path: Path = DEFAULT

    class Response(Message):
        """The response of IsPathValid."""

        is_valid: bool = False
        invalid_pose_indices: Annotated[Ints, Sequence[int32]] = DEFAULT


class LoadMap(ServiceType, typename="nav2_msgs/srv/LoadMap"):
    """LoadMap, as Nav2 defines it."""

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


class ManageLifecycleNodes(ServiceType, typename="nav2_msgs/srv/ManageLifecycleNodes"):
    """ManageLifecycleNodes, as Nav2 defines it."""

    class Request(Message):
        """The request of ManageLifecycleNodes."""

        STARTUP: ClassVar[uint8] = 0
        PAUSE: ClassVar[uint8] = 1
        RESUME: ClassVar[uint8] = 2
        RESET: ClassVar[uint8] = 3
        SHUTDOWN: ClassVar[uint8] = 4
        CONFIGURE: ClassVar[uint8] = 5
        CLEANUP: ClassVar[uint8] = 6

        command: uint8 = 0

    class Response(Message):
        """The response of ManageLifecycleNodes."""

        success: bool = False


class ReloadDockDatabase(ServiceType, typename="nav2_msgs/srv/ReloadDockDatabase"):
    """ReloadDockDatabase, as Nav2 defines it."""

    class Request(Message):
        """The request of ReloadDockDatabase."""

        filepath: str = ""

    class Response(Message):
        """The response of ReloadDockDatabase."""

        success: bool = False


class SaveMap(ServiceType, typename="nav2_msgs/srv/SaveMap"):
    """SaveMap, as Nav2 defines it."""

    class Request(Message):
        """The request of SaveMap."""

        map_topic: str = ""
        map_url: str = ""
        image_format: str = ""
        map_mode: str = ""
        free_thresh: float32 = 0.0
        occupied_thresh: float32 = 0.0

    class Response(Message):
        """The response of SaveMap."""

        result: bool = False


class SetInitialPose(ServiceType, typename="nav2_msgs/srv/SetInitialPose"):
    """SetInitialPose, as Nav2 defines it."""

    class Request(Message):
        """The request of SetInitialPose."""

        pose: PoseWithCovarianceStamped = DEFAULT

    class Response(Message):
        """The response of SetInitialPose."""


class SetRouteGraph(ServiceType, typename="nav2_msgs/srv/SetRouteGraph"):
    """SetRouteGraph, as Nav2 defines it."""

    class Request(Message):
        """The request of SetRouteGraph."""

        graph_filepath: str = ""

    class Response(Message):
        """The response of SetRouteGraph."""

        success: bool = False


class Toggle(ServiceType, typename="nav2_msgs/srv/Toggle"):
    """Toggle, as Nav2 defines it."""

    class Request(Message):
        """The request of Toggle."""

        enable: bool = False

    class Response(Message):
        """The response of Toggle."""

        success: bool = False
        message: str = ""
