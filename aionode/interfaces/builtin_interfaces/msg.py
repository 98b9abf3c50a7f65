"""Messages of builtin_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, int32, uint32

__all__ = ["Duration", "Time"]


class Time(Message, typename="builtin_interfaces/msg/Time"):
    """A point in time: since 1970 (UTC) for system time, else since the start of the clock.

    Attributes:
        sec: Whole seconds.
        nanosec: Nanoseconds to add, 0 to 999 999 999.
    """

    sec: int32 = 0
    nanosec: uint32 = 0


class Duration(Message, typename="builtin_interfaces/msg/Duration"):
    """A span of time, positive or negative.

    Attributes:
        sec: Whole seconds, rounded towards minus infinity.
        nanosec: Nanoseconds to add, 0 to 999 999 999.
    """

    sec: int32 = 0
    nanosec: uint32 = 0
