"""Messages of rmf_site_map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import DEFAULT, Bytes, Message, Sequence, uint8, uint32

__all__ = ["SiteMap"]


class SiteMap(Message, typename="rmf_site_map_msgs/msg/SiteMap"):
    """SiteMap, as Open-RMF defines it."""

    MAP_DATA_UNDEFINED: ClassVar[uint32] = 0
    MAP_DATA_GPKG: ClassVar[uint32] = 1
    MAP_DATA_GPKG_GZ: ClassVar[uint32] = 2
    MAP_DATA_GEOJSON: ClassVar[uint32] = 3
    MAP_DATA_GEOJSON_GZ: ClassVar[uint32] = 4

    encoding: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
