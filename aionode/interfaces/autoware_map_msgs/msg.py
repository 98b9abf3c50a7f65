"""Messages of autoware_map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geographic_msgs.msg import GeoPoint
from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Bytes, Message, Sequence, float32, float64, uint8

__all__ = [
    "AreaInfo",
    "LaneletMapBin",
    "LaneletMapCellMetaData",
    "LaneletMapMetaData",
    "MapProjectorInfo",
    "PointCloudMapCellMetaData",
    "PointCloudMapCellMetaDataWithID",
    "PointCloudMapCellWithID",
    "PointCloudMapMetaData",
]


class AreaInfo(Message, typename="autoware_map_msgs/msg/AreaInfo"):
    """AreaInfo, as Autoware defines it."""

    center_x: float32 = 0.0
    center_y: float32 = 0.0
    radius: float32 = 0.0


class LaneletMapBin(Message, typename="autoware_map_msgs/msg/LaneletMapBin"):
    """LaneletMapBin, as Autoware defines it."""

    header: Header = DEFAULT
    version_map_format: str = ""
    version_map: str = ""
    name_map: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class LaneletMapCellMetaData(Message, typename="autoware_map_msgs/msg/LaneletMapCellMetaData"):
    """LaneletMapCellMetaData, as Autoware defines it."""

    cell_id: str = ""
    min_x: float64 = 0.0
    max_x: float64 = 0.0
    min_y: float64 = 0.0
    max_y: float64 = 0.0


class LaneletMapMetaData(Message, typename="autoware_map_msgs/msg/LaneletMapMetaData"):
    """LaneletMapMetaData, as Autoware defines it."""

    header: Header = DEFAULT
    metadata_list: Annotated[list[LaneletMapCellMetaData], Sequence[LaneletMapCellMetaData]] = (
        DEFAULT
    )


class MapProjectorInfo(Message, typename="autoware_map_msgs/msg/MapProjectorInfo"):
    """MapProjectorInfo, as Autoware defines it."""

    LOCAL: ClassVar[str] = "Local"
    LOCAL_CARTESIAN_UTM: ClassVar[str] = "LocalCartesianUTM"
    LOCAL_CARTESIAN: ClassVar[str] = "LocalCartesian"
    MGRS: ClassVar[str] = "MGRS"
    TRANSVERSE_MERCATOR: ClassVar[str] = "TransverseMercator"
    WGS84: ClassVar[str] = "WGS84"
    EGM2008: ClassVar[str] = "EGM2008"

    projector_type: str = ""
    vertical_datum: str = ""
    mgrs_grid: str = ""
    map_origin: GeoPoint = DEFAULT
    scale_factor: float32 = 0.0


class PointCloudMapCellMetaData(
    Message, typename="autoware_map_msgs/msg/PointCloudMapCellMetaData"
):
    """PointCloudMapCellMetaData, as Autoware defines it."""

    min_x: float32 = 0.0
    min_y: float32 = 0.0
    max_x: float32 = 0.0
    max_y: float32 = 0.0


class PointCloudMapCellMetaDataWithID(
    Message, typename="autoware_map_msgs/msg/PointCloudMapCellMetaDataWithID"
):
    """PointCloudMapCellMetaDataWithID, as Autoware defines it."""

    cell_id: str = ""
    metadata: PointCloudMapCellMetaData = DEFAULT


class PointCloudMapCellWithID(Message, typename="autoware_map_msgs/msg/PointCloudMapCellWithID"):
    """PointCloudMapCellWithID, as Autoware defines it."""

    cell_id: str = ""
    pointcloud: PointCloud2 = DEFAULT
    metadata: PointCloudMapCellMetaData = DEFAULT


class PointCloudMapMetaData(Message, typename="autoware_map_msgs/msg/PointCloudMapMetaData"):
    """PointCloudMapMetaData, as Autoware defines it."""

    header: Header = DEFAULT
    metadata_list: Annotated[
        list[PointCloudMapCellMetaDataWithID], Sequence[PointCloudMapCellMetaDataWithID]
    ] = DEFAULT
