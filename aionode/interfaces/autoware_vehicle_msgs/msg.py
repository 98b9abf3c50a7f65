"""Messages of autoware_vehicle_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, float32, uint8

__all__ = [
    "ControlModeReport",
    "Engage",
    "GearCommand",
    "GearReport",
    "HazardLightsCommand",
    "HazardLightsReport",
    "SteeringReport",
    "TurnIndicatorsCommand",
    "TurnIndicatorsReport",
    "VelocityReport",
]


class ControlModeReport(Message, typename="autoware_vehicle_msgs/msg/ControlModeReport"):
    """ControlModeReport, as Autoware defines it."""

    NO_COMMAND: ClassVar[uint8] = 0
    AUTONOMOUS: ClassVar[uint8] = 1
    AUTONOMOUS_STEER_ONLY: ClassVar[uint8] = 2
    AUTONOMOUS_VELOCITY_ONLY: ClassVar[uint8] = 3
    MANUAL: ClassVar[uint8] = 4
    DISENGAGED: ClassVar[uint8] = 5
    NOT_READY: ClassVar[uint8] = 6

    stamp: Time = DEFAULT
    mode: uint8 = 0


class Engage(Message, typename="autoware_vehicle_msgs/msg/Engage"):
    """Engage, as Autoware defines it."""

    stamp: Time = DEFAULT
    engage: bool = False


class GearCommand(Message, typename="autoware_vehicle_msgs/msg/GearCommand"):
    """GearCommand, as Autoware defines it."""

    NONE: ClassVar[uint8] = 0
    NEUTRAL: ClassVar[uint8] = 1
    DRIVE: ClassVar[uint8] = 2
    DRIVE_2: ClassVar[uint8] = 3
    DRIVE_3: ClassVar[uint8] = 4
    DRIVE_4: ClassVar[uint8] = 5
    DRIVE_5: ClassVar[uint8] = 6
    DRIVE_6: ClassVar[uint8] = 7
    DRIVE_7: ClassVar[uint8] = 8
    DRIVE_8: ClassVar[uint8] = 9
    DRIVE_9: ClassVar[uint8] = 10
    DRIVE_10: ClassVar[uint8] = 11
    DRIVE_11: ClassVar[uint8] = 12
    DRIVE_12: ClassVar[uint8] = 13
    DRIVE_13: ClassVar[uint8] = 14
    DRIVE_14: ClassVar[uint8] = 15
    DRIVE_15: ClassVar[uint8] = 16
    DRIVE_16: ClassVar[uint8] = 17
    DRIVE_17: ClassVar[uint8] = 18
    DRIVE_18: ClassVar[uint8] = 19
    REVERSE: ClassVar[uint8] = 20
    REVERSE_2: ClassVar[uint8] = 21
    PARK: ClassVar[uint8] = 22
    LOW: ClassVar[uint8] = 23
    LOW_2: ClassVar[uint8] = 24

    stamp: Time = DEFAULT
    command: uint8 = 0


class GearReport(Message, typename="autoware_vehicle_msgs/msg/GearReport"):
    """GearReport, as Autoware defines it."""

    NONE: ClassVar[uint8] = 0
    NEUTRAL: ClassVar[uint8] = 1
    DRIVE: ClassVar[uint8] = 2
    DRIVE_2: ClassVar[uint8] = 3
    DRIVE_3: ClassVar[uint8] = 4
    DRIVE_4: ClassVar[uint8] = 5
    DRIVE_5: ClassVar[uint8] = 6
    DRIVE_6: ClassVar[uint8] = 7
    DRIVE_7: ClassVar[uint8] = 8
    DRIVE_8: ClassVar[uint8] = 9
    DRIVE_9: ClassVar[uint8] = 10
    DRIVE_10: ClassVar[uint8] = 11
    DRIVE_11: ClassVar[uint8] = 12
    DRIVE_12: ClassVar[uint8] = 13
    DRIVE_13: ClassVar[uint8] = 14
    DRIVE_14: ClassVar[uint8] = 15
    DRIVE_15: ClassVar[uint8] = 16
    DRIVE_16: ClassVar[uint8] = 17
    DRIVE_17: ClassVar[uint8] = 18
    DRIVE_18: ClassVar[uint8] = 19
    REVERSE: ClassVar[uint8] = 20
    REVERSE_2: ClassVar[uint8] = 21
    PARK: ClassVar[uint8] = 22
    LOW: ClassVar[uint8] = 23
    LOW_2: ClassVar[uint8] = 24

    stamp: Time = DEFAULT
    report: uint8 = 0


class HazardLightsCommand(Message, typename="autoware_vehicle_msgs/msg/HazardLightsCommand"):
    """HazardLightsCommand, as Autoware defines it."""

    NO_COMMAND: ClassVar[uint8] = 0
    DISABLE: ClassVar[uint8] = 1
    ENABLE: ClassVar[uint8] = 2

    stamp: Time = DEFAULT
    command: uint8 = 0


class HazardLightsReport(Message, typename="autoware_vehicle_msgs/msg/HazardLightsReport"):
    """HazardLightsReport, as Autoware defines it."""

    DISABLE: ClassVar[uint8] = 1
    ENABLE: ClassVar[uint8] = 2

    stamp: Time = DEFAULT
    report: uint8 = 0


class SteeringReport(Message, typename="autoware_vehicle_msgs/msg/SteeringReport"):
    """SteeringReport, as Autoware defines it."""

    stamp: Time = DEFAULT
    steering_tire_angle: float32 = 0.0


class TurnIndicatorsCommand(Message, typename="autoware_vehicle_msgs/msg/TurnIndicatorsCommand"):
    """TurnIndicatorsCommand, as Autoware defines it."""

    NO_COMMAND: ClassVar[uint8] = 0
    DISABLE: ClassVar[uint8] = 1
    ENABLE_LEFT: ClassVar[uint8] = 2
    ENABLE_RIGHT: ClassVar[uint8] = 3

    stamp: Time = DEFAULT
    command: uint8 = 0


class TurnIndicatorsReport(Message, typename="autoware_vehicle_msgs/msg/TurnIndicatorsReport"):
    """TurnIndicatorsReport, as Autoware defines it."""

    DISABLE: ClassVar[uint8] = 1
    ENABLE_LEFT: ClassVar[uint8] = 2
    ENABLE_RIGHT: ClassVar[uint8] = 3

    stamp: Time = DEFAULT
    report: uint8 = 0


class VelocityReport(Message, typename="autoware_vehicle_msgs/msg/VelocityReport"):
    """VelocityReport, as Autoware defines it."""

    header: Header = DEFAULT
    longitudinal_velocity: float32 = 0.0
    lateral_velocity: float32 = 0.0
    heading_rate: float32 = 0.0
