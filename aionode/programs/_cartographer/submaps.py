"""Submaps, as Cartographer's service ``submap_query`` returns them."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from aionode.interfaces.cartographer_ros_msgs.msg import SubmapTexture
from aionode.interfaces.geometry_msgs.msg import Pose, Quaternion
from aionode.tf import rotation_matrix

__all__ = ["Array", "Placement", "Submap", "Texture", "placement_of", "texture_of"]

Array = npt.NDArray[Any]

MAX_CELLS: Final = 1 << 24
"""The most cells of a submap: those of Cartographer have about 100 000."""

NORMS: Final = (1e-3, 1e3)
"""The range of an orientation's norm; outside of it, products overflow or vanish."""

GZIP: Final = 16 + zlib.MAX_WBITS


class Placement(NamedTuple):
    """Where something is, as numbers that can be compared."""

    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]

    def matrices(self) -> tuple[Array, Array]:
        """Return its rotation as a matrix, and its position."""
        x, y, z, w = self.orientation
        return np.array(rotation_matrix(Quaternion(x=x, y=y, z=z, w=w))), np.array(self.position)


@dataclass(frozen=True, eq=False)
class Texture:
    """The cells of a submap.

    Attributes:
        version: Its version.
        cells: Height x width x intensity, opacity, and 255 if the cell was seen.
        resolution: The side of a cell in metres.
        placement: Where the first cell is, in the frame of the submap.
    """

    version: int
    cells: npt.NDArray[np.uint8]
    resolution: float
    placement: Placement


class Submap(NamedTuple):
    """A submap; two are equal if they have the same texture at the same place."""

    placement: Placement
    texture: Texture

    def affine(self) -> tuple[Array, Array]:
        """Return the matrix, and the shift, from a cell's column and row to x and minus y."""
        (turn, place), (own_turn, own_place) = (
            each.placement.matrices() for each in (self, self.texture)
        )
        whole = turn @ own_turn
        x, y, _ = place + turn @ own_place
        matrix = np.array([[whole[1, 0], -whole[1, 1]], [whole[0, 0], -whole[0, 1]]])
        return matrix * self.texture.resolution, np.array([x, -y])


def placement_of(pose: Pose) -> Placement:
    """Return a pose as numbers.

    Raises:
        ValueError: It is not finite, or has no orientation.
    """
    at, turn = pose.position, pose.orientation
    found = Placement((at.x, at.y, at.z), (turn.x, turn.y, turn.z, turn.w))
    low, high = NORMS
    if not all(map(math.isfinite, found.position)):
        raise ValueError("its position is not finite")
    if not low < math.hypot(*found.orientation) < high:
        raise ValueError("its orientation is not a rotation")
    return found


def texture_of(texture: SubmapTexture, version: int) -> Texture:
    """Return the cells of a submap, which are compressed in the message.

    Raises:
        ValueError: The message does not contain the cells of a submap.
    """
    width, height = texture.width, texture.height
    if min(width, height) < 1 or width * height > MAX_CELLS:
        raise ValueError(f"it has {width} x {height} cells; at most {MAX_CELLS} can be used")
    if not 0 < texture.resolution < math.inf:
        raise ValueError(f"its resolution is {texture.resolution}; a number above 0 is needed")
    size = 2 * width * height
    unzip = zlib.decompressobj(GZIP)
    try:
        data = unzip.decompress(texture.cells, size + 1)
    except zlib.error as error:
        raise ValueError(f"its cells are not gzip data: {error}") from None
    if len(data) != size or not unzip.eof:
        count = f"more than {size}" if len(data) > size else str(len(data))
        raise ValueError(f"its gzip data has {count} bytes; {width} x {height} cells need {size}")
    cells = np.frombuffer(data, np.uint8).reshape(height, width, 2)
    seen = np.where(cells.any(axis=2), np.uint8(255), np.uint8(0))
    return Texture(
        version, np.dstack((cells, seen)), texture.resolution, placement_of(texture.slice_pose)
    )
