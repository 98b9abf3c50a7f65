"""Messages of robot_controllers_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.message import Message, float64, uint8

__all__ = ["ControllerState", "DiffDriveLimiterParams"]


class ControllerState(Message, typename="robot_controllers_msgs/msg/ControllerState"):
    """ControllerState, as robot_controllers defines it."""

    STOPPED: ClassVar[uint8] = 0
    RUNNING: ClassVar[uint8] = 1
    ERROR: ClassVar[uint8] = 2

    name: str = ""
    type: str = ""
    state: uint8 = 0


class DiffDriveLimiterParams(Message, typename="robot_controllers_msgs/msg/DiffDriveLimiterParams"):
    """DiffDriveLimiterParams, as robot_controllers defines it."""

    max_linear_velocity: float64 = 0.0
    max_linear_acceleration: float64 = 0.0
    max_angular_velocity: float64 = 0.0
    max_angular_acceleration: float64 = 0.0
    max_wheel_velocity: float64 = 0.0
    track_width: float64 = 0.0
    angular_velocity_limits_linear_velocity: bool = False
    scale_to_wheel_velocity_limits: bool = False
