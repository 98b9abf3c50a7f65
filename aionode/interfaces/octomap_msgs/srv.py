"""Services of octomap_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geometry_msgs.msg import Point
from aionode.interfaces.octomap_msgs.msg import Octomap
from aionode.message import DEFAULT, Message, ServiceType

__all__ = ["BoundingBoxQuery", "GetOctomap"]


class BoundingBoxQuery(ServiceType, typename="octomap_msgs/srv/BoundingBoxQuery"):
    """BoundingBoxQuery, as OctoMap defines it."""

    class Request(Message):
        """The request of BoundingBoxQuery."""

        min: Point = DEFAULT
        max: Point = DEFAULT

    class Response(Message):
        """The response of BoundingBoxQuery."""


class GetOctomap(ServiceType, typename="octomap_msgs/srv/GetOctomap"):
    """GetOctomap, as OctoMap defines it."""

    class Request(Message):
        """The request of GetOctomap."""

    class Response(Message):
        """The response of GetOctomap."""

        map: Octomap = DEFAULT
