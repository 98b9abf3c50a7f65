"""The calibration of a camera, as in camera_info_manager: YAML files, referenced by URLs."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any, Final

import yaml

from aionode import Node
from aionode._packages import here
from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.errors import PackageNotFoundError
from aionode.interfaces.sensor_msgs.msg import CameraInfo
from aionode.interfaces.sensor_msgs.srv import SetCameraInfo
from aionode.message import check

__all__ = ["Calibration", "info_of", "text_of"]

USUAL: Final = "file://${ROS_HOME}/camera_info/${NAME}.yaml"
"""The default URL of a calibration."""

MATRICES: Final = {"k": ("camera_matrix", 3), "r": ("rectification_matrix", 3),
                   "p": ("projection_matrix", 4), "d": ("distortion_coefficients", 0)}  # fmt: skip
"""The matrices of a calibration, by the fields of CameraInfo, and their numbers of columns."""


def info_of(text: str) -> CameraInfo:
    """Parse a calibration.

    Raises:
        ValueError: The text is not a calibration.
    """
    try:
        given = loaded_yaml(text)
        matrices = {
            name: [float(number) for number in given[key]["data"]]
            for name, (key, _) in MATRICES.items()
        }
        info = CameraInfo(
            width=int(given["image_width"]),
            height=int(given["image_height"]),
            distortion_model=str(given.get("distortion_model", "plumb_bob")),
            binning_x=int(given.get("binning_x", 0)),
            binning_y=int(given.get("binning_y", 0)),
        )
        for name, numbers in matrices.items():
            setattr(info, name, numbers)
        check(info)
    except (
        yaml.YAMLError,
        LookupError,
        ArithmeticError,
        TypeError,
        AttributeError,
        ValueError,
    ) as error:
        raise ValueError(f"not a calibration: {type(error).__name__}: {error}") from None
    return info


def text_of(info: CameraInfo, name: str) -> str:
    """Return a calibration as the text of a file."""
    given: dict[str, Any] = {
        "image_width": info.width,
        "image_height": info.height,
        "camera_name": name,
        "distortion_model": info.distortion_model,
        "binning_x": info.binning_x,
        "binning_y": info.binning_y,
    }
    for field, (key, columns) in MATRICES.items():
        data = [float(number) for number in getattr(info, field)]
        rows, width = (len(data) // columns, columns) if columns else (1, len(data))
        given[key] = {"rows": rows, "cols": width, "data": data}
    return yaml.safe_dump(given, sort_keys=False, default_flow_style=None)


class Calibration:
    """Reads the calibration of a node's camera, and stores the one sent to `~/set_camera_info`.

    Args:
        node: The node.
        name: The name of the camera, which URLs may contain.
        url: The URL of the calibration: ``file:///…`` or ``package://NAME/…``.

    Attributes:
        info: The calibration; zeros if there is none.
    """

    def __init__(self, node: Node, name: str, url: str) -> None:
        self.name = name
        self.url = url
        self.log = node.get_logger()
        self.info = CameraInfo()
        self.load(url)
        node.create_service(SetCameraInfo, "~/set_camera_info", self.on_set)

    def load(self, url: str) -> None:
        """Read a calibration, logging what is wrong with it."""
        self.url = url
        path = self.path()
        if path is None:
            self.log.error(f"Invalid camera calibration URL: {url}")
            return
        self.log.info(f"camera calibration URL: {url or USUAL}")
        try:
            self.info = info_of(read_file(path).decode())
        except FileNotFoundError:
            self.log.warning(f"Camera calibration file {path} not found")
        except (OSError, ValueError) as error:
            text = " ".join(str(error).split())  # those of YAML have several lines
            self.log.warning(f"Camera calibration file {path} is not used: {text}")

    def path(self) -> Path | None:
        """Return the file of the calibration; None if its URL is invalid."""
        home = os.environ.get("ROS_HOME") or str(Path.home() / ".ros")
        url = (self.url or USUAL).replace("${NAME}", self.name).replace("${ROS_HOME}", home)
        if url.lower().startswith("file:///"):
            return Path(url[7:])
        match = re.fullmatch(r"package://([^/]+)/(.+)", url, re.IGNORECASE)
        if match is None:
            return None
        try:
            return here().share(match[1]) / match[2]
        except PackageNotFoundError as error:
            self.log.warning(str(error))
            return None

    def for_size(self, width: int, height: int) -> CameraInfo:
        """Return the calibration for images of a size; zeros if it is for another size."""
        if (self.info.width, self.info.height) == (width, height):
            return self.info
        return CameraInfo(width=width, height=height)

    def on_set(self, request: Any, response: Any) -> Any:
        """Store a calibration, in its file as well."""
        self.info = request.camera_info
        path = self.path()
        if path is None:
            response.status_message = (
                f"Error storing camera calibration: {self.url} is not the URL of a file"
            )
            return response
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text_of(self.info, self.name), encoding="utf-8")
            response.success = True
            self.log.info(f"writing calibration data to {path}")
        except OSError as error:
            response.status_message = f"Error storing camera calibration: {error}"
        return response
