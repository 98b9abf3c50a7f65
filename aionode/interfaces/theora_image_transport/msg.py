"""Messages of theora_image_transport.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Bytes, Message, Sequence, int32, int64, uint8

__all__ = ["Packet"]


class Packet(Message, typename="theora_image_transport/msg/Packet"):
    """Packet, as image_transport_plugins defines it."""

    header: Header = DEFAULT
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    b_o_s: int32 = 0
    e_o_s: int32 = 0
    granulepos: int64 = 0
    packetno: int64 = 0
