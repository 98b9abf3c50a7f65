"""Messages of velodyne_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Array, Ints, Message, Sequence, uint8

__all__ = ["VelodynePacket", "VelodyneScan"]


class VelodynePacket(Message, typename="velodyne_msgs/msg/VelodynePacket"):
    """VelodynePacket, as Velodyne defines it."""

    stamp: Time = DEFAULT
    data: Annotated[Ints, Array[uint8, 1206]] = DEFAULT


class VelodyneScan(Message, typename="velodyne_msgs/msg/VelodyneScan"):
    """VelodyneScan, as Velodyne defines it."""

    header: Header = DEFAULT
    packets: Annotated[list[VelodynePacket], Sequence[VelodynePacket]] = DEFAULT
