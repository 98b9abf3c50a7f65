"""Services of example_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType, int64

__all__ = ["AddTwoInts", "SetBool", "Trigger"]


class AddTwoInts(ServiceType, typename="example_interfaces/srv/AddTwoInts"):
    """AddTwoInts."""

    class Request(Message):
        """The request of AddTwoInts."""

        a: int64 = 0
        b: int64 = 0

    class Response(Message):
        """The response of AddTwoInts."""

        sum: int64 = 0


class SetBool(ServiceType, typename="example_interfaces/srv/SetBool"):
    """SetBool."""

    class Request(Message):
        """The request of SetBool."""

        data: bool = False

    class Response(Message):
        """The response of SetBool."""

        success: bool = False
        message: str = ""


class Trigger(ServiceType, typename="example_interfaces/srv/Trigger"):
    """Trigger."""

    class Request(Message):
        """The request of Trigger."""

    class Response(Message):
        """The response of Trigger."""

        success: bool = False
        message: str = ""
