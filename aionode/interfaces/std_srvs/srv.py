"""Services of std_srvs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType

__all__ = ["Empty", "SetBool", "Trigger"]


class Empty(ServiceType, typename="std_srvs/srv/Empty"):
    """Have something done, with nothing to say before or after."""

    class Request(Message):
        """Nothing: the call is the request."""

    class Response(Message):
        """Nothing: that it came says that it was done."""


class SetBool(ServiceType, typename="std_srvs/srv/SetBool"):
    """Switch something on or off."""

    class Request(Message):
        """True switches it on."""

        data: bool = False

    class Response(Message):
        """Whether that worked, and a word on why not."""

        success: bool = False
        message: str = ""


class Trigger(ServiceType, typename="std_srvs/srv/Trigger"):
    """Have something done that needs no arguments."""

    class Request(Message):
        """Nothing: the call is the request."""

    class Response(Message):
        """Whether it was done, and a word on how."""

        success: bool = False
        message: str = ""
