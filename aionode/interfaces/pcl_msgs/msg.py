"""Messages of pcl_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Floats, Ints, Message, Sequence, float32, int32, uint32

__all__ = ["ModelCoefficients", "PointIndices", "PolygonMesh", "Vertices"]


class ModelCoefficients(Message, typename="pcl_msgs/msg/ModelCoefficients"):
    """ModelCoefficients, as perception_pcl defines it."""

    header: Header = DEFAULT
    values: Annotated[Floats, Sequence[float32]] = DEFAULT


class PointIndices(Message, typename="pcl_msgs/msg/PointIndices"):
    """PointIndices, as perception_pcl defines it."""

    header: Header = DEFAULT
    indices: Annotated[Ints, Sequence[int32]] = DEFAULT


class Vertices(Message, typename="pcl_msgs/msg/Vertices"):
    """Vertices, as perception_pcl defines it."""

    vertices: Annotated[Ints, Sequence[uint32]] = DEFAULT


class PolygonMesh(Message, typename="pcl_msgs/msg/PolygonMesh"):
    """PolygonMesh, as perception_pcl defines it."""

    header: Header = DEFAULT
    cloud: PointCloud2 = DEFAULT
    polygons: Annotated[list[Vertices], Sequence[Vertices]] = DEFAULT
