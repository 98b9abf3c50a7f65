"""Messages of rtcm_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Bytes, Sequence, uint8
from aionode.message import Message as Message_

__all__ = ["Message"]


class Message(Message_, typename="rtcm_msgs/msg/Message"):
    """Message, as rtcm_msgs defines it."""

    header: Header = DEFAULT
    message: Annotated[Bytes, Sequence[uint8]] = DEFAULT
