"""Messages of autoware_system_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.message import DEFAULT, Message, Sequence, uint8

__all__ = ["AutowareState", "HazardStatus", "HazardStatusStamped"]


class AutowareState(Message, typename="autoware_system_msgs/msg/AutowareState"):
    """AutowareState, as Autoware defines it."""

    INITIALIZING: ClassVar[uint8] = 1
    WAITING_FOR_ROUTE: ClassVar[uint8] = 2
    PLANNING: ClassVar[uint8] = 3
    WAITING_FOR_ENGAGE: ClassVar[uint8] = 4
    DRIVING: ClassVar[uint8] = 5
    ARRIVED_GOAL: ClassVar[uint8] = 6
    FINALIZING: ClassVar[uint8] = 7

    stamp: Time = DEFAULT
    state: uint8 = 0


class HazardStatus(Message, typename="autoware_system_msgs/msg/HazardStatus"):
    """HazardStatus, as Autoware defines it."""

    NO_FAULT: ClassVar[uint8] = 0
    SAFE_FAULT: ClassVar[uint8] = 1
    LATENT_FAULT: ClassVar[uint8] = 2
    SINGLE_POINT_FAULT: ClassVar[uint8] = 3

    level: uint8 = 0
    emergency: bool = False
    emergency_holding: bool = False
    diag_no_fault: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
    diag_safe_fault: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
    diag_latent_fault: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
    diag_single_point_fault: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT


class HazardStatusStamped(Message, typename="autoware_system_msgs/msg/HazardStatusStamped"):
    """HazardStatusStamped, as Autoware defines it."""

    stamp: Time = DEFAULT
    status: HazardStatus = DEFAULT
