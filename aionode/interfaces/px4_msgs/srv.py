"""Services of px4_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.px4_msgs.msg import VehicleCommand as Px4MsgsVehicleCommand
from aionode.interfaces.px4_msgs.msg import VehicleCommandAck
from aionode.message import DEFAULT, Message, ServiceType

__all__ = ["VehicleCommand"]


class VehicleCommand(ServiceType, typename="px4_msgs/srv/VehicleCommand"):
    """VehicleCommand, as PX4 1.15 defines it."""

    class Request(Message):
        """The request of VehicleCommand."""

        request: Px4MsgsVehicleCommand = DEFAULT

    class Response(Message):
        """The response of VehicleCommand."""

        reply: VehicleCommandAck = DEFAULT
