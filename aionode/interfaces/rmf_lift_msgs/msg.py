"""Messages of rmf_lift_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Bytes, Message, Sequence, uint8

__all__ = ["LiftRequest", "LiftState"]


class LiftRequest(Message, typename="rmf_lift_msgs/msg/LiftRequest"):
    """LiftRequest, as Open-RMF defines it."""

    REQUEST_END_SESSION: ClassVar[uint8] = 0
    REQUEST_AGV_MODE: ClassVar[uint8] = 1
    REQUEST_HUMAN_MODE: ClassVar[uint8] = 2
    DOOR_CLOSED: ClassVar[uint8] = 0
    DOOR_OPEN: ClassVar[uint8] = 2

    lift_name: str = ""
    request_time: Time = DEFAULT
    session_id: str = ""
    request_type: uint8 = 0
    destination_floor: str = ""
    door_state: uint8 = 0


class LiftState(Message, typename="rmf_lift_msgs/msg/LiftState"):
    """LiftState, as Open-RMF defines it."""

    DOOR_CLOSED: ClassVar[uint8] = 0
    DOOR_MOVING: ClassVar[uint8] = 1
    DOOR_OPEN: ClassVar[uint8] = 2
    MOTION_STOPPED: ClassVar[uint8] = 0
    MOTION_UP: ClassVar[uint8] = 1
    MOTION_DOWN: ClassVar[uint8] = 2
    MOTION_UNKNOWN: ClassVar[uint8] = 3
    MODE_UNKNOWN: ClassVar[uint8] = 0
    MODE_HUMAN: ClassVar[uint8] = 1
    MODE_AGV: ClassVar[uint8] = 2
    MODE_FIRE: ClassVar[uint8] = 3
    MODE_OFFLINE: ClassVar[uint8] = 4
    MODE_EMERGENCY: ClassVar[uint8] = 5

    lift_time: Time = DEFAULT
    lift_name: str = ""
    available_floors: Annotated[list[str], Sequence[str]] = DEFAULT
    current_floor: str = ""
    destination_floor: str = ""
    door_state: uint8 = 0
    motion_state: uint8 = 0
    available_modes: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    current_mode: uint8 = 0
    session_id: str = ""
