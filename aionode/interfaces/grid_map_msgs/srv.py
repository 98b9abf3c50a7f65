"""Services of grid_map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.grid_map_msgs.msg import GridMap, GridMapInfo
from aionode.message import DEFAULT, Message, Sequence, ServiceType, float64

__all__ = ["GetGridMap", "GetGridMapInfo", "ProcessFile", "SetGridMap"]


class GetGridMap(ServiceType, typename="grid_map_msgs/srv/GetGridMap"):
    """GetGridMap, as grid_map defines it."""

    class Request(Message):
        """The request of GetGridMap."""

        frame_id: str = ""
        position_x: float64 = 0.0
        position_y: float64 = 0.0
        length_x: float64 = 0.0
        length_y: float64 = 0.0
        layers: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetGridMap."""

        map: GridMap = DEFAULT


class GetGridMapInfo(ServiceType, typename="grid_map_msgs/srv/GetGridMapInfo"):
    """GetGridMapInfo, as grid_map defines it."""

    class Request(Message):
        """The request of GetGridMapInfo."""

    class Response(Message):
        """The response of GetGridMapInfo."""

        info: GridMapInfo = DEFAULT


class ProcessFile(ServiceType, typename="grid_map_msgs/srv/ProcessFile"):
    """ProcessFile, as grid_map defines it."""

    class Request(Message):
        """The request of ProcessFile."""

        file_path: str = ""
        topic_name: str = ""

    class Response(Message):
        """The response of ProcessFile."""

        success: bool = False


class SetGridMap(ServiceType, typename="grid_map_msgs/srv/SetGridMap"):
    """SetGridMap, as grid_map defines it."""

    class Request(Message):
        """The request of SetGridMap."""

        map: GridMap = DEFAULT

    class Response(Message):
        """The response of SetGridMap."""
