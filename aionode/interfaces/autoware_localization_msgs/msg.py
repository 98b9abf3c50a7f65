"""Messages of autoware_localization_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geometry_msgs.msg import (
    AccelWithCovariance,
    PoseWithCovariance,
    TwistWithCovariance,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message

__all__ = ["KinematicState"]


class KinematicState(Message, typename="autoware_localization_msgs/msg/KinematicState"):
    """KinematicState, as Autoware defines it."""

    header: Header = DEFAULT
    child_frame_id: str = ""
    pose_with_covariance: PoseWithCovariance = DEFAULT
    twist_with_covariance: TwistWithCovariance = DEFAULT
    accel_with_covariance: AccelWithCovariance = DEFAULT
