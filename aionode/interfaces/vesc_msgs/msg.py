"""Messages of vesc_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.geometry_msgs.msg import Quaternion, Vector3
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, float64, int32

__all__ = ["VescImu", "VescImuStamped", "VescState", "VescStateStamped"]


class VescImu(Message, typename="vesc_msgs/msg/VescImu"):
    """What the IMU of a VESC measures; `ypr` are roll, pitch and yaw, in degrees."""

    ypr: Vector3 = DEFAULT
    linear_acceleration: Vector3 = DEFAULT
    angular_velocity: Vector3 = DEFAULT
    compass: Vector3 = DEFAULT
    orientation: Quaternion = DEFAULT


class VescImuStamped(Message, typename="vesc_msgs/msg/VescImuStamped"):
    """What the IMU of a VESC measures, with time and frame."""

    header: Header = DEFAULT
    imu: VescImu = DEFAULT


class VescState(Message, typename="vesc_msgs/msg/VescState"):
    """State of a VESC: temperatures, currents, voltage, speed in electrical RPM, and its fault."""

    FAULT_CODE_NONE: ClassVar[int32] = 0
    FAULT_CODE_OVER_VOLTAGE: ClassVar[int32] = 1
    FAULT_CODE_UNDER_VOLTAGE: ClassVar[int32] = 2
    FAULT_CODE_DRV8302: ClassVar[int32] = 3
    FAULT_CODE_ABS_OVER_CURRENT: ClassVar[int32] = 4
    FAULT_CODE_OVER_TEMP_FET: ClassVar[int32] = 5
    FAULT_CODE_OVER_TEMP_MOTOR: ClassVar[int32] = 6

    temp_fet: float64 = 0.0
    temp_motor: float64 = 0.0
    current_motor: float64 = 0.0
    current_input: float64 = 0.0
    avg_id: float64 = 0.0
    avg_iq: float64 = 0.0
    duty_cycle: float64 = 0.0
    speed: float64 = 0.0
    voltage_input: float64 = 0.0
    charge_drawn: float64 = 0.0
    charge_regen: float64 = 0.0
    energy_drawn: float64 = 0.0
    energy_regen: float64 = 0.0
    displacement: int32 = 0
    distance_traveled: int32 = 0
    fault_code: int32 = 0
    pid_pos_now: float64 = 0.0
    controller_id: int32 = 0
    ntc_temp_mos1: float64 = 0.0
    ntc_temp_mos2: float64 = 0.0
    ntc_temp_mos3: float64 = 0.0
    avg_vd: float64 = 0.0
    avg_vq: float64 = 0.0


class VescStateStamped(Message, typename="vesc_msgs/msg/VescStateStamped"):
    """State of a VESC, with time and frame."""

    header: Header = DEFAULT
    state: VescState = DEFAULT
