"""Services of realsense2_camera_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType

__all__ = ["DeviceInfo"]


class DeviceInfo(ServiceType, typename="realsense2_camera_msgs/srv/DeviceInfo"):
    """DeviceInfo, as RealSense defines it."""

    class Request(Message):
        """The request of DeviceInfo."""

    class Response(Message):
        """The response of DeviceInfo."""

        device_name: str = ""
        serial_number: str = ""
        firmware_version: str = ""
        usb_type_descriptor: str = ""
        firmware_update_id: str = ""
        sensors: str = ""
        physical_port: str = ""
