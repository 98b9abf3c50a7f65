"""``v4l2_camera v4l2_camera_node``: publishes the pictures of a camera."""

from __future__ import annotations

import re
from typing import Final

import aionode
from aionode import QoSProfile
from aionode.errors import CommandError
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.programs._camera.calibration import Calibration
from aionode.programs._camera.camera import Camera
from aionode.programs._camera.video import FORMATS, name_of
from aionode.qos import qos_profile_sensor_data

__all__ = ["V4L2Camera", "main"]

PIXELS: Final = {"YUYV": "yuyv", "UYVY": "uyvy", "MJPG": "mjpeg", "RGB3": "rgb8", "GREY": "mono8"}
"""The names of pixel formats, by their four-letter codes."""

ENCODINGS: Final = {"rgb8": "2rgb", "yuv422": "", "yuv422_yuy2": "", "mono8": ""}


class V4L2Camera(Camera):
    """Publishes the pictures of `video_device`.

    Raises:
        CommandError: A parameter is invalid, or there is no such camera.
    """

    def __init__(self) -> None:
        super().__init__("v4l2_camera")
        fixed = ParameterDescriptor(read_only=True)
        is_sensor = self.declare_parameter("use_sensor_data_qos", False).value
        self.device = self.declare_parameter("video_device", "/dev/video0", fixed).value
        self.declare_parameter("use_v4l2_buffer_timestamps", True)
        self.offset_ns = self.declare_parameter("timestamp_offset", 0).value
        encoding = self.declare_parameter("output_encoding", "rgb8").value
        url = self.declare_parameter("camera_info_url", "").value
        self.frame_id = self.declare_parameter("camera_frame_id", "camera", fixed).value
        pixels = self.declare_parameter("pixel_format", "YUYV").value
        if pixels not in PIXELS or encoding not in ENCODINGS:
            raise CommandError(
                f"pixel_format is {pixels!r} and output_encoding {encoding!r}; "
                f"use {' or '.join(PIXELS)}, and {' or '.join(ENCODINGS)}"
            )
        self.format = FORMATS[self.format_of(PIXELS[pixels], encoding)]
        size = list(self.declare_parameter("image_size", [640, 480]).value)
        if len(size) != 2 or min(size) < 1:
            raise CommandError(f"Invalid image size; expected dimensions: 2, given: {size}")
        self.size = (int(size[0]), int(size[1]))
        period = list(self.declare_parameter("time_per_frame", [1, 30]).value)
        if len(period) != 2 or min(period) < 1:
            raise CommandError(f"Invalid time per frame; expected dimensions: 2, given: {period}")
        self.rate = period[1] / period[0]
        name = re.sub(r"\W", "_", name_of(self.device).lower())
        qos = qos_profile_sensor_data if is_sensor else QoSProfile(depth=10)
        self.begin(Calibration(self, name, url), qos)

    @staticmethod
    def format_of(pixels: str, encoding: str) -> str:
        """Return how pixels are read, and how they are published."""
        if encoding == "mono8":
            return "mono8"
        if encoding == "rgb8":
            return pixels if pixels == "rgb8" else f"{pixels.replace('mono8', 'yuyv')}2rgb"
        return "uyvy" if encoding == "yuv422" else "yuyv"


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(V4L2Camera)
