"""Messages of grid_map_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose
from aionode.interfaces.std_msgs.msg import Float32MultiArray, Header
from aionode.message import DEFAULT, Message, Sequence, float64, uint16

__all__ = ["GridMap", "GridMapInfo"]


class GridMapInfo(Message, typename="grid_map_msgs/msg/GridMapInfo"):
    """GridMapInfo, as grid_map defines it."""

    resolution: float64 = 0.0
    length_x: float64 = 0.0
    length_y: float64 = 0.0
    pose: Pose = DEFAULT


class GridMap(Message, typename="grid_map_msgs/msg/GridMap"):
    """GridMap, as grid_map defines it."""

    header: Header = DEFAULT
    info: GridMapInfo = DEFAULT
    layers: Annotated[list[str], Sequence[str]] = DEFAULT
    basic_layers: Annotated[list[str], Sequence[str]] = DEFAULT
    data: Annotated[list[Float32MultiArray], Sequence[Float32MultiArray]] = DEFAULT
    outer_start_index: uint16 = 0
    inner_start_index: uint16 = 0
