"""Services of sensor_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.sensor_msgs.msg import CameraInfo
from aionode.message import DEFAULT, Message, ServiceType

__all__ = ["SetCameraInfo"]


class SetCameraInfo(ServiceType, typename="sensor_msgs/srv/SetCameraInfo"):
    """Have a camera store its calibration."""

    class Request(Message):
        """The calibration."""

        camera_info: CameraInfo = DEFAULT

    class Response(Message):
        """Whether it was stored, or why not."""

        success: bool = False
        status_message: str = ""
