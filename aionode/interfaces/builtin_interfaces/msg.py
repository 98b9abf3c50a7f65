"""Messages of builtin_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, int32, uint32

__all__ = ["Duration", "Time"]


class Time(Message, typename="builtin_interfaces/msg/Time"):
    """Time."""

    sec: int32 = 0
    nanosec: uint32 = 0


class Duration(Message, typename="builtin_interfaces/msg/Duration"):
    """Duration."""

    sec: int32 = 0
    nanosec: uint32 = 0
