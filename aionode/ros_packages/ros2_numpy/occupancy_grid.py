"""Occupancy grids as masked arrays."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np
import numpy.typing as npt

from ros2_numpy.registry import converts_from_numpy, converts_to_numpy
from rosidl_generator_py import message_class

__all__ = ["numpy_to_occupancy_grid", "occupancygrid_to_numpy"]

MapMetaData = message_class("nav_msgs/msg/MapMetaData")
OccupancyGrid = message_class("nav_msgs/msg/OccupancyGrid")

UNKNOWN = -1


@converts_to_numpy(OccupancyGrid)
def occupancygrid_to_numpy(msg: Any) -> npt.NDArray[np.int8]:
    """Return the cells; unknown ones (-1) are masked."""
    cells = np.asarray(msg.data, dtype=np.int8).reshape(msg.info.height, msg.info.width)
    return np.ma.array(cells, mask=cells == UNKNOWN, fill_value=UNKNOWN)


@converts_from_numpy(OccupancyGrid)
def numpy_to_occupancy_grid(arr: npt.NDArray[np.int8], info: Any = None) -> Any:
    """Return a map from rows and columns of int8; masked cells keep their stored value.

    Args:
        arr: The cells.
        info: The map's other metadata; its width and height are set.

    Raises:
        TypeError: The array has another shape or type.
    """
    if arr.ndim != 2:
        raise TypeError(f"the array has {arr.ndim} dimensions; a map has two")
    if arr.dtype != np.int8:
        raise TypeError(f"the array has the type {arr.dtype}; a map has int8")
    cells = arr.data if isinstance(arr, np.ma.MaskedArray) else arr
    grid = OccupancyGrid(info=info or MapMetaData())
    grid.data = array("b", np.asarray(cells).tobytes())
    grid.info.height, grid.info.width = arr.shape
    return grid
