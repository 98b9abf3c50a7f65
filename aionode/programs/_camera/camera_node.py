"""``camera_ros camera_node``: publishes the pictures of a camera, without libcamera."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final, NamedTuple

import aionode
from aionode import Parameter, QoSProfile
from aionode.errors import CommandError
from aionode.interfaces.rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from aionode.programs._camera.calibration import Calibration
from aionode.programs._camera.camera import Camera
from aionode.programs._camera.video import FORMATS, SYSTEM, Format, name_of, text_in

__all__ = ["CameraNode", "Device", "chosen", "devices", "main"]

PIXELS: Final = {
    "": Format("", "rgb24", "rgb8"),
    "BGR888": Format("", "rgb24", "rgb8"),
    "RGB888": Format("", "bgr24", "bgr8"),
    **dict.fromkeys(("XRGB8888", "ARGB8888"), Format("", "bgra", "bgra8")),
    **dict.fromkeys(("XBGR8888", "ABGR8888"), Format("", "rgba", "rgba8")),
    "YUYV": FORMATS["yuyv"],
    "UYVY": FORMATS["uyvy"],
    "R8": FORMATS["mono8"],
    "R16": FORMATS["mono16"],
    "MJPEG": FORMATS["mjpeg"],
}
"""Pixel formats by libcamera's names, which read a pixel from its last byte to its first."""

ROLES: Final = ("viewfinder", "video", "still", "raw")

CONTROLS: Final = (
    *("AeEnable", "AeMeteringMode", "AeConstraintMode", "AeExposureMode", "AeFlickerMode"),
    *("AeFlickerPeriod", "ExposureValue", "ExposureTime", "ExposureTimeMode", "AnalogueGain"),
    *("AnalogueGainMode", "DigitalGain", "Brightness", "Contrast", "Saturation", "Sharpness"),
    *("Gamma", "AwbEnable", "AwbMode", "ColourGains", "ColourTemperature", "ScalerCrop"),
    *("ColourCorrectionMatrix", "HdrMode", "NoiseReductionMode", "AfMode", "AfRange", "AfSpeed"),
    *("AfMetering", "AfWindows", "AfTrigger", "AfPause", "LensPosition"),
)
"""The controls of libcamera, which are parameters in the original."""

MJPEG: Final = "MJPEG"


class Device(NamedTuple):
    """A camera.

    Attributes:
        path: Its device.
        name: Its name, as reported by its driver.
        usb: How libcamera's name for it ends, if it is connected by USB; otherwise empty.
    """

    path: str
    name: str
    usb: str


def devices() -> list[Device]:
    """Return the cameras of this machine, in the order of their devices."""
    found = []
    for folder in sorted(SYSTEM.glob("video[0-9]*"), key=lambda each: int(each.name[5:])):
        # Cameras have further devices, such as for metadata.
        if text_in(folder / "index") in ("0", ""):
            place = (folder / "device").resolve()
            vendor, product = (
                text_in(place.parent / f"id{part}") for part in ("Vendor", "Product")
            )
            usb = f"-{place.name.partition('-')[2]}-{vendor}:{product}" if vendor else ""
            path = f"/dev/{folder.name}"
            found.append(Device(path, name_of(path), usb))
    return found


def chosen(camera: object, cameras: list[Device]) -> str:
    """Return the device of a camera that is given by index or name, or the path of a video.

    Raises:
        CommandError: There is no such camera.
    """
    wanted = 0 if camera is None else camera
    if isinstance(wanted, int) and not isinstance(wanted, bool) and 0 <= wanted < len(cameras):
        return cameras[wanted].path
    if isinstance(wanted, str) and wanted:
        for device in cameras:
            if wanted in (device.path, device.name) or (device.usb and wanted.endswith(device.usb)):
                return device.path
        if Path(wanted).exists():
            return wanted
    listed = ", ".join(f"{at} {each.name!r} ({each.path})" for at, each in enumerate(cameras))
    raise CommandError(
        f"camera {camera!r} does not exist; cameras here: {listed or 'none'}; the path of a video "
        "file works as well"
        if camera is not None
        else "no cameras available; set parameter 'camera' to the path of a device or a video file"
    )


class CameraNode(Camera):
    """Publishes the pictures of `camera`.

    Raises:
        CommandError: A parameter is invalid, or there is no such camera.
    """

    namespace = "~/"

    def __init__(self) -> None:
        super().__init__("camera")
        pixels = self.fixed("format", "")
        role = self.fixed("role", ROLES[0])
        self.size = (self.fixed("width", 0), self.fixed("height", 0))
        mode = self.fixed("sensor_mode", "")
        self.frame_id = self.fixed("frame_id", "camera")
        turns = IntegerRange(from_value=0, to_value=270, step=90)
        orientation = self.fixed("orientation", 0, integer_range=[turns])
        url = self.fixed("camera_info_url", "")
        camera = self.fixed("camera", None, dynamic_typing=True)
        self.fixed("use_node_time", False)
        limits = self.fixed("FrameDurationLimits", None, dynamic_typing=True)
        self.check(pixels, role, mode)
        if limits is not None:
            self.rate = rate_of(limits)
        if pixels != MJPEG:
            percent = IntegerRange(from_value=1, to_value=100, step=1)
            descriptor = ParameterDescriptor(integer_range=[percent])
            self.jpeg_quality = self.declare_parameter("jpeg_quality", 95, descriptor).value
            self.add_post_set_parameters_callback(self.on_parameters)
        for name, value, usual in (
            ("role", role, ROLES[0]),
            ("sensor_mode", mode, ""),
            ("orientation", orientation, 0),
        ):
            if value != usual:
                self.warn_of(name, value)
        for name in CONTROLS:
            value = self.fixed(name, None, dynamic_typing=True)
            if value is not None:
                self.warn_of(name, value)
        self.format = PIXELS[pixels]
        self.device = chosen(camera, devices())
        for is_auto, what, names in (
            (camera is None, "camera", "'camera'"),
            (not pixels, "pixel format", "'format'"),
            (not any(self.size), "dimensions", "'width' and 'height'"),
        ):
            if is_auto:
                self.get_logger().warning(
                    f"no {what} selected, auto-selecting; set {names} to silence this warning"
                )
        name = "_".join([name_of(self.device), *map(str, filter(None, self.size))])
        self.begin(Calibration(self, re.sub(r"\W", "_", name), url), QoSProfile(depth=1))
        self.get_logger().info(f"camera {name_of(self.device)!r} ({self.device})")

    def fixed(self, name: str, usual: Any, **more: Any) -> Any:
        """Return a parameter that is read once."""
        descriptor = ParameterDescriptor(read_only=True, **more)
        return self.declare_parameter(name, usual, descriptor).value

    def check(self, pixels: str, role: str, mode: str) -> None:
        """Check the parameters that select a stream.

        Raises:
            CommandError: One is invalid.
        """
        if pixels not in PIXELS:
            known = ", ".join(filter(None, PIXELS))
            raise CommandError(f"unsupported pixel format {pixels!r}; use {known}")
        if role not in ROLES:
            raise CommandError(f"invalid stream role: {role!r}; use {', '.join(ROLES)}")
        if mode and re.fullmatch(r"\d+:\d+", mode) is None:
            raise CommandError(f"Invalid sensor_mode. Expected [width]:[height] but got {mode!r}")
        if any(self.size) and min(self.size) < 1:
            width, height = self.size
            raise CommandError(
                f"width is {width} and height {height}; use numbers above 0 for both"
            )

    def warn_of(self, name: str, value: object) -> None:
        """Warn that a parameter has no effect."""
        self.get_logger().warning(
            f"parameter '{name}' is {value!r} and has no effect: it is for libcamera, and this "
            "camera is read without it"
        )

    def on_parameters(self, parameters: list[Parameter]) -> None:
        """Compress the next image with another quality."""
        for parameter in parameters:
            if parameter.name == "jpeg_quality":
                self.jpeg_quality = parameter.value


def rate_of(limits: Any) -> float:
    """Return the pictures per second for the shortest and the longest time between two.

    Raises:
        CommandError: The times are not two numbers of microseconds.
    """
    match list(limits) if isinstance(limits, Iterable) else []:
        case [int(shortest), int(longest)] if 0 < shortest <= longest:
            return 1e6 / shortest
    raise CommandError(
        f"FrameDurationLimits is {limits!r}; use the shortest and the longest time in "
        "microseconds, such as [33333, 33333]"
    )


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(CameraNode)
