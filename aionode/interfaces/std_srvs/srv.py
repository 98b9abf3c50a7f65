"""std_srvs."""

from aionode.message import Message, ServiceType


class Empty(ServiceType, typename="std_srvs/srv/Empty"):
    """Empty."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""


class SetBool(ServiceType, typename="std_srvs/srv/SetBool"):
    """SetBool."""

    class Request(Message):
        """Request."""

        data: bool = False

    class Response(Message):
        """Response."""

        success: bool = False
        message: str = ""


class Trigger(ServiceType, typename="std_srvs/srv/Trigger"):
    """Trigger."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        success: bool = False
        message: str = ""
