"""Messages of lbr_fri_idl.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, Array, Floats, Message, float64, int8, uint32

__all__ = [
    "LBRCommand",
    "LBRJointPositionCommand",
    "LBRState",
    "LBRTorqueCommand",
    "LBRWrenchCommand",
]


class LBRCommand(Message, typename="lbr_fri_idl/msg/LBRCommand"):
    """LBRCommand, as lbr_fri_ros2_stack defines it."""

    joint_position: Annotated[Floats, Array[float64, 7]] = DEFAULT
    torque: Annotated[Floats, Array[float64, 7]] = DEFAULT
    wrench: Annotated[Floats, Array[float64, 6]] = DEFAULT


class LBRJointPositionCommand(Message, typename="lbr_fri_idl/msg/LBRJointPositionCommand"):
    """LBRJointPositionCommand, as lbr_fri_ros2_stack defines it."""

    joint_position: Annotated[Floats, Array[float64, 7]] = DEFAULT


class LBRState(Message, typename="lbr_fri_idl/msg/LBRState"):
    """LBRState, as lbr_fri_ros2_stack defines it."""

    sample_time: float64 = 0.0
    session_state: int8 = 0
    connection_quality: int8 = 0
    safety_state: int8 = 0
    operation_mode: int8 = 0
    drive_state: int8 = 0
    client_command_mode: int8 = 0
    overlay_type: int8 = 0
    control_mode: int8 = 0
    time_stamp_sec: uint32 = 0
    time_stamp_nano_sec: uint32 = 0
    measured_joint_position: Annotated[Floats, Array[float64, 7]] = DEFAULT
    measured_torque: Annotated[Floats, Array[float64, 7]] = DEFAULT
    commanded_torque: Annotated[Floats, Array[float64, 7]] = DEFAULT
    external_torque: Annotated[Floats, Array[float64, 7]] = DEFAULT
    ipo_joint_position: Annotated[Floats, Array[float64, 7]] = DEFAULT
    tracking_performance: float64 = 0.0


class LBRTorqueCommand(Message, typename="lbr_fri_idl/msg/LBRTorqueCommand"):
    """LBRTorqueCommand, as lbr_fri_ros2_stack defines it."""

    joint_position: Annotated[Floats, Array[float64, 7]] = DEFAULT
    torque: Annotated[Floats, Array[float64, 7]] = DEFAULT


class LBRWrenchCommand(Message, typename="lbr_fri_idl/msg/LBRWrenchCommand"):
    """LBRWrenchCommand, as lbr_fri_ros2_stack defines it."""

    joint_position: Annotated[Floats, Array[float64, 7]] = DEFAULT
    wrench: Annotated[Floats, Array[float64, 6]] = DEFAULT
