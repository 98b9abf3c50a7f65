"""The base of camera nodes: publishes the pictures of a device or a file."""

from __future__ import annotations

import asyncio
from contextlib import ExitStack
from typing import Any, Final

from aionode import Node, QoSProfile
from aionode._process.concurrency import DaemonThread
from aionode.errors import CommandError
from aionode.image import from_numpy
from aionode.interfaces.sensor_msgs.msg import CameraInfo, CompressedImage, Image
from aionode.interfaces.std_msgs.msg import Header
from aionode.programs._camera.calibration import Calibration
from aionode.programs._camera.republish import compressed
from aionode.programs._camera.video import FORMATS, Frame, Video, check_device
from aionode.programs._stamps import stamp_of
from aionode.programs._wall_timer import create_wall_timer, wall_clock

__all__ = ["Camera"]

START_SEC: Final = 0.01
MAX_SIDE: Final = 16_384
"""The most pixels in each direction: more than any camera has, in less than a gigabyte."""

RATES: Final = (1e-6, 1e6)
"""The least and the most pictures per second."""

RETRY_SEC: Final = 1.0
"""Delay after a failure before a camera is opened again."""


class Camera(Node):
    """Publishes `image_raw`, `camera_info`, and `image_raw/compressed` while it has subscriptions.

    Attributes:
        device: The device, or a video file, which is played in a loop.
        format: How its pixels are read and published.
        size: Width and height; zeros for those of the camera.
        rate: Pictures per second.
        frame_id: The frame of the camera.
        is_capturing: Whether pictures are taken.
        has_raw: Whether `image_raw` is published.
        jpeg_quality: That of images which the camera did not send as JPEG.
    """

    namespace = ""
    """What precedes the names of its topics."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.device = ""
        self.format = FORMATS["yuyv2rgb"]
        self.size = (640, 480)
        self.rate = 30.0
        self.frame_id = ""
        self.is_capturing = True
        self.has_raw = True
        self.jpeg_quality = 95
        self.offset_ns = 0

    def begin(
        self, calibration: Calibration, qos: QoSProfile, *, may_come_later: bool = False
    ) -> None:
        """Start publishing, as soon as the camera is there if it `may_come_later`.

        Raises:
            CommandError: There is no camera, no package to read it, no room for its pictures, or no
                time for them.
        """
        if max(self.size) > MAX_SIDE:
            raise CommandError(
                f"the camera should have {self.size} pixels; use at most {MAX_SIDE} for each"
            )
        slowest, fastest = RATES
        if not slowest <= self.rate <= fastest:
            raise CommandError(
                f"the camera should take {self.rate:g} pictures per second; use {slowest:g} to "
                f"{fastest:g}"
            )
        check_device(self.device, may_come_later=may_come_later)
        self.calibration = calibration
        image = f"{self.namespace}image_raw"
        self.images = self.create_publisher(Image, image, qos) if self.has_raw else None
        self.small = self.create_publisher(CompressedImage, f"{image}/compressed", qos)
        self.infos = self.create_publisher(CameraInfo, f"{self.namespace}camera_info", qos)
        create_wall_timer(self, START_SEC, self.capture)

    async def capture(self) -> None:
        """Publish pictures until the node ends, waiting for a camera that is unplugged."""
        while True:
            try:
                await self.play()
            except OSError as error:
                self.get_logger().error(
                    f"{self.device}: {error}; retrying until it can be opened",
                    throttle_duration_sec=10.0,
                )
                await wall_clock(self).sleep(RETRY_SEC)

    async def play(self) -> None:
        """Publish the pictures of a camera, or those of a file once.

        Raises:
            OSError: It cannot be opened, or can no longer be read.
        """
        clock = wall_clock(self)
        loop = asyncio.get_running_loop()
        count = 0
        with ExitStack() as stack:
            # A camera that is silent holds its thread until it is unplugged.
            thread = stack.enter_context(DaemonThread("aionode-camera"))
            video = await loop.run_in_executor(
                thread, Video, self.device, self.format, self.size, self.rate
            )
            stack.callback(video.close)
            while True:
                began = clock.now()
                frame = await loop.run_in_executor(thread, video.read)
                if frame is None and count and not video.is_camera:
                    return
                if frame is None:
                    raise OSError("it contains no pictures")
                count += 1
                if self.is_capturing:
                    await self.publish(frame)
                if not video.is_camera:
                    taken = (clock.now() - began).nanoseconds / 1e9
                    await clock.sleep(1.0 / self.rate - taken)

    async def publish(self, frame: Frame) -> None:
        """Publish a picture, and the calibration."""
        now = self.get_clock().now().nanoseconds + self.offset_ns
        header = Header(stamp=stamp_of(now), frame_id=self.frame_id)
        image = from_numpy(frame.pixels, frame.encoding, header)
        if self.images is not None:
            self.images.publish(image)
        if self.small.get_subscription_count():
            self.small.publish(await asyncio.to_thread(self.compressed, frame, image))
        found = self.calibration.for_size(image.width, image.height)
        info = CameraInfo(header=header, width=found.width, height=found.height)
        for name in ("distortion_model", "d", "k", "r", "p", "binning_x", "binning_y", "roi"):
            setattr(info, name, getattr(found, name))
        self.infos.publish(info)

    def compressed(self, frame: Frame, image: Image) -> Any:
        """Return a picture as JPEG: unchanged if it was one."""
        if frame.jpeg is not None:
            return CompressedImage(header=image.header, format="jpeg", data=frame.jpeg)
        image = from_numpy(*frame.for_jpeg(), image.header)
        return compressed(image, "jpeg", self.jpeg_quality, 3)
