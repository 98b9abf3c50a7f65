"""Messages of autoware_v2x_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, Sequence, uint16

__all__ = [
    "VirtualGateAreaCommand",
    "VirtualGateAreaStatus",
    "VirtualGateCommand",
    "VirtualGateStatus",
]


class VirtualGateAreaCommand(Message, typename="autoware_v2x_msgs/msg/VirtualGateAreaCommand"):
    """VirtualGateAreaCommand, as Autoware defines it."""

    ACQUIRE: ClassVar[uint16] = 1
    RELEASE: ClassVar[uint16] = 2

    command: uint16 = 0
    sequence_id: uint16 = 0
    area_id: str = ""
    gate_ids: Annotated[list[str], Sequence[str]] = DEFAULT
    expected_time_arrival: Annotated[list[Time], Sequence[Time, 1]] = DEFAULT


class VirtualGateAreaStatus(Message, typename="autoware_v2x_msgs/msg/VirtualGateAreaStatus"):
    """VirtualGateAreaStatus, as Autoware defines it."""

    RESERVED: ClassVar[uint16] = 1
    ACQUIRED: ClassVar[uint16] = 2
    RELEASED: ClassVar[uint16] = 3

    stamp: Time = DEFAULT
    status: uint16 = 0
    sequence_id: uint16 = 0
    area_id: str = ""
    gate_ids: Annotated[list[str], Sequence[str]] = DEFAULT
    expected_time_arrival: Annotated[list[Time], Sequence[Time, 1]] = DEFAULT


class VirtualGateCommand(Message, typename="autoware_v2x_msgs/msg/VirtualGateCommand"):
    """VirtualGateCommand, as Autoware defines it."""

    stamp: Time = DEFAULT
    areas: Annotated[list[VirtualGateAreaCommand], Sequence[VirtualGateAreaCommand]] = DEFAULT


class VirtualGateStatus(Message, typename="autoware_v2x_msgs/msg/VirtualGateStatus"):
    """VirtualGateStatus, as Autoware defines it."""

    areas: Annotated[list[VirtualGateAreaStatus], Sequence[VirtualGateAreaStatus]] = DEFAULT
