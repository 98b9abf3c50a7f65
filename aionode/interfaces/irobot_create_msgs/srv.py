"""Services of irobot_create_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.message import DEFAULT, Message, ServiceType

__all__ = ["EStop", "ResetPose", "RobotPower"]


class EStop(ServiceType, typename="irobot_create_msgs/srv/EStop"):
    """EStop, as the Create 3 defines it."""

    class Request(Message):
        """The request of EStop."""

        e_stop_on: bool = False

    class Response(Message):
        """The response of EStop."""

        success: bool = False
        message: str = ""


class ResetPose(ServiceType, typename="irobot_create_msgs/srv/ResetPose"):
    """ResetPose, as the Create 3 defines it."""

    class Request(Message):
        """The request of ResetPose."""

        pose: Pose = DEFAULT

    class Response(Message):
        """The response of ResetPose."""


class RobotPower(ServiceType, typename="irobot_create_msgs/srv/RobotPower"):
    """RobotPower, as the Create 3 defines it."""

    class Request(Message):
        """The request of RobotPower."""

    class Response(Message):
        """The response of RobotPower."""

        success: bool = False
        message: str = ""
