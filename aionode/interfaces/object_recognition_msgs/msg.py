"""Messages of object_recognition_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Point, Pose, PoseWithCovarianceStamped
from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.interfaces.shape_msgs.msg import Mesh
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Floats, Message, Sequence, float32

__all__ = [
    "ObjectInformation",
    "ObjectType",
    "RecognizedObject",
    "RecognizedObjectArray",
    "Table",
    "TableArray",
]


class ObjectType(Message, typename="object_recognition_msgs/msg/ObjectType"):
    """ObjectType, as object_recognition defines it."""

    key: str = ""
    db: str = ""


class RecognizedObject(Message, typename="object_recognition_msgs/msg/RecognizedObject"):
    """RecognizedObject, as object_recognition defines it."""

    header: Header = DEFAULT
    type: ObjectType = DEFAULT
    confidence: float32 = 0.0
    point_clouds: Annotated[list[PointCloud2], Sequence[PointCloud2]] = DEFAULT
    bounding_mesh: Mesh = DEFAULT
    bounding_contours: Annotated[list[Point], Sequence[Point]] = DEFAULT
    pose: PoseWithCovarianceStamped = DEFAULT


class RecognizedObjectArray(Message, typename="object_recognition_msgs/msg/RecognizedObjectArray"):
    """RecognizedObjectArray, as object_recognition defines it."""

    header: Header = DEFAULT
    objects: Annotated[list[RecognizedObject], Sequence[RecognizedObject]] = DEFAULT
    cooccurrence: Annotated[Floats, Sequence[float32]] = DEFAULT


class ObjectInformation(Message, typename="object_recognition_msgs/msg/ObjectInformation"):
    """ObjectInformation, as object_recognition defines it."""

    name: str = ""
    ground_truth_mesh: Mesh = DEFAULT
    ground_truth_point_cloud: PointCloud2 = DEFAULT


class Table(Message, typename="object_recognition_msgs/msg/Table"):
    """Table, as object_recognition defines it."""

    header: Header = DEFAULT
    pose: Pose = DEFAULT
    convex_hull: Annotated[list[Point], Sequence[Point]] = DEFAULT


class TableArray(Message, typename="object_recognition_msgs/msg/TableArray"):
    """TableArray, as object_recognition defines it."""

    header: Header = DEFAULT
    tables: Annotated[list[Table], Sequence[Table]] = DEFAULT
