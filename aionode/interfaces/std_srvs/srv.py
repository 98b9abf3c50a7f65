"""Services of std_srvs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType

__all__ = ["Empty", "SetBool", "Trigger"]


class Empty(ServiceType, typename="std_srvs/srv/Empty"):
    """Have something done, without arguments or a result."""

    class Request(Message):
        """Nothing: the call is the request."""

    class Response(Message):
        """Nothing: its arrival means that it was done."""


class SetBool(ServiceType, typename="std_srvs/srv/SetBool"):
    """Switch something on or off."""

    class Request(Message):
        """True switches it on."""

        data: bool = False

    class Response(Message):
        """Whether that worked, and if not, why."""

        success: bool = False
        message: str = ""


class Trigger(ServiceType, typename="std_srvs/srv/Trigger"):
    """Have something done that needs no arguments."""

    class Request(Message):
        """Nothing: the call is the request."""

    class Response(Message):
        """Whether it was done, and a text about it."""

        success: bool = False
        message: str = ""
