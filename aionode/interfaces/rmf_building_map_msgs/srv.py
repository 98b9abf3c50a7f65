"""Services of rmf_building_map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.rmf_building_map_msgs.msg import BuildingMap
from aionode.message import DEFAULT, Message, ServiceType

__all__ = ["GetBuildingMap"]


class GetBuildingMap(ServiceType, typename="rmf_building_map_msgs/srv/GetBuildingMap"):
    """GetBuildingMap, as Open-RMF defines it."""

    class Request(Message):
        """The request of GetBuildingMap."""

    class Response(Message):
        """The response of GetBuildingMap."""

        building_map: BuildingMap = DEFAULT
