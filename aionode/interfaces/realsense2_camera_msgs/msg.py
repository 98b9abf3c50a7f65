"""Messages of realsense2_camera_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.sensor_msgs.msg import CameraInfo, Image
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Array, Floats, Message, float64

__all__ = ["RGBD", "Extrinsics", "IMUInfo", "Metadata"]


class Extrinsics(Message, typename="realsense2_camera_msgs/msg/Extrinsics"):
    """Extrinsics, as RealSense defines it."""

    rotation: Annotated[Floats, Array[float64, 9]] = DEFAULT
    translation: Annotated[Floats, Array[float64, 3]] = DEFAULT


class IMUInfo(Message, typename="realsense2_camera_msgs/msg/IMUInfo"):
    """IMUInfo, as RealSense defines it."""

    header: Header = DEFAULT
    data: Annotated[Floats, Array[float64, 12]] = DEFAULT
    noise_variances: Annotated[Floats, Array[float64, 3]] = DEFAULT
    bias_variances: Annotated[Floats, Array[float64, 3]] = DEFAULT


class Metadata(Message, typename="realsense2_camera_msgs/msg/Metadata"):
    """Metadata, as RealSense defines it."""

    header: Header = DEFAULT
    json_data: str = ""


class RGBD(Message, typename="realsense2_camera_msgs/msg/RGBD"):
    """RGBD, as RealSense defines it."""

    header: Header = DEFAULT
    rgb_camera_info: CameraInfo = DEFAULT
    depth_camera_info: CameraInfo = DEFAULT
    rgb: Image = DEFAULT
    depth: Image = DEFAULT
