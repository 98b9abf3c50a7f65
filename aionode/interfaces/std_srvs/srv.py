"""Services of std_srvs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType

__all__ = ["Empty", "SetBool", "Trigger"]


class Empty(ServiceType, typename="std_srvs/srv/Empty"):
    """Empty."""

    class Request(Message):
        """The request of Empty."""

    class Response(Message):
        """The response of Empty."""


class SetBool(ServiceType, typename="std_srvs/srv/SetBool"):
    """SetBool."""

    class Request(Message):
        """The request of SetBool."""

        data: bool = False

    class Response(Message):
        """The response of SetBool."""

        success: bool = False
        message: str = ""


class Trigger(ServiceType, typename="std_srvs/srv/Trigger"):
    """Trigger."""

    class Request(Message):
        """The request of Trigger."""

    class Response(Message):
        """The response of Trigger."""

        success: bool = False
        message: str = ""
