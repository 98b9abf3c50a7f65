"""Messages of can_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Array, Ints, Message, uint8, uint32

__all__ = ["Frame"]


class Frame(Message, typename="can_msgs/msg/Frame"):
    """Frame, as ros_canopen defines it."""

    header: Header = DEFAULT
    id: uint32 = 0
    is_rtr: bool = False
    is_extended: bool = False
    is_error: bool = False
    dlc: uint8 = 0
    data: Annotated[Ints, Array[uint8, 8]] = DEFAULT
