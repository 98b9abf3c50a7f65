"""Messages of create_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Bytes, Floats, Message, Sequence, float32, uint8, uint16

__all__ = ["Bumper", "ChargingState", "Cliff", "DefineSong", "Mode", "MotorSetpoint", "PlaySong"]


class Bumper(Message, typename="create_msgs/msg/Bumper"):
    """Bumper, as create_robot defines it."""

    header: Header = DEFAULT
    is_left_pressed: bool = False
    is_right_pressed: bool = False
    is_light_left: bool = False
    is_light_front_left: bool = False
    is_light_center_left: bool = False
    is_light_center_right: bool = False
    is_light_front_right: bool = False
    is_light_right: bool = False
    light_signal_left: uint16 = 0
    light_signal_front_left: uint16 = 0
    light_signal_center_left: uint16 = 0
    light_signal_center_right: uint16 = 0
    light_signal_front_right: uint16 = 0
    light_signal_right: uint16 = 0


class ChargingState(Message, typename="create_msgs/msg/ChargingState"):
    """ChargingState, as create_robot defines it."""

    CHARGE_NONE: ClassVar[uint8] = 0
    CHARGE_RECONDITION: ClassVar[uint8] = 1
    CHARGE_FULL: ClassVar[uint8] = 2
    CHARGE_TRICKLE: ClassVar[uint8] = 3
    CHARGE_WAITING: ClassVar[uint8] = 4
    CHARGE_FAULT: ClassVar[uint8] = 5

    header: Header = DEFAULT
    state: uint8 = 0


class Cliff(Message, typename="create_msgs/msg/Cliff"):
    """Cliff, as create_robot defines it."""

    header: Header = DEFAULT
    is_cliff_left: bool = False
    is_cliff_front_left: bool = False
    is_cliff_right: bool = False
    is_cliff_front_right: bool = False


class DefineSong(Message, typename="create_msgs/msg/DefineSong"):
    """DefineSong, as create_robot defines it."""

    song: uint8 = 0
    length: uint8 = 0
    notes: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    durations: Annotated[Floats, Sequence[float32]] = DEFAULT


class Mode(Message, typename="create_msgs/msg/Mode"):
    """Mode, as create_robot defines it."""

    MODE_OFF: ClassVar[uint8] = 0
    MODE_PASSIVE: ClassVar[uint8] = 1
    MODE_SAFE: ClassVar[uint8] = 2
    MODE_FULL: ClassVar[uint8] = 3

    header: Header = DEFAULT
    mode: uint8 = 0


class MotorSetpoint(Message, typename="create_msgs/msg/MotorSetpoint"):
    """MotorSetpoint, as create_robot defines it."""

    duty_cycle: float32 = 0.0


class PlaySong(Message, typename="create_msgs/msg/PlaySong"):
    """PlaySong, as create_robot defines it."""

    song: uint8 = 0
