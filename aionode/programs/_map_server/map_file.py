"""Maps in files: a YAML file, and a picture in which darker pixels are more occupied."""

from __future__ import annotations

import math
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import yaml

from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.image import FORMATS, pillow
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion
from aionode.interfaces.nav_msgs.msg import MapMetaData, OccupancyGrid

__all__ = ["MapImageError", "MapYamlError", "load_map"]

MODES: Final = ("trinary", "scale", "raw")
OCCUPIED: Final = 100
FREE: Final = 0
UNKNOWN: Final = -1
ROWS: Final = 256
"""How many rows are converted at once: floating-point numbers take eight times as much memory."""


class MapYamlError(ValueError):
    """The YAML file of a map cannot be used; the text says why."""


class MapImageError(ValueError):
    """The picture of a map cannot be used; the text says why."""


@dataclass(frozen=True)
class MapFile:
    """What the YAML file of a map says.

    Attributes:
        image: The picture.
        resolution: The width of a cell, in m.
        origin: Where the lower left corner is: x, y and yaw.
        free: Cells that are less occupied are free, in the modes trinary and scale.
        occupied: Cells that are more occupied are occupied, in these modes.
        negate: Whether brighter pixels are more occupied.
        mode: Cells in between are unknown (trinary) or a percentage (scale); in the mode raw,
            pixels are used as cells.
    """

    image: Path
    resolution: float
    origin: tuple[float, float, float]
    free: float
    occupied: float
    negate: bool
    mode: str

    @classmethod
    def read(cls, path: Path) -> MapFile:
        """Read the YAML file of a map.

        Raises:
            MapYamlError: It cannot be read, or a value is missing or does not fit.
        """
        try:
            content = loaded_yaml(read_file(path))
        except (OSError, yaml.YAMLError, ValueError) as error:
            raise MapYamlError(f"{path}: {error}") from None
        if not isinstance(content, dict):
            raise MapYamlError(f"{path}: it is not a mapping with the keys of a map")

        def given(key: str, fits: Any, what: str, default: Any = None) -> Any:
            value = content.get(key, default)
            if not fits(value):
                raise MapYamlError(f"{path}: '{key}' is {value!r}; use {what}")
            return value

        image = given("image", lambda x: isinstance(x, str) and x, "the name of a picture")
        origin = given(
            "origin",
            lambda x: isinstance(x, list) and len(x) == 3 and all(map(is_number, x)),
            "a list of three numbers: x, y and yaw",
        )
        return cls(
            path.parent / image,
            float(given("resolution", lambda x: is_number(x) and x > 0, "a width above 0")),
            (float(origin[0]), float(origin[1]), float(origin[2])),
            float(given("free_thresh", is_number, "a number")),
            float(given("occupied_thresh", is_number, "a number")),
            bool(given("negate", lambda x: isinstance(x, int), "0 or 1")),
            given("mode", lambda x: x in MODES, " or ".join(MODES), "trinary"),
        )


def is_number(value: Any) -> bool:
    """Return whether a value is a finite number."""
    return type(value) in (int, float) and math.isfinite(value)


def load_map(path: Path) -> OccupancyGrid:
    """Read a map, without its frame and time.

    Raises:
        MapYamlError: Its YAML file cannot be used.
        MapImageError: Its picture cannot be used.
        ModuleNotFoundError: Pillow is missing.
    """
    file = MapFile.read(path)
    module = pillow()
    try:
        with module.open(BytesIO(read_file(file.image)), formats=(*FORMATS, "PPM")) as picture:
            has_alpha = "A" in picture.getbands() or "transparency" in picture.info
            pixels = np.asarray(picture.convert("RGBA"))
    except (OSError, SyntaxError, ValueError, module.DecompressionBombError) as error:
        raise MapImageError(f"{file.image}: {error}") from None
    blocks = [
        cells_of(pixels[row : row + ROWS] / 255.0, file, has_alpha=has_alpha)
        for row in range(0, len(pixels), ROWS)
    ]
    cells = np.flipud(np.concatenate(blocks))
    x, y, yaw = file.origin
    return OccupancyGrid(
        info=MapMetaData(
            resolution=file.resolution,
            width=cells.shape[1],
            height=cells.shape[0],
            origin=Pose(
                position=Point(x=x, y=y),
                orientation=Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2)),
            ),
        ),
        data=np.ascontiguousarray(cells).reshape(-1),
    )


def cells_of(
    pixels: npt.NDArray[np.float64], file: MapFile, *, has_alpha: bool
) -> npt.NDArray[np.int8]:
    """Return how much each cell is occupied, in percent, and -1 if it is unknown."""
    alpha = pixels[..., 3]
    # As in the original: transparent pixels are brighter in this mode only.
    channels = 4 if file.mode == "trinary" and has_alpha else 3
    shade = pixels[..., :channels].mean(axis=2)
    if file.mode == "raw":
        percent = np.round(shade * 255)
        return np.where(percent <= OCCUPIED, percent, UNKNOWN).astype(np.int8)
    occupied = shade if file.negate else 1.0 - shade
    between: Any = UNKNOWN
    if file.mode == "scale":
        span = file.occupied - file.free
        between = np.rint((occupied - file.free) / (span or math.inf) * 100)
    cells = np.where(occupied < file.free, FREE, between)
    cells = np.where(occupied > file.occupied, OCCUPIED, cells)
    if file.mode == "scale":
        cells = np.where(alpha < 1.0, UNKNOWN, cells)
    return cells.astype(np.int8)
