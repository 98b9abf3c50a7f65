"""Messages of ur_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import (
    DEFAULT,
    Floats,
    Message,
    Sequence,
    float32,
    float64,
    int8,
    uint8,
    uint32,
    uint64,
)

__all__ = [
    "Analog",
    "Digital",
    "IOStates",
    "MasterboardDataMsg",
    "RobotModeDataMsg",
    "RobotStateRTMsg",
    "ToolDataMsg",
]


class Analog(Message, typename="ur_msgs/msg/Analog"):
    """Analog, as Universal Robots defines it."""

    CURRENT: ClassVar[uint8] = 0
    VOLTAGE: ClassVar[uint8] = 1

    pin: uint8 = 0
    domain: uint8 = 0
    state: float32 = 0.0


class Digital(Message, typename="ur_msgs/msg/Digital"):
    """Digital, as Universal Robots defines it."""

    pin: uint8 = 0
    state: bool = False


class IOStates(Message, typename="ur_msgs/msg/IOStates"):
    """IOStates, as Universal Robots defines it."""

    digital_in_states: Annotated[list[Digital], Sequence[Digital]] = DEFAULT
    digital_out_states: Annotated[list[Digital], Sequence[Digital]] = DEFAULT
    flag_states: Annotated[list[Digital], Sequence[Digital]] = DEFAULT
    analog_in_states: Annotated[list[Analog], Sequence[Analog]] = DEFAULT
    analog_out_states: Annotated[list[Analog], Sequence[Analog]] = DEFAULT


class MasterboardDataMsg(Message, typename="ur_msgs/msg/MasterboardDataMsg"):
    """MasterboardDataMsg, as Universal Robots defines it."""

    digital_input_bits: uint32 = 0
    digital_output_bits: uint32 = 0
    analog_input_range0: int8 = 0
    analog_input_range1: int8 = 0
    analog_input0: float64 = 0.0
    analog_input1: float64 = 0.0
    analog_output_domain0: int8 = 0
    analog_output_domain1: int8 = 0
    analog_output0: float64 = 0.0
    analog_output1: float64 = 0.0
    masterboard_temperature: float32 = 0.0
    robot_voltage_48v: float32 = 0.0
    robot_current: float32 = 0.0
    master_io_current: float32 = 0.0
    master_safety_state: uint8 = 0
    master_onoff_state: uint8 = 0


class RobotModeDataMsg(Message, typename="ur_msgs/msg/RobotModeDataMsg"):
    """RobotModeDataMsg, as Universal Robots defines it."""

    timestamp: uint64 = 0
    is_robot_connected: bool = False
    is_real_robot_enabled: bool = False
    is_power_on_robot: bool = False
    is_emergency_stopped: bool = False
    is_protective_stopped: bool = False
    is_program_running: bool = False
    is_program_paused: bool = False


class RobotStateRTMsg(Message, typename="ur_msgs/msg/RobotStateRTMsg"):
    """RobotStateRTMsg, as Universal Robots defines it."""

    time: float64 = 0.0
    q_target: Annotated[Floats, Sequence[float64]] = DEFAULT
    qd_target: Annotated[Floats, Sequence[float64]] = DEFAULT
    qdd_target: Annotated[Floats, Sequence[float64]] = DEFAULT
    i_target: Annotated[Floats, Sequence[float64]] = DEFAULT
    m_target: Annotated[Floats, Sequence[float64]] = DEFAULT
    q_actual: Annotated[Floats, Sequence[float64]] = DEFAULT
    qd_actual: Annotated[Floats, Sequence[float64]] = DEFAULT
    i_actual: Annotated[Floats, Sequence[float64]] = DEFAULT
    tool_acc_values: Annotated[Floats, Sequence[float64]] = DEFAULT
    tcp_force: Annotated[Floats, Sequence[float64]] = DEFAULT
    tool_vector: Annotated[Floats, Sequence[float64]] = DEFAULT
    tcp_speed: Annotated[Floats, Sequence[float64]] = DEFAULT
    digital_input_bits: float64 = 0.0
    motor_temperatures: Annotated[Floats, Sequence[float64]] = DEFAULT
    controller_timer: float64 = 0.0
    test_value: float64 = 0.0
    robot_mode: float64 = 0.0
    joint_modes: Annotated[Floats, Sequence[float64]] = DEFAULT


class ToolDataMsg(Message, typename="ur_msgs/msg/ToolDataMsg"):
    """ToolDataMsg, as Universal Robots defines it."""

    ANALOG_INPUT_RANGE_CURRENT: ClassVar[int8] = 0
    ANALOG_INPUT_RANGE_VOLTAGE: ClassVar[int8] = 1
    TOOL_BOOTLOADER_MODE: ClassVar[uint8] = 249
    TOOL_RUNNING_MODE: ClassVar[uint8] = 253
    TOOL_IDLE_MODE: ClassVar[uint8] = 255

    analog_input_range2: int8 = 0
    analog_input_range3: int8 = 0
    analog_input2: float64 = 0.0
    analog_input3: float64 = 0.0
    tool_voltage_48v: float32 = 0.0
    tool_output_voltage: uint8 = 0
    tool_current: float32 = 0.0
    tool_temperature: float32 = 0.0
    tool_mode: uint8 = 0
