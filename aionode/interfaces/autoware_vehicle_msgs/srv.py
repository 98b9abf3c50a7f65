"""Services of autoware_vehicle_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, ServiceType, uint8

__all__ = ["ControlModeCommand"]


class ControlModeCommand(ServiceType, typename="autoware_vehicle_msgs/srv/ControlModeCommand"):
    """ControlModeCommand, as Autoware defines it."""

    class Request(Message):
        """The request of ControlModeCommand."""

        NO_COMMAND: ClassVar[uint8] = 0
        AUTONOMOUS: ClassVar[uint8] = 1
        AUTONOMOUS_STEER_ONLY: ClassVar[uint8] = 2
        AUTONOMOUS_VELOCITY_ONLY: ClassVar[uint8] = 3
        MANUAL: ClassVar[uint8] = 4

        stamp: Time = DEFAULT
        mode: uint8 = 0

    class Response(Message):
        """The response of ControlModeCommand."""

        success: bool = False
