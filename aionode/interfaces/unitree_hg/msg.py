"""Messages of unitree_hg.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import (
    DEFAULT,
    Array,
    Floats,
    Ints,
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
    "BmsCmd",
    "BmsState",
    "HandCmd",
    "HandState",
    "IMUState",
    "LowCmd",
    "LowState",
    "MainBoardState",
    "MotorCmd",
    "MotorState",
    "PressSensorState",
]


class BmsCmd(Message, typename="unitree_hg/msg/BmsCmd"):
    """BmsCmd, as Unitree defines it."""

    cmd: uint8 = 0
    reserve: Annotated[Ints, Array[uint8, 40]] = DEFAULT


class BmsState(Message, typename="unitree_hg/msg/BmsState"):
    """BmsState, as Unitree defines it."""

    version_high: uint8 = 0
    version_low: uint8 = 0
    fn: uint8 = 0
    cell_vol: Annotated[Ints, Array[uint16, 40]] = DEFAULT
    bmsvoltage: Annotated[Ints, Array[uint32, 3]] = DEFAULT
    current: int32 = 0
    soc: uint8 = 0
    soh: uint8 = 0
    temperature: Annotated[Ints, Array[int16, 12]] = DEFAULT
    cycle: uint16 = 0
    manufacturer_date: uint16 = 0
    bmsstate: Annotated[Ints, Array[uint32, 5]] = DEFAULT
    reserve: Annotated[Ints, Array[uint32, 3]] = DEFAULT


class MotorCmd(Message, typename="unitree_hg/msg/MotorCmd"):
    """MotorCmd, as Unitree defines it."""

    mode: uint8 = 0
    q: float32 = 0.0
    dq: float32 = 0.0
    tau: float32 = 0.0
    kp: float32 = 0.0
    kd: float32 = 0.0
    reserve: uint32 = 0


class HandCmd(Message, typename="unitree_hg/msg/HandCmd"):
    """HandCmd, as Unitree defines it."""

    motor_cmd: Annotated[list[MotorCmd], Sequence[MotorCmd]] = DEFAULT
    reserve: Annotated[Ints, Array[uint32, 4]] = DEFAULT


class MotorState(Message, typename="unitree_hg/msg/MotorState"):
    """MotorState, as Unitree defines it."""

    mode: uint8 = 0
    q: float32 = 0.0
    dq: float32 = 0.0
    ddq: float32 = 0.0
    tau_est: float32 = 0.0
    temperature: Annotated[Ints, Array[int16, 2]] = DEFAULT
    vol: float32 = 0.0
    sensor: Annotated[Ints, Array[uint32, 2]] = DEFAULT
    motorstate: uint32 = 0
    reserve: Annotated[Ints, Array[uint32, 4]] = DEFAULT


class PressSensorState(Message, typename="unitree_hg/msg/PressSensorState"):
    """PressSensorState, as Unitree defines it."""

    pressure: Annotated[Floats, Array[float32, 12]] = DEFAULT
    temperature: Annotated[Floats, Array[float32, 12]] = DEFAULT
    lost: uint32 = 0
    reserve: uint32 = 0


class IMUState(Message, typename="unitree_hg/msg/IMUState"):
    """IMUState, as Unitree defines it."""

    quaternion: Annotated[Floats, Array[float32, 4]] = DEFAULT
    gyroscope: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accelerometer: Annotated[Floats, Array[float32, 3]] = DEFAULT
    rpy: Annotated[Floats, Array[float32, 3]] = DEFAULT
    temperature: int16 = 0


class HandState(Message, typename="unitree_hg/msg/HandState"):
    """HandState, as Unitree defines it."""

    motor_state: Annotated[list[MotorState], Sequence[MotorState]] = DEFAULT
    press_sensor_state: Annotated[list[PressSensorState], Sequence[PressSensorState]] = DEFAULT
    imu_state: IMUState = DEFAULT
    power_v: float32 = 0.0
    power_a: float32 = 0.0
    system_v: float32 = 0.0
    device_v: float32 = 0.0
    error: Annotated[Ints, Array[uint32, 2]] = DEFAULT
    reserve: Annotated[Ints, Array[uint32, 2]] = DEFAULT


class LowCmd(Message, typename="unitree_hg/msg/LowCmd"):
    """LowCmd, as Unitree defines it."""

    mode_pr: uint8 = 0
    mode_machine: uint8 = 0
    motor_cmd: Annotated[list[MotorCmd], Array[MotorCmd, 35]] = DEFAULT
    reserve: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    crc: uint32 = 0


class LowState(Message, typename="unitree_hg/msg/LowState"):
    """LowState, as Unitree defines it."""

    version: Annotated[Ints, Array[uint32, 2]] = DEFAULT
    mode_pr: uint8 = 0
    mode_machine: uint8 = 0
    tick: uint32 = 0
    imu_state: IMUState = DEFAULT
    motor_state: Annotated[list[MotorState], Array[MotorState, 35]] = DEFAULT
    wireless_remote: Annotated[Ints, Array[uint8, 40]] = DEFAULT
    reserve: Annotated[Ints, Array[uint32, 4]] = DEFAULT
    crc: uint32 = 0


class MainBoardState(Message, typename="unitree_hg/msg/MainBoardState"):
    """MainBoardState, as Unitree defines it."""

    fan_state: Annotated[Ints, Array[uint16, 6]] = DEFAULT
    temperature: Annotated[Ints, Array[int16, 6]] = DEFAULT
    value: Annotated[Floats, Array[float32, 6]] = DEFAULT
    state: Annotated[Ints, Array[uint32, 6]] = DEFAULT
