"""Messages of shape_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Point, Polygon
from aionode.message import DEFAULT, Array, Floats, Ints, Message, Sequence, float64, uint8, uint32

__all__ = ["Mesh", "MeshTriangle", "Plane", "SolidPrimitive"]


class SolidPrimitive(Message, typename="shape_msgs/msg/SolidPrimitive"):
    """A simple solid; constants name its type, and which of `dimensions` (in m) is which."""

    BOX: ClassVar[uint8] = 1
    SPHERE: ClassVar[uint8] = 2
    CYLINDER: ClassVar[uint8] = 3
    CONE: ClassVar[uint8] = 4
    PRISM: ClassVar[uint8] = 5
    BOX_X: ClassVar[uint8] = 0
    BOX_Y: ClassVar[uint8] = 1
    BOX_Z: ClassVar[uint8] = 2
    SPHERE_RADIUS: ClassVar[uint8] = 0
    CYLINDER_HEIGHT: ClassVar[uint8] = 0
    CYLINDER_RADIUS: ClassVar[uint8] = 1
    CONE_HEIGHT: ClassVar[uint8] = 0
    CONE_RADIUS: ClassVar[uint8] = 1
    PRISM_HEIGHT: ClassVar[uint8] = 0

    type: uint8 = 0
    dimensions: Annotated[Floats, Sequence[float64, 3]] = DEFAULT
    polygon: Polygon = DEFAULT


class MeshTriangle(Message, typename="shape_msgs/msg/MeshTriangle"):
    """A triangle, by the indices of its corners."""

    vertex_indices: Annotated[Ints, Array[uint32, 3]] = DEFAULT


class Mesh(Message, typename="shape_msgs/msg/Mesh"):
    """A surface of triangles; `vertices` in m."""

    triangles: Annotated[list[MeshTriangle], Sequence[MeshTriangle]] = DEFAULT
    vertices: Annotated[list[Point], Sequence[Point]] = DEFAULT


class Plane(Message, typename="shape_msgs/msg/Plane"):
    """A plane as a, b, c and d of ax + by + cz + d = 0."""

    coef: Annotated[Floats, Array[float64, 4]] = DEFAULT
