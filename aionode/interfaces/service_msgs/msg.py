"""Messages of service_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Array, Ints, Message, char, int64, uint8

__all__ = ["ServiceEventInfo"]


class ServiceEventInfo(Message, typename="service_msgs/msg/ServiceEventInfo"):
    """Which request or response of a service an event is about.

    Attributes:
        event_type: What happened, one of the constants.
        stamp: When it happened.
        client_gid: Id of the client.
        sequence_number: Number of the request; with `client_gid` it is unique.
    """

    REQUEST_SENT: ClassVar[uint8] = 0
    REQUEST_RECEIVED: ClassVar[uint8] = 1
    RESPONSE_SENT: ClassVar[uint8] = 2
    RESPONSE_RECEIVED: ClassVar[uint8] = 3

    event_type: uint8 = 0
    stamp: Time = DEFAULT
    client_gid: Annotated[Ints, Array[char, 16]] = DEFAULT
    sequence_number: int64 = 0
