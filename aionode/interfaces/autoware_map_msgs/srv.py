"""Services of autoware_map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.autoware_map_msgs.msg import (
    AreaInfo,
    LaneletMapBin,
    PointCloudMapCellWithID,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = [
    "GetDifferentialPointCloudMap",
    "GetPartialPointCloudMap",
    "GetSelectedLanelet2Map",
    "GetSelectedPointCloudMap",
]


class GetDifferentialPointCloudMap(
    ServiceType, typename="autoware_map_msgs/srv/GetDifferentialPointCloudMap"
):
    """GetDifferentialPointCloudMap, as Autoware defines it."""

    class Request(Message):
        """The request of GetDifferentialPointCloudMap."""

        area: AreaInfo = DEFAULT
        cached_ids: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetDifferentialPointCloudMap."""

        header: Header = DEFAULT
        new_pointcloud_with_ids: Annotated[
            list[PointCloudMapCellWithID], Sequence[PointCloudMapCellWithID]
        ] = DEFAULT
        ids_to_remove: Annotated[list[str], Sequence[str]] = DEFAULT


class GetPartialPointCloudMap(
    ServiceType, typename="autoware_map_msgs/srv/GetPartialPointCloudMap"
):
    """GetPartialPointCloudMap, as Autoware defines it."""

    class Request(Message):
        """The request of GetPartialPointCloudMap."""

        area: AreaInfo = DEFAULT

    class Response(Message):
        """The response of GetPartialPointCloudMap."""

        header: Header = DEFAULT
        new_pointcloud_with_ids: Annotated[
            list[PointCloudMapCellWithID], Sequence[PointCloudMapCellWithID]
        ] = DEFAULT


class GetSelectedLanelet2Map(ServiceType, typename="autoware_map_msgs/srv/GetSelectedLanelet2Map"):
    """GetSelectedLanelet2Map, as Autoware defines it."""

    class Request(Message):
        """The request of GetSelectedLanelet2Map."""

        cell_ids: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetSelectedLanelet2Map."""

        header: Header = DEFAULT
        lanelet2_cells: LaneletMapBin = DEFAULT


class GetSelectedPointCloudMap(
    ServiceType, typename="autoware_map_msgs/srv/GetSelectedPointCloudMap"
):
    """GetSelectedPointCloudMap, as Autoware defines it."""

    class Request(Message):
        """The request of GetSelectedPointCloudMap."""

        cell_ids: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetSelectedPointCloudMap."""

        header: Header = DEFAULT
        new_pointcloud_with_ids: Annotated[
            list[PointCloudMapCellWithID], Sequence[PointCloudMapCellWithID]
        ] = DEFAULT
