"""``usb_cam usb_cam_node_exe``: publishes the pictures of a camera."""

from __future__ import annotations

import asyncio
import shutil
import subprocess
from pathlib import Path
from typing import Any, Final

import aionode
from aionode import Parameter, QoSProfile
from aionode._process.concurrency import DaemonThread
from aionode.errors import CommandError
from aionode.interfaces.std_srvs.srv import SetBool
from aionode.programs._camera.calibration import Calibration
from aionode.programs._camera.camera import Camera
from aionode.programs._camera.video import FORMATS
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["UsbCam", "main"]

CONTROLS: Final = {"brightness": 50, "contrast": -1, "saturation": -1, "sharpness": -1, "gain": -1}
"""Controls of the camera and their values; those below 0 are not changed."""

SWITCHES: Final[dict[str, Any]] = {
    "auto_white_balance": True, "white_balance": 4000, "autoexposure": True, "exposure": 100,
    "autofocus": False, "focus": -1,
}  # fmt: skip

CONTROL_SEC: Final = 0.01
TIMEOUT_SEC: Final = 5.0
"""How long the driver of a camera may take for one control."""


class UsbCam(Camera):
    """Publishes the pictures of `video_device`.

    Raises:
        CommandError: A parameter is invalid, or there is no such camera.
    """

    def __init__(self) -> None:
        super().__init__("usb_cam")
        name = self.declare_parameter("camera_name", "default_cam").value
        url = self.declare_parameter("camera_info_url", "").value
        self.rate = self.declare_parameter("framerate", 30.0).value
        self.frame_id = self.declare_parameter("frame_id", "default_cam").value
        height = self.declare_parameter("image_height", 480).value
        self.size = (self.declare_parameter("image_width", 640).value, height)
        method = self.declare_parameter("io_method", "mmap").value
        pixels = self.declare_parameter("pixel_format", "yuyv").value
        self.declare_parameter("av_device_format", "YUV422P")
        self.device = self.declare_parameter("video_device", "/dev/video0").value
        for parameter, value in (CONTROLS | SWITCHES).items():
            self.declare_parameter(parameter, value)
        skips_check = self.declare_parameter("skip_device_check", False).value
        if skips_check:
            self.get_logger().warning("Skipping V4L2 device availability check by request.")
        if pixels not in FORMATS:
            raise CommandError(f"pixel_format is {pixels!r}; use {', '.join(FORMATS)}")
        self.format = FORMATS[pixels]
        if min(self.size) < 1:
            raise CommandError(f"the camera should have {self.size} pixels; use numbers above 0")
        self.has_raw = pixels != "mjpeg"
        qos = QoSProfile(depth=100)
        self.begin(Calibration(self, name, url), qos, may_come_later=skips_check)
        self.get_logger().info(
            f"Starting '{name}' ({self.device}) at {self.size[0]}x{self.size[1]} via {method} "
            f"({pixels}) at {int(self.rate)} FPS"
        )
        self.create_service(SetBool, "set_capture", self.on_set_capture)
        self.controlling = create_wall_timer(self, CONTROL_SEC, self.control_again, autostart=False)
        self.add_post_set_parameters_callback(self.on_parameters)

    async def capture(self) -> None:
        """Set the controls of the camera, and publish its pictures until the node ends."""
        await self.set_controls()
        await super().capture()

    def on_parameters(self, parameters: list[Parameter]) -> None:
        """Set the controls of the camera again, soon."""
        if any(parameter.name in CONTROLS | SWITCHES for parameter in parameters):
            self.controlling.reset()

    async def control_again(self) -> None:
        """Set the controls of the camera, once."""
        self.controlling.cancel()
        await self.set_controls()

    async def set_controls(self) -> None:
        """Set the controls of the camera, for which its driver may take long."""
        with DaemonThread("aionode-camera") as thread:
            await asyncio.get_running_loop().run_in_executor(thread, self.control)

    def on_set_capture(self, request: Any, response: Any) -> Any:
        """Start or stop taking pictures."""
        self.is_capturing = request.data
        response.success = True
        response.message = "Start Capturing" if request.data else "Stop Capturing"
        return response

    def controls(self) -> dict[str, int]:
        """Return the controls to set at the camera, by the names of its driver."""
        value = {name: self.get_parameter(name).value for name in (*CONTROLS, *SWITCHES)}
        found = {name: value[name] for name in CONTROLS if value[name] >= 0}
        found["white_balance_temperature_auto"] = int(value["auto_white_balance"])
        if not value["auto_white_balance"]:
            found["white_balance_temperature"] = value["white_balance"]
        found["exposure_auto"] = 3 if value["autoexposure"] else 1
        if not value["autoexposure"]:
            found["exposure_absolute"] = value["exposure"]
        found["focus_auto"] = int(value["autofocus"])
        if not value["autofocus"] and value["focus"] >= 0:
            found["focus_absolute"] = value["focus"]
        return found

    def control(self) -> None:
        """Set the controls of the camera with v4l2-ctl, like the original; in a thread."""
        if not Path(self.device).resolve().is_relative_to("/dev"):
            return
        program = shutil.which("v4l2-ctl")
        if program is None:
            self.get_logger().warning(
                "brightness, exposure and other controls are set by v4l2-ctl, which is not "
                "installed: apt install v4l-utils"
            )
            return
        for name, value in self.controls().items():
            command = [program, f"--device={self.device}", "-c", f"{name}={value}"]
            text = f"Setting '{name}' to {value}"
            try:
                subprocess.run(  # noqa: S603  # a name of the table above, and a number
                    command, capture_output=True, text=True, check=True, timeout=TIMEOUT_SEC
                )
            except subprocess.CalledProcessError as error:
                self.get_logger().warning(f"{text} failed: {error.stderr.strip()!r}")
            except (OSError, subprocess.TimeoutExpired) as error:
                self.get_logger().warning(f"{text} failed: {error}")
            else:
                self.get_logger().info(text)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(UsbCam)
