"""Messages of ackermann_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, float32

__all__ = ["AckermannDrive", "AckermannDriveStamped"]


class AckermannDrive(Message, typename="ackermann_msgs/msg/AckermannDrive"):
    """How a vehicle with steered wheels is to drive: in radians, meters and seconds."""

    steering_angle: float32 = 0.0
    steering_angle_velocity: float32 = 0.0
    speed: float32 = 0.0
    acceleration: float32 = 0.0
    jerk: float32 = 0.0


class AckermannDriveStamped(Message, typename="ackermann_msgs/msg/AckermannDriveStamped"):
    """How a vehicle with steered wheels is to drive, with time and frame."""

    header: Header = DEFAULT
    drive: AckermannDrive = DEFAULT
