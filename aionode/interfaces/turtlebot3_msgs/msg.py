"""Messages of turtlebot3_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, float32, int32, uint8

__all__ = ["SensorState", "Sound", "VersionInfo"]


class SensorState(Message, typename="turtlebot3_msgs/msg/SensorState"):
    """SensorState, as TurtleBot 3 defines it."""

    BUMPER_FORWARD: ClassVar[uint8] = 1
    BUMPER_BACKWARD: ClassVar[uint8] = 2
    CLIFF: ClassVar[uint8] = 1
    SONAR: ClassVar[uint8] = 1
    ILLUMINATION: ClassVar[uint8] = 1
    BUTTON0: ClassVar[uint8] = 1
    BUTTON1: ClassVar[uint8] = 2
    ERROR_LEFT_MOTOR: ClassVar[uint8] = 1
    ERROR_RIGHT_MOTOR: ClassVar[uint8] = 2
    TORQUE_ON: ClassVar[uint8] = 1
    TORQUE_OFF: ClassVar[uint8] = 2

    header: Header = DEFAULT
    bumper: uint8 = 0
    cliff: float32 = 0.0
    sonar: float32 = 0.0
    illumination: float32 = 0.0
    led: uint8 = 0
    button: uint8 = 0
    torque: bool = False
    left_encoder: int32 = 0
    right_encoder: int32 = 0
    battery: float32 = 0.0


class Sound(Message, typename="turtlebot3_msgs/msg/Sound"):
    """Sound, as TurtleBot 3 defines it."""

    OFF: ClassVar[uint8] = 0
    ON: ClassVar[uint8] = 1
    LOW_BATTERY: ClassVar[uint8] = 2
    ERROR: ClassVar[uint8] = 3
    BUTTON1: ClassVar[uint8] = 4
    BUTTON2: ClassVar[uint8] = 5

    value: uint8 = 0


class VersionInfo(Message, typename="turtlebot3_msgs/msg/VersionInfo"):
    """VersionInfo, as TurtleBot 3 defines it."""

    hardware: str = ""
    firmware: str = ""
    software: str = ""
