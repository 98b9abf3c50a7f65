"""sensor_msgs."""

from aionode.interfaces.sensor_msgs.msg import CameraInfo
from aionode.message import DEFAULT, Message, ServiceType


class SetCameraInfo(ServiceType, typename="sensor_msgs/srv/SetCameraInfo"):
    """SetCameraInfo."""

    class Request(Message):
        """Request."""

        camera_info: CameraInfo = DEFAULT

    class Response(Message):
        """Response."""

        success: bool = False
        status_message: str = ""
