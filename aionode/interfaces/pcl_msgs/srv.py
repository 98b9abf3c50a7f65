"""Services of pcl_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType

__all__ = ["UpdateFilename"]


class UpdateFilename(ServiceType, typename="pcl_msgs/srv/UpdateFilename"):
    """UpdateFilename, as perception_pcl defines it."""

    class Request(Message):
        """The request of UpdateFilename."""

        filename: str = ""

    class Response(Message):
        """The response of UpdateFilename."""

        success: bool = False
