"""Services of autoware_system_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.autoware_common_msgs.msg import ResponseStatus
from aionode.message import DEFAULT, Message, ServiceType, uint16

__all__ = ["ChangeAutowareControl", "ChangeOperationMode"]


class ChangeAutowareControl(ServiceType, typename="autoware_system_msgs/srv/ChangeAutowareControl"):
    """ChangeAutowareControl, as Autoware defines it."""

    class Request(Message):
        """The request of ChangeAutowareControl."""

        autoware_control: bool = False

    class Response(Message):
        """The response of ChangeAutowareControl."""

        status: ResponseStatus = DEFAULT


class ChangeOperationMode(ServiceType, typename="autoware_system_msgs/srv/ChangeOperationMode"):
    """ChangeOperationMode, as Autoware defines it."""

    class Request(Message):
        """The request of ChangeOperationMode."""

        STOP: ClassVar[uint16] = 1
        AUTONOMOUS: ClassVar[uint16] = 2
        LOCAL: ClassVar[uint16] = 3
        REMOTE: ClassVar[uint16] = 4

        mode: uint16 = 0

    class Response(Message):
        """The response of ChangeOperationMode."""

        status: ResponseStatus = DEFAULT
