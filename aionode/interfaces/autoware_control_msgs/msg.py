"""Messages of autoware_control_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, Sequence, float32

__all__ = ["Control", "ControlHorizon", "Lateral", "Longitudinal"]


class Lateral(Message, typename="autoware_control_msgs/msg/Lateral"):
    """Lateral, as Autoware defines it."""

    stamp: Time = DEFAULT
    control_time: Time = DEFAULT
    steering_tire_angle: float32 = 0.0
    steering_tire_rotation_rate: float32 = 0.0
    is_defined_steering_tire_rotation_rate: bool = False


class Longitudinal(Message, typename="autoware_control_msgs/msg/Longitudinal"):
    """Longitudinal, as Autoware defines it."""

    stamp: Time = DEFAULT
    control_time: Time = DEFAULT
    velocity: float32 = 0.0
    acceleration: float32 = 0.0
    jerk: float32 = 0.0
    is_defined_acceleration: bool = False
    is_defined_jerk: bool = False


class Control(Message, typename="autoware_control_msgs/msg/Control"):
    """Control, as Autoware defines it."""

    stamp: Time = DEFAULT
    control_time: Time = DEFAULT
    lateral: Lateral = DEFAULT
    longitudinal: Longitudinal = DEFAULT


class ControlHorizon(Message, typename="autoware_control_msgs/msg/ControlHorizon"):
    """ControlHorizon, as Autoware defines it."""

    stamp: Time = DEFAULT
    control_time: Time = DEFAULT
    time_step_ms: float32 = 0.0
    controls: Annotated[list[Control], Sequence[Control]] = DEFAULT
