"""Messages of kobuki_ros_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT as DEFAULT_
from aionode.message import (
    Array,
    Bools,
    Bytes,
    Ints,
    Message,
    Sequence,
    float64,
    int8,
    uint8,
    uint16,
    uint32,
    uint64,
)

__all__ = [
    "BumperEvent",
    "ButtonEvent",
    "CliffEvent",
    "ControllerInfo",
    "DigitalInputEvent",
    "DigitalOutput",
    "DockInfraRed",
    "ExternalPower",
    "KeyboardInput",
    "Led",
    "MotorPower",
    "PowerSystemEvent",
    "RobotStateEvent",
    "ScanAngle",
    "SensorState",
    "Sound",
    "VersionInfo",
    "WheelDropEvent",
]


class BumperEvent(Message, typename="kobuki_ros_interfaces/msg/BumperEvent"):
    """BumperEvent, as Kobuki defines it."""

    LEFT: ClassVar[uint8] = 0
    CENTER: ClassVar[uint8] = 1
    RIGHT: ClassVar[uint8] = 2
    RELEASED: ClassVar[uint8] = 0
    PRESSED: ClassVar[uint8] = 1

    bumper: uint8 = 0
    state: uint8 = 0


class ButtonEvent(Message, typename="kobuki_ros_interfaces/msg/ButtonEvent"):
    """ButtonEvent, as Kobuki defines it."""

    BUTTON0: ClassVar[uint8] = 0
    BUTTON1: ClassVar[uint8] = 1
    BUTTON2: ClassVar[uint8] = 2
    RELEASED: ClassVar[uint8] = 0
    PRESSED: ClassVar[uint8] = 1

    button: uint8 = 0
    state: uint8 = 0


class CliffEvent(Message, typename="kobuki_ros_interfaces/msg/CliffEvent"):
    """CliffEvent, as Kobuki defines it."""

    LEFT: ClassVar[uint8] = 0
    CENTER: ClassVar[uint8] = 1
    RIGHT: ClassVar[uint8] = 2
    FLOOR: ClassVar[uint8] = 0
    CLIFF: ClassVar[uint8] = 1

    sensor: uint8 = 0
    state: uint8 = 0
    bottom: uint16 = 0


class ControllerInfo(Message, typename="kobuki_ros_interfaces/msg/ControllerInfo"):
    """ControllerInfo, as Kobuki defines it."""

    DEFAULT: ClassVar[uint8] = 0
    USER_CONFIGURED: ClassVar[uint8] = 1

    type: uint8 = 0
    p_gain: float64 = 0.0
    i_gain: float64 = 0.0
    d_gain: float64 = 0.0


class DigitalInputEvent(Message, typename="kobuki_ros_interfaces/msg/DigitalInputEvent"):
    """DigitalInputEvent, as Kobuki defines it."""

    values: Annotated[Bools, Array[bool, 4]] = DEFAULT_


class DigitalOutput(Message, typename="kobuki_ros_interfaces/msg/DigitalOutput"):
    """DigitalOutput, as Kobuki defines it."""

    values: Annotated[Bools, Array[bool, 4]] = DEFAULT_
    mask: Annotated[Bools, Array[bool, 4]] = DEFAULT_


class DockInfraRed(Message, typename="kobuki_ros_interfaces/msg/DockInfraRed"):
    """DockInfraRed, as Kobuki defines it."""

    NEAR_LEFT: ClassVar[uint8] = 1
    NEAR_CENTER: ClassVar[uint8] = 2
    NEAR_RIGHT: ClassVar[uint8] = 4
    FAR_LEFT: ClassVar[uint8] = 16
    FAR_CENTER: ClassVar[uint8] = 8
    FAR_RIGHT: ClassVar[uint8] = 32

    header: Header = DEFAULT_
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT_


class ExternalPower(Message, typename="kobuki_ros_interfaces/msg/ExternalPower"):
    """ExternalPower, as Kobuki defines it."""

    PWR_3_3V1A: ClassVar[uint8] = 0
    PWR_5V1A: ClassVar[uint8] = 1
    PWR_12V5A: ClassVar[uint8] = 2
    PWR_12V1_5A: ClassVar[uint8] = 3
    OFF: ClassVar[uint8] = 0
    ON: ClassVar[uint8] = 1

    source: uint8 = 0
    state: uint8 = 0


class KeyboardInput(Message, typename="kobuki_ros_interfaces/msg/KeyboardInput"):
    """KeyboardInput, as Kobuki defines it."""

    KEYCODE_RIGHT: ClassVar[uint8] = 67
    KEYCODE_LEFT: ClassVar[uint8] = 68
    KEYCODE_UP: ClassVar[uint8] = 65
    KEYCODE_DOWN: ClassVar[uint8] = 66
    KEYCODE_SPACE: ClassVar[uint8] = 32
    KEYCODE_ENABLE: ClassVar[uint8] = 101
    KEYCODE_DISABLE: ClassVar[uint8] = 100

    pressed_key: uint8 = 0


class Led(Message, typename="kobuki_ros_interfaces/msg/Led"):
    """Led, as Kobuki defines it."""

    BLACK: ClassVar[uint8] = 0
    GREEN: ClassVar[uint8] = 1
    ORANGE: ClassVar[uint8] = 2
    RED: ClassVar[uint8] = 3

    value: uint8 = 0


class MotorPower(Message, typename="kobuki_ros_interfaces/msg/MotorPower"):
    """MotorPower, as Kobuki defines it."""

    OFF: ClassVar[uint8] = 0
    ON: ClassVar[uint8] = 1

    state: uint8 = 0


class PowerSystemEvent(Message, typename="kobuki_ros_interfaces/msg/PowerSystemEvent"):
    """PowerSystemEvent, as Kobuki defines it."""

    UNPLUGGED: ClassVar[uint8] = 0
    PLUGGED_TO_ADAPTER: ClassVar[uint8] = 1
    PLUGGED_TO_DOCKBASE: ClassVar[uint8] = 2
    CHARGE_COMPLETED: ClassVar[uint8] = 3
    BATTERY_LOW: ClassVar[uint8] = 4
    BATTERY_CRITICAL: ClassVar[uint8] = 5

    event: uint8 = 0


class RobotStateEvent(Message, typename="kobuki_ros_interfaces/msg/RobotStateEvent"):
    """RobotStateEvent, as Kobuki defines it."""

    ONLINE: ClassVar[uint8] = 1
    OFFLINE: ClassVar[uint8] = 0

    state: uint8 = 0


class ScanAngle(Message, typename="kobuki_ros_interfaces/msg/ScanAngle"):
    """ScanAngle, as Kobuki defines it."""

    header: Header = DEFAULT_
    scan_angle: float64 = 0.0


class SensorState(Message, typename="kobuki_ros_interfaces/msg/SensorState"):
    """SensorState, as Kobuki defines it."""

    BUMPER_RIGHT: ClassVar[uint8] = 1
    BUMPER_CENTRE: ClassVar[uint8] = 2
    BUMPER_LEFT: ClassVar[uint8] = 4
    WHEEL_DROP_RIGHT: ClassVar[uint8] = 1
    WHEEL_DROP_LEFT: ClassVar[uint8] = 2
    CLIFF_RIGHT: ClassVar[uint8] = 1
    CLIFF_CENTRE: ClassVar[uint8] = 2
    CLIFF_LEFT: ClassVar[uint8] = 4
    BUTTON0: ClassVar[uint8] = 1
    BUTTON1: ClassVar[uint8] = 2
    BUTTON2: ClassVar[uint8] = 4
    DISCHARGING: ClassVar[uint8] = 0
    DOCKING_CHARGED: ClassVar[uint8] = 2
    DOCKING_CHARGING: ClassVar[uint8] = 6
    ADAPTER_CHARGED: ClassVar[uint8] = 18
    ADAPTER_CHARGING: ClassVar[uint8] = 22
    OVER_CURRENT_LEFT_WHEEL: ClassVar[uint8] = 1
    OVER_CURRENT_RIGHT_WHEEL: ClassVar[uint8] = 2
    OVER_CURRENT_BOTH_WHEELS: ClassVar[uint8] = 3
    DIGITAL_INPUT0: ClassVar[uint8] = 1
    DIGITAL_INPUT1: ClassVar[uint8] = 2
    DIGITAL_INPUT2: ClassVar[uint8] = 4
    DIGITAL_INPUT3: ClassVar[uint8] = 8
    DB25_TEST_BOARD_CONNECTED: ClassVar[uint8] = 64

    header: Header = DEFAULT_
    time_stamp: uint16 = 0
    bumper: uint8 = 0
    wheel_drop: uint8 = 0
    cliff: uint8 = 0
    left_encoder: uint16 = 0
    right_encoder: uint16 = 0
    left_pwm: int8 = 0
    right_pwm: int8 = 0
    buttons: uint8 = 0
    charger: uint8 = 0
    battery: uint8 = 0
    bottom: Annotated[Ints, Sequence[uint16]] = DEFAULT_
    current: Annotated[Bytes, Sequence[uint8]] = DEFAULT_
    over_current: uint8 = 0
    digital_input: uint16 = 0
    analog_input: Annotated[Ints, Sequence[uint16]] = DEFAULT_


class Sound(Message, typename="kobuki_ros_interfaces/msg/Sound"):
    """Sound, as Kobuki defines it."""

    ON: ClassVar[uint8] = 0
    OFF: ClassVar[uint8] = 1
    RECHARGE: ClassVar[uint8] = 2
    BUTTON: ClassVar[uint8] = 3
    ERROR: ClassVar[uint8] = 4
    CLEANINGSTART: ClassVar[uint8] = 5
    CLEANINGEND: ClassVar[uint8] = 6

    value: uint8 = 0


class VersionInfo(Message, typename="kobuki_ros_interfaces/msg/VersionInfo"):
    """VersionInfo, as Kobuki defines it."""

    SMOOTH_MOVE_START: ClassVar[uint64] = 1
    GYROSCOPE_3D_DATA: ClassVar[uint64] = 2

    hardware: str = ""
    firmware: str = ""
    software: str = ""
    udid: Annotated[Ints, Sequence[uint32]] = DEFAULT_
    features: uint64 = 0


class WheelDropEvent(Message, typename="kobuki_ros_interfaces/msg/WheelDropEvent"):
    """WheelDropEvent, as Kobuki defines it."""

    LEFT: ClassVar[uint8] = 0
    RIGHT: ClassVar[uint8] = 1
    RAISED: ClassVar[uint8] = 0
    DROPPED: ClassVar[uint8] = 1

    wheel: uint8 = 0
    state: uint8 = 0
