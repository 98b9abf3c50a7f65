"""Messages of clearpath_platform_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Array, Bytes, Floats, Message, Sequence, float32, int8, uint8

__all__ = [
    "RGB",
    "Drive",
    "DriveFeedback",
    "Fans",
    "Feedback",
    "Lights",
    "Power",
    "Status",
    "StopStatus",
]


class Drive(Message, typename="clearpath_platform_msgs/msg/Drive"):
    """Drive, as Clearpath defines it."""

    MODE_VELOCITY: ClassVar[int8] = 0
    MODE_PWM: ClassVar[int8] = 1
    MODE_NONE: ClassVar[int8] = -1
    LEFT: ClassVar[int8] = 0
    RIGHT: ClassVar[int8] = 1

    mode: int8 = 0
    drivers: Annotated[Floats, Array[float32, 2]] = DEFAULT


class DriveFeedback(Message, typename="clearpath_platform_msgs/msg/DriveFeedback"):
    """DriveFeedback, as Clearpath defines it."""

    current: float32 = 0.0
    duty_cycle: float32 = 0.0
    bridge_temperature: float32 = 0.0
    motor_temperature: float32 = 0.0
    measured_velocity: float32 = 0.0
    measured_travel: float32 = 0.0
    driver_fault: bool = False


class Fans(Message, typename="clearpath_platform_msgs/msg/Fans"):
    """Fans, as Clearpath defines it."""

    R100_EQUIPMENT_BAY_INTAKE: ClassVar[uint8] = 0
    R100_EQUIPMENT_BAY_EXHAUST: ClassVar[uint8] = 1
    R100_CHARGER_BAY_INTAKE: ClassVar[uint8] = 2
    R100_CHARGER_BAY_EXHAUST: ClassVar[uint8] = 3
    R100_USER_BAY_INTAKE: ClassVar[uint8] = 4
    R100_USER_BAY_EXHAUST: ClassVar[uint8] = 5
    FAN_OFF: ClassVar[uint8] = 0
    FAN_ON_HIGH: ClassVar[uint8] = 1
    FAN_ON_LOW: ClassVar[uint8] = 2

    fans: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class Feedback(Message, typename="clearpath_platform_msgs/msg/Feedback"):
    """Feedback, as Clearpath defines it."""

    header: Header = DEFAULT
    drivers: Annotated[list[DriveFeedback], Array[DriveFeedback, 2]] = DEFAULT
    commanded_mode: int8 = 0
    actual_mode: int8 = 0


class RGB(Message, typename="clearpath_platform_msgs/msg/RGB"):
    """RGB, as Clearpath defines it."""

    red: uint8 = 0
    green: uint8 = 0
    blue: uint8 = 0


class Lights(Message, typename="clearpath_platform_msgs/msg/Lights"):
    """Lights, as Clearpath defines it."""

    D100_LIGHTS_REAR_LEFT: ClassVar[uint8] = 0
    D100_LIGHTS_FRONT_LEFT: ClassVar[uint8] = 1
    D100_LIGHTS_FRONT_RIGHT: ClassVar[uint8] = 2
    D100_LIGHTS_REAR_RIGHT: ClassVar[uint8] = 3
    D150_LIGHTS_REAR_LEFT: ClassVar[uint8] = 0
    D150_LIGHTS_FRONT_LEFT: ClassVar[uint8] = 1
    D150_LIGHTS_FRONT_RIGHT: ClassVar[uint8] = 2
    D150_LIGHTS_REAR_RIGHT: ClassVar[uint8] = 3
    R100_LIGHTS_FRONT_PORT_UPPER: ClassVar[uint8] = 0
    R100_LIGHTS_FRONT_PORT_LOWER: ClassVar[uint8] = 1
    R100_LIGHTS_FRONT_STARBOARD_UPPER: ClassVar[uint8] = 2
    R100_LIGHTS_FRONT_STARBOARD_LOWER: ClassVar[uint8] = 3
    R100_LIGHTS_REAR_PORT_UPPER: ClassVar[uint8] = 4
    R100_LIGHTS_REAR_PORT_LOWER: ClassVar[uint8] = 5
    R100_LIGHTS_REAR_STARBOARD_UPPER: ClassVar[uint8] = 6
    R100_LIGHTS_REAR_STARBOARD_LOWER: ClassVar[uint8] = 7
    W200_LIGHTS_FRONT_LEFT: ClassVar[uint8] = 0
    W200_LIGHTS_FRONT_RIGHT: ClassVar[uint8] = 1
    W200_LIGHTS_REAR_LEFT: ClassVar[uint8] = 2
    W200_LIGHTS_REAR_RIGHT: ClassVar[uint8] = 3

    lights: Annotated[list[RGB], Sequence[RGB]] = DEFAULT


class Power(Message, typename="clearpath_platform_msgs/msg/Power"):
    """Power, as Clearpath defines it."""

    NOT_APPLICABLE: ClassVar[int8] = -1
    J100_MEASURED_BATTERY: ClassVar[uint8] = 0
    J100_MEASURED_5V: ClassVar[uint8] = 1
    J100_MEASURED_12V: ClassVar[uint8] = 2
    D100_MEASURED_BATTERY: ClassVar[uint8] = 0
    D100_MEASURED_5V: ClassVar[uint8] = 1
    D100_MEASURED_12V: ClassVar[uint8] = 2
    D150_MEASURED_BATTERY: ClassVar[uint8] = 0
    D150_MEASURED_5V: ClassVar[uint8] = 1
    D150_MEASURED_12V: ClassVar[uint8] = 2
    W200_MEASURED_BATTERY: ClassVar[uint8] = 0
    W200_MEASURED_12V: ClassVar[uint8] = 1
    W200_MEASURED_24V: ClassVar[uint8] = 2
    W200_MEASURED_48V: ClassVar[uint8] = 3
    R100_MEASURED_BATTERY: ClassVar[uint8] = 0
    R100_MEASURED_5V: ClassVar[uint8] = 1
    R100_MEASURED_12V: ClassVar[uint8] = 2
    R100_MEASURED_INVERTER: ClassVar[uint8] = 3
    R100_MEASURED_FRONT_AXLE: ClassVar[uint8] = 4
    R100_MEASURED_REAR_AXLE: ClassVar[uint8] = 5
    R100_MEASURED_LIGHT: ClassVar[uint8] = 6
    A200_BATTERY_VOLTAGE: ClassVar[uint8] = 0
    A200_LEFT_DRIVER_VOLTAGE: ClassVar[uint8] = 1
    A200_RIGHT_DRIVER_VOLTAGE: ClassVar[uint8] = 2
    A200_VOLTAGES_SIZE: ClassVar[uint8] = 3
    J100_TOTAL_CURRENT: ClassVar[uint8] = 0
    J100_COMPUTER_CURRENT: ClassVar[uint8] = 1
    J100_DRIVE_CURRENT: ClassVar[uint8] = 2
    J100_USER_CURRENT: ClassVar[uint8] = 3
    D100_TOTAL_CURRENT: ClassVar[uint8] = 0
    D100_COMPUTER_CURRENT: ClassVar[uint8] = 1
    D150_TOTAL_CURRENT: ClassVar[uint8] = 0
    D150_COMPUTER_CURRENT: ClassVar[uint8] = 1
    W200_TOTAL_CURRENT: ClassVar[uint8] = 0
    W200_COMPUTER_CURRENT: ClassVar[uint8] = 1
    W200_12V_CURRENT: ClassVar[uint8] = 2
    W200_24V_CURRENT: ClassVar[uint8] = 3
    R100_TOTAL_CURRENT: ClassVar[uint8] = 0
    A200_MCU_AND_USER_PORT_CURRENT: ClassVar[uint8] = 0
    A200_LEFT_DRIVER_CURRENT: ClassVar[uint8] = 1
    A200_RIGHT_DRIVER_CURRENT: ClassVar[uint8] = 2
    A200_CURRENTS_SIZE: ClassVar[uint8] = 3

    header: Header = DEFAULT
    shore_power_connected: int8 = 0
    battery_connected: int8 = 0
    power_12v_user_nominal: int8 = 0
    charger_connected: int8 = 0
    charging_complete: int8 = 0
    measured_voltages: Annotated[Floats, Sequence[float32]] = DEFAULT
    measured_currents: Annotated[Floats, Sequence[float32]] = DEFAULT


class Status(Message, typename="clearpath_platform_msgs/msg/Status"):
    """Status, as Clearpath defines it."""

    header: Header = DEFAULT
    hardware_id: str = ""
    firmware_version: str = ""
    mcu_uptime: Duration = DEFAULT
    connection_uptime: Duration = DEFAULT
    pcb_temperature: float32 = 0.0
    mcu_temperature: float32 = 0.0


class StopStatus(Message, typename="clearpath_platform_msgs/msg/StopStatus"):
    """StopStatus, as Clearpath defines it."""

    header: Header = DEFAULT
    stop_power_status: bool = False
    external_stop_present: bool = False
    needs_reset: bool = False
