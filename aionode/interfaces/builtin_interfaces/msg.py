"""builtin_interfaces."""

from aionode.message import Message, int32, uint32


class Duration(Message, typename="builtin_interfaces/msg/Duration"):
    """Duration."""

    sec: int32 = 0
    nanosec: uint32 = 0


class Time(Message, typename="builtin_interfaces/msg/Time"):
    """Time."""

    sec: int32 = 0
    nanosec: uint32 = 0
