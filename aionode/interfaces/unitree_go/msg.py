"""Messages of unitree_go.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import (
    DEFAULT,
    Array,
    Bytes,
    Floats,
    Ints,
    Message,
    Sequence,
    float32,
    float64,
    int8,
    int16,
    int32,
    uint8,
    uint16,
    uint32,
    uint64,
)

__all__ = [
    "AudioData",
    "BmsCmd",
    "BmsState",
    "Error",
    "Go2FrontVideoData",
    "HeightMap",
    "IMUState",
    "InterfaceConfig",
    "LidarState",
    "LowCmd",
    "LowState",
    "MotorCmd",
    "MotorCmds",
    "MotorState",
    "MotorStates",
    "PathPoint",
    "Req",
    "Res",
    "SportModeCmd",
    "SportModeState",
    "TimeSpec",
    "UwbState",
    "UwbSwitch",
    "WirelessController",
]


class AudioData(Message, typename="unitree_go/msg/AudioData"):
    """AudioData, as Unitree defines it."""

    time_frame: uint64 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class BmsCmd(Message, typename="unitree_go/msg/BmsCmd"):
    """BmsCmd, as Unitree defines it."""

    off: uint8 = 0
    reserve: Annotated[Ints, Array[uint8, 3]] = DEFAULT


class BmsState(Message, typename="unitree_go/msg/BmsState"):
    """BmsState, as Unitree defines it."""

    version_high: uint8 = 0
    version_low: uint8 = 0
    status: uint8 = 0
    soc: uint8 = 0
    current: int32 = 0
    cycle: uint16 = 0
    bq_ntc: Annotated[Ints, Array[int8, 2]] = DEFAULT
    mcu_ntc: Annotated[Ints, Array[int8, 2]] = DEFAULT
    cell_vol: Annotated[Ints, Array[uint16, 15]] = DEFAULT


class Error(Message, typename="unitree_go/msg/Error"):
    """Error, as Unitree defines it."""

    source: uint32 = 0
    state: uint32 = 0


class Go2FrontVideoData(Message, typename="unitree_go/msg/Go2FrontVideoData"):
    """Go2FrontVideoData, as Unitree defines it."""

    time_frame: uint64 = 0
    video720p: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    video360p: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    video180p: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class HeightMap(Message, typename="unitree_go/msg/HeightMap"):
    """HeightMap, as Unitree defines it."""

    stamp: float64 = 0.0
    frame_id: str = ""
    resolution: float32 = 0.0
    width: uint32 = 0
    height: uint32 = 0
    origin: Annotated[Floats, Array[float32, 2]] = DEFAULT
    data: Annotated[Floats, Sequence[float32]] = DEFAULT


class IMUState(Message, typename="unitree_go/msg/IMUState"):
    """IMUState, as Unitree defines it."""

    quaternion: Annotated[Floats, Array[float32, 4]] = DEFAULT
    gyroscope: Annotated[Floats, Array[float32, 3]] = DEFAULT
    accelerometer: Annotated[Floats, Array[float32, 3]] = DEFAULT
    rpy: Annotated[Floats, Array[float32, 3]] = DEFAULT
    temperature: int8 = 0


class InterfaceConfig(Message, typename="unitree_go/msg/InterfaceConfig"):
    """InterfaceConfig, as Unitree defines it."""

    mode: uint8 = 0
    value: uint8 = 0
    reserve: Annotated[Ints, Array[uint8, 2]] = DEFAULT


class LidarState(Message, typename="unitree_go/msg/LidarState"):
    """LidarState, as Unitree defines it."""

    stamp: float64 = 0.0
    firmware_version: str = ""
    software_version: str = ""
    sdk_version: str = ""
    sys_rotation_speed: float32 = 0.0
    com_rotation_speed: float32 = 0.0
    error_state: uint8 = 0
    cloud_frequency: float32 = 0.0
    cloud_packet_loss_rate: float32 = 0.0
    cloud_size: uint32 = 0
    cloud_scan_num: uint32 = 0
    imu_frequency: float32 = 0.0
    imu_packet_loss_rate: float32 = 0.0
    imu_rpy: Annotated[Floats, Array[float32, 3]] = DEFAULT
    serial_recv_stamp: float64 = 0.0
    serial_buffer_size: uint32 = 0
    serial_buffer_read: uint32 = 0


class MotorCmd(Message, typename="unitree_go/msg/MotorCmd"):
    """MotorCmd, as Unitree defines it."""

    mode: uint8 = 0
    q: float32 = 0.0
    dq: float32 = 0.0
    tau: float32 = 0.0
    kp: float32 = 0.0
    kd: float32 = 0.0
    reserve: Annotated[Ints, Array[uint32, 3]] = DEFAULT


class LowCmd(Message, typename="unitree_go/msg/LowCmd"):
    """LowCmd, as Unitree defines it."""

    head: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    level_flag: uint8 = 0
    frame_reserve: uint8 = 0
    sn: Annotated[Ints, Array[uint32, 2]] = DEFAULT
    version: Annotated[Ints, Array[uint32, 2]] = DEFAULT
    bandwidth: uint16 = 0
    motor_cmd: Annotated[list[MotorCmd], Array[MotorCmd, 20]] = DEFAULT
    bms_cmd: BmsCmd = DEFAULT
    wireless_remote: Annotated[Ints, Array[uint8, 40]] = DEFAULT
    led: Annotated[Ints, Array[uint8, 12]] = DEFAULT
    fan: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    gpio: uint8 = 0
    reserve: uint32 = 0
    crc: uint32 = 0


class MotorState(Message, typename="unitree_go/msg/MotorState"):
    """MotorState, as Unitree defines it."""

    mode: uint8 = 0
    q: float32 = 0.0
    dq: float32 = 0.0
    ddq: float32 = 0.0
    tau_est: float32 = 0.0
    q_raw: float32 = 0.0
    dq_raw: float32 = 0.0
    ddq_raw: float32 = 0.0
    temperature: int8 = 0
    lost: uint32 = 0
    reserve: Annotated[Ints, Array[uint32, 2]] = DEFAULT


class LowState(Message, typename="unitree_go/msg/LowState"):
    """LowState, as Unitree defines it."""

    head: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    level_flag: uint8 = 0
    frame_reserve: uint8 = 0
    sn: Annotated[Ints, Array[uint32, 2]] = DEFAULT
    version: Annotated[Ints, Array[uint32, 2]] = DEFAULT
    bandwidth: uint16 = 0
    imu_state: IMUState = DEFAULT
    motor_state: Annotated[list[MotorState], Array[MotorState, 20]] = DEFAULT
    bms_state: BmsState = DEFAULT
    foot_force: Annotated[Ints, Array[int16, 4]] = DEFAULT
    foot_force_est: Annotated[Ints, Array[int16, 4]] = DEFAULT
    tick: uint32 = 0
    wireless_remote: Annotated[Ints, Array[uint8, 40]] = DEFAULT
    bit_flag: uint8 = 0
    adc_reel: float32 = 0.0
    temperature_ntc1: int8 = 0
    temperature_ntc2: int8 = 0
    power_v: float32 = 0.0
    power_a: float32 = 0.0
    fan_frequency: Annotated[Ints, Array[uint16, 4]] = DEFAULT
    reserve: uint32 = 0
    crc: uint32 = 0


class MotorCmds(Message, typename="unitree_go/msg/MotorCmds"):
    """MotorCmds, as Unitree defines it."""

    cmds: Annotated[list[MotorCmd], Sequence[MotorCmd]] = DEFAULT


class MotorStates(Message, typename="unitree_go/msg/MotorStates"):
    """MotorStates, as Unitree defines it."""

    states: Annotated[list[MotorState], Sequence[MotorState]] = DEFAULT


class PathPoint(Message, typename="unitree_go/msg/PathPoint"):
    """PathPoint, as Unitree defines it."""

    t_from_start: float32 = 0.0
    x: float32 = 0.0
    y: float32 = 0.0
    yaw: float32 = 0.0
    vx: float32 = 0.0
    vy: float32 = 0.0
    vyaw: float32 = 0.0


class Req(Message, typename="unitree_go/msg/Req"):
    """Req, as Unitree defines it."""

    uuid: str = ""
    body: str = ""


class Res(Message, typename="unitree_go/msg/Res"):
    """Res, as Unitree defines it."""

    uuid: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    body: str = ""


class SportModeCmd(Message, typename="unitree_go/msg/SportModeCmd"):
    """SportModeCmd, as Unitree defines it."""

    mode: uint8 = 0
    gait_type: uint8 = 0
    speed_level: uint8 = 0
    foot_raise_height: float32 = 0.0
    body_height: float32 = 0.0
    position: Annotated[Floats, Array[float32, 2]] = DEFAULT
    euler: Annotated[Floats, Array[float32, 3]] = DEFAULT
    velocity: Annotated[Floats, Array[float32, 2]] = DEFAULT
    yaw_speed: float32 = 0.0
    bms_cmd: BmsCmd = DEFAULT
    path_point: Annotated[list[PathPoint], Array[PathPoint, 30]] = DEFAULT


class TimeSpec(Message, typename="unitree_go/msg/TimeSpec"):
    """TimeSpec, as Unitree defines it."""

    sec: int32 = 0
    nanosec: uint32 = 0


class SportModeState(Message, typename="unitree_go/msg/SportModeState"):
    """SportModeState, as Unitree defines it."""

    stamp: TimeSpec = DEFAULT
    error_code: uint32 = 0
    imu_state: IMUState = DEFAULT
    mode: uint8 = 0
    progress: float32 = 0.0
    gait_type: uint8 = 0
    foot_raise_height: float32 = 0.0
    position: Annotated[Floats, Array[float32, 3]] = DEFAULT
    body_height: float32 = 0.0
    velocity: Annotated[Floats, Array[float32, 3]] = DEFAULT
    yaw_speed: float32 = 0.0
    range_obstacle: Annotated[Floats, Array[float32, 4]] = DEFAULT
    foot_force: Annotated[Ints, Array[int16, 4]] = DEFAULT
    foot_position_body: Annotated[Floats, Array[float32, 12]] = DEFAULT
    foot_speed_body: Annotated[Floats, Array[float32, 12]] = DEFAULT


class UwbState(Message, typename="unitree_go/msg/UwbState"):
    """UwbState, as Unitree defines it."""

    version: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    channel: uint8 = 0
    joy_mode: uint8 = 0
    orientation_est: float32 = 0.0
    pitch_est: float32 = 0.0
    distance_est: float32 = 0.0
    yaw_est: float32 = 0.0
    tag_roll: float32 = 0.0
    tag_pitch: float32 = 0.0
    tag_yaw: float32 = 0.0
    base_roll: float32 = 0.0
    base_pitch: float32 = 0.0
    base_yaw: float32 = 0.0
    joystick: Annotated[Floats, Array[float32, 2]] = DEFAULT
    error_state: uint8 = 0
    buttons: uint8 = 0
    enabled_from_app: uint8 = 0


class UwbSwitch(Message, typename="unitree_go/msg/UwbSwitch"):
    """UwbSwitch, as Unitree defines it."""

    enabled: uint8 = 0


class WirelessController(Message, typename="unitree_go/msg/WirelessController"):
    """WirelessController, as Unitree defines it."""

    lx: float32 = 0.0
    ly: float32 = 0.0
    rx: float32 = 0.0
    ry: float32 = 0.0
    keys: uint16 = 0
