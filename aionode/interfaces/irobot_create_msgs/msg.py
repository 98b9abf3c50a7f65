"""Messages of irobot_create_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Array,
    Message,
    Sequence,
    float32,
    int16,
    int32,
    uint8,
    uint16,
    uint32,
)

__all__ = [
    "AudioNote",
    "AudioNoteVector",
    "Button",
    "DockStatus",
    "HazardDetection",
    "HazardDetectionVector",
    "InterfaceButtons",
    "IrIntensity",
    "IrIntensityVector",
    "IrOpcode",
    "KidnapStatus",
    "LedColor",
    "LightringLeds",
    "Mouse",
    "SlipStatus",
    "StopStatus",
    "WheelStatus",
    "WheelTicks",
    "WheelVels",
]


class AudioNote(Message, typename="irobot_create_msgs/msg/AudioNote"):
    """AudioNote, as the Create 3 defines it."""

    frequency: uint16 = 0
    max_runtime: Duration = DEFAULT


class AudioNoteVector(Message, typename="irobot_create_msgs/msg/AudioNoteVector"):
    """AudioNoteVector, as the Create 3 defines it."""

    header: Header = DEFAULT
    notes: Annotated[list[AudioNote], Sequence[AudioNote]] = DEFAULT
    append: bool = False


class LedColor(Message, typename="irobot_create_msgs/msg/LedColor"):
    """LedColor, as the Create 3 defines it."""

    red: uint8 = 0
    green: uint8 = 0
    blue: uint8 = 0


class LightringLeds(Message, typename="irobot_create_msgs/msg/LightringLeds"):
    """LightringLeds, as the Create 3 defines it."""

    header: Header = DEFAULT
    leds: Annotated[list[LedColor], Array[LedColor, 6]] = DEFAULT
    override_system: bool = False


class Button(Message, typename="irobot_create_msgs/msg/Button"):
    """Button, as the Create 3 defines it."""

    header: Header = DEFAULT
    is_pressed: bool = False
    last_start_pressed_time: Time = DEFAULT
    last_pressed_duration: Duration = DEFAULT


class DockStatus(Message, typename="irobot_create_msgs/msg/DockStatus"):
    """DockStatus, as the Create 3 defines it."""

    header: Header = DEFAULT
    dock_visible: bool = False
    is_docked: bool = False


class HazardDetection(Message, typename="irobot_create_msgs/msg/HazardDetection"):
    """HazardDetection, as the Create 3 defines it."""

    BACKUP_LIMIT: ClassVar[uint8] = 0
    BUMP: ClassVar[uint8] = 1
    CLIFF: ClassVar[uint8] = 2
    STALL: ClassVar[uint8] = 3
    WHEEL_DROP: ClassVar[uint8] = 4
    OBJECT_PROXIMITY: ClassVar[uint8] = 5

    header: Header = DEFAULT
    type: uint8 = 0


class HazardDetectionVector(Message, typename="irobot_create_msgs/msg/HazardDetectionVector"):
    """HazardDetectionVector, as the Create 3 defines it."""

    header: Header = DEFAULT
    detections: Annotated[list[HazardDetection], Sequence[HazardDetection]] = DEFAULT


class InterfaceButtons(Message, typename="irobot_create_msgs/msg/InterfaceButtons"):
    """InterfaceButtons, as the Create 3 defines it."""

    header: Header = DEFAULT
    button_1: Button = DEFAULT
    button_power: Button = DEFAULT
    button_2: Button = DEFAULT


class IrIntensity(Message, typename="irobot_create_msgs/msg/IrIntensity"):
    """IrIntensity, as the Create 3 defines it."""

    header: Header = DEFAULT
    value: int16 = 0


class IrIntensityVector(Message, typename="irobot_create_msgs/msg/IrIntensityVector"):
    """IrIntensityVector, as the Create 3 defines it."""

    header: Header = DEFAULT
    readings: Annotated[list[IrIntensity], Sequence[IrIntensity]] = DEFAULT


class IrOpcode(Message, typename="irobot_create_msgs/msg/IrOpcode"):
    """IrOpcode, as the Create 3 defines it."""

    CODE_IR_FORCE_FIELD: ClassVar[uint8] = 161
    CODE_IR_VIRTUAL_WALL: ClassVar[uint8] = 162
    CODE_IR_BUOY_GREEN: ClassVar[uint8] = 164
    CODE_IR_BUOY_RED: ClassVar[uint8] = 168
    CODE_IR_BUOY_BOTH: ClassVar[uint8] = 172
    CODE_IR_EVAC_GREEN_FIELD: ClassVar[uint8] = 244
    CODE_IR_EVAC_RED_FIELD: ClassVar[uint8] = 248
    CODE_IR_EVAC_BOTH_FIELD: ClassVar[uint8] = 252
    SENSOR_OMNI: ClassVar[uint8] = 0
    SENSOR_DIRECTIONAL_FRONT: ClassVar[uint8] = 1

    header: Header = DEFAULT
    opcode: uint8 = 0
    sensor: uint8 = 0


class KidnapStatus(Message, typename="irobot_create_msgs/msg/KidnapStatus"):
    """KidnapStatus, as the Create 3 defines it."""

    header: Header = DEFAULT
    is_kidnapped: bool = False


class Mouse(Message, typename="irobot_create_msgs/msg/Mouse"):
    """Mouse, as the Create 3 defines it."""

    header: Header = DEFAULT
    integrated_x: float32 = 0.0
    integrated_y: float32 = 0.0
    frame_id: uint32 = 0
    last_squal: uint8 = 0


class SlipStatus(Message, typename="irobot_create_msgs/msg/SlipStatus"):
    """SlipStatus, as the Create 3 defines it."""

    header: Header = DEFAULT
    is_slipping: bool = False


class StopStatus(Message, typename="irobot_create_msgs/msg/StopStatus"):
    """StopStatus, as the Create 3 defines it."""

    header: Header = DEFAULT
    is_stopped: bool = False


class WheelStatus(Message, typename="irobot_create_msgs/msg/WheelStatus"):
    """WheelStatus, as the Create 3 defines it."""

    header: Header = DEFAULT
    current_ma_left: int16 = 0
    current_ma_right: int16 = 0
    pwm_left: int16 = 0
    pwm_right: int16 = 0
    wheels_enabled: bool = False


class WheelTicks(Message, typename="irobot_create_msgs/msg/WheelTicks"):
    """WheelTicks, as the Create 3 defines it."""

    header: Header = DEFAULT
    ticks_left: int32 = 0
    ticks_right: int32 = 0


class WheelVels(Message, typename="irobot_create_msgs/msg/WheelVels"):
    """WheelVels, as the Create 3 defines it."""

    header: Header = DEFAULT
    velocity_left: float32 = 0.0
    velocity_right: float32 = 0.0
