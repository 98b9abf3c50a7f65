"""Services of example_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType, int64

__all__ = ["AddTwoInts", "SetBool", "Trigger"]


class AddTwoInts(ServiceType, typename="example_interfaces/srv/AddTwoInts"):
    """Add two integers: the example of a service."""

    class Request(Message):
        """The two to add."""

        a: int64 = 0
        b: int64 = 0

    class Response(Message):
        """Their sum."""

        sum: int64 = 0


class SetBool(ServiceType, typename="example_interfaces/srv/SetBool"):
    """Switch something on or off."""

    class Request(Message):
        """True switches it on."""

        data: bool = False

    class Response(Message):
        """Whether that worked, and a word on why not."""

        success: bool = False
        message: str = ""


class Trigger(ServiceType, typename="example_interfaces/srv/Trigger"):
    """Have something done that needs no arguments."""

    class Request(Message):
        """Nothing: the call is the request."""

    class Response(Message):
        """Whether it was done, and a word on how."""

        success: bool = False
        message: str = ""
