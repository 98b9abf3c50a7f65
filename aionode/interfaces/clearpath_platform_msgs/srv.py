"""Services of clearpath_platform_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType, uint8

__all__ = ["ConfigureMcu"]


class ConfigureMcu(ServiceType, typename="clearpath_platform_msgs/srv/ConfigureMcu"):
    """ConfigureMcu, as Clearpath defines it."""

    class Request(Message):
        """The request of ConfigureMcu."""

        domain_id: uint8 = 0
        robot_namespace: str = ""

    class Response(Message):
        """The response of ConfigureMcu."""

        success: bool = False
        message: str = ""
