"""Messages of rmf_charger_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.message import DEFAULT, Message, uint32

__all__ = ["ChargerCancel", "ChargerRequest", "ChargerState"]


class ChargerCancel(Message, typename="rmf_charger_msgs/msg/ChargerCancel"):
    """ChargerCancel, as Open-RMF defines it."""

    charger_name: str = ""
    request_id: str = ""


class ChargerRequest(Message, typename="rmf_charger_msgs/msg/ChargerRequest"):
    """ChargerRequest, as Open-RMF defines it."""

    charger_name: str = ""
    fleet_name: str = ""
    robot_name: str = ""
    start_timeout: Duration = DEFAULT
    request_id: str = ""


class ChargerState(Message, typename="rmf_charger_msgs/msg/ChargerState"):
    """ChargerState, as Open-RMF defines it."""

    CHARGER_IDLE: ClassVar[uint32] = 1
    CHARGER_ASSIGNED: ClassVar[uint32] = 2
    CHARGER_CHARGING: ClassVar[uint32] = 3
    CHARGER_RELEASED: ClassVar[uint32] = 4
    CHARGER_ERROR: ClassVar[uint32] = 200

    charger_time: Time = DEFAULT
    state: uint32 = 0
    charger_name: str = ""
    error_message: str = ""
    request_id: str = ""
    robot_fleet: str = ""
    robot_name: str = ""
    time_to_fully_charged: Duration = DEFAULT
