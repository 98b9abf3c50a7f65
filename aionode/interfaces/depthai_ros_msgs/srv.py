"""Services of depthai_ros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geometry_msgs.msg import Pose2D
from aionode.message import DEFAULT, Message, ServiceType, int64

__all__ = ["NormalizedImageCrop", "TriggerNamed"]


class NormalizedImageCrop(ServiceType, typename="depthai_ros_msgs/srv/NormalizedImageCrop"):
    """NormalizedImageCrop, as DepthAI defines it."""

    class Request(Message):
        """The request of NormalizedImageCrop."""

        top_left: Pose2D = DEFAULT
        bottom_right: Pose2D = DEFAULT

    class Response(Message):
        """The response of NormalizedImageCrop."""

        status: int64 = 0


class TriggerNamed(ServiceType, typename="depthai_ros_msgs/srv/TriggerNamed"):
    """TriggerNamed, as DepthAI defines it."""

    class Request(Message):
        """The request of TriggerNamed."""

        name: str = ""

    class Response(Message):
        """The response of TriggerNamed."""

        success: bool = False
        message: str = ""
