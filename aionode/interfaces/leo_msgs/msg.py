"""Messages of leo_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Array, Floats, Message, float32

__all__ = ["Imu", "WheelOdom", "WheelOdomMecanum", "WheelStates"]


class Imu(Message, typename="leo_msgs/msg/Imu"):
    """Imu, as Leo Rover defines it."""

    stamp: Time = DEFAULT
    temperature: float32 = 0.0
    gyro_x: float32 = 0.0
    gyro_y: float32 = 0.0
    gyro_z: float32 = 0.0
    accel_x: float32 = 0.0
    accel_y: float32 = 0.0
    accel_z: float32 = 0.0


class WheelOdom(Message, typename="leo_msgs/msg/WheelOdom"):
    """WheelOdom, as Leo Rover defines it."""

    stamp: Time = DEFAULT
    velocity_lin: float32 = 0.0
    velocity_ang: float32 = 0.0
    pose_x: float32 = 0.0
    pose_y: float32 = 0.0
    pose_yaw: float32 = 0.0


class WheelOdomMecanum(Message, typename="leo_msgs/msg/WheelOdomMecanum"):
    """WheelOdomMecanum, as Leo Rover defines it."""

    stamp: Time = DEFAULT
    velocity_lin_x: float32 = 0.0
    velocity_lin_y: float32 = 0.0
    velocity_ang: float32 = 0.0
    pose_x: float32 = 0.0
    pose_y: float32 = 0.0
    pose_yaw: float32 = 0.0


class WheelStates(Message, typename="leo_msgs/msg/WheelStates"):
    """WheelStates, as Leo Rover defines it."""

    stamp: Time = DEFAULT
    position: Annotated[Floats, Array[float32, 4]] = DEFAULT
    velocity: Annotated[Floats, Array[float32, 4]] = DEFAULT
    torque: Annotated[Floats, Array[float32, 4]] = DEFAULT
    pwm_duty_cycle: Annotated[Floats, Array[float32, 4]] = DEFAULT
