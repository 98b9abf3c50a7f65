"""example_interfaces."""

from aionode.message import Message, ServiceType, int64


class AddTwoInts(ServiceType, typename="example_interfaces/srv/AddTwoInts"):
    """AddTwoInts."""

    class Request(Message):
        """Request."""

        a: int64 = 0
        b: int64 = 0

    class Response(Message):
        """Response."""

        sum: int64 = 0


class SetBool(ServiceType, typename="example_interfaces/srv/SetBool"):
    """SetBool."""

    class Request(Message):
        """Request."""

        data: bool = False

    class Response(Message):
        """Response."""

        success: bool = False
        message: str = ""


class Trigger(ServiceType, typename="example_interfaces/srv/Trigger"):
    """Trigger."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        success: bool = False
        message: str = ""
