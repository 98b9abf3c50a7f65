"""Messages of rmf_door_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, Sequence, uint32

__all__ = ["DoorMode", "DoorRequest", "DoorSessions", "DoorState", "Session", "SupervisorHeartbeat"]


class DoorMode(Message, typename="rmf_door_msgs/msg/DoorMode"):
    """DoorMode, as Open-RMF defines it."""

    MODE_CLOSED: ClassVar[uint32] = 0
    MODE_MOVING: ClassVar[uint32] = 1
    MODE_OPEN: ClassVar[uint32] = 2
    MODE_OFFLINE: ClassVar[uint32] = 3
    MODE_UNKNOWN: ClassVar[uint32] = 4

    value: uint32 = 0


class DoorRequest(Message, typename="rmf_door_msgs/msg/DoorRequest"):
    """DoorRequest, as Open-RMF defines it."""

    request_time: Time = DEFAULT
    requester_id: str = ""
    door_name: str = ""
    requested_mode: DoorMode = DEFAULT


class Session(Message, typename="rmf_door_msgs/msg/Session"):
    """Session, as Open-RMF defines it."""

    request_time: Time = DEFAULT
    requester_id: str = ""


class DoorSessions(Message, typename="rmf_door_msgs/msg/DoorSessions"):
    """DoorSessions, as Open-RMF defines it."""

    door_name: str = ""
    sessions: Annotated[list[Session], Sequence[Session]] = DEFAULT


class DoorState(Message, typename="rmf_door_msgs/msg/DoorState"):
    """DoorState, as Open-RMF defines it."""

    door_time: Time = DEFAULT
    door_name: str = ""
    current_mode: DoorMode = DEFAULT


class SupervisorHeartbeat(Message, typename="rmf_door_msgs/msg/SupervisorHeartbeat"):
    """SupervisorHeartbeat, as Open-RMF defines it."""

    all_sessions: Annotated[list[DoorSessions], Sequence[DoorSessions]] = DEFAULT
